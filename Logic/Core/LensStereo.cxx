// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensStereo.h"

#include "NumberWords.h"
#include "RigidTransform.h"
#include "Statistics.h"

#include <map>

namespace handeye
{

namespace
{

using Status = StereoLensResult::Status;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int FewestPairs = 3;
constexpr double LargestPairPx = 3;  ///< root mean square; more is not the same moment
constexpr double OutlierFactor = 3;

/// A moment at which both eyes saw the board.
struct Pair
{
  const LensCalibrationResult::View* left;
  const LensView* rightView;
  Eigen::Isometry3d leftToRight;
};

std::vector<Pair> pairsOf(const std::vector<LensView>& rightViews, const StereoLensResult& result)
{
  std::map<int, const LensCalibrationResult::View*> leftByFrame;
  for (const LensCalibrationResult::View& view : result.left.views)
  {
    if (view.used)
    {
      leftByFrame[view.frame] = &view;
    }
  }
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < rightViews.size(); ++i)
  {
    const auto left = leftByFrame.find(rightViews[i].frame);
    if (result.right.views[i].used && left != leftByFrame.end())
    {
      const Eigen::Isometry3d cameraToBoard = left->second->boardToCamera.inverse();
      pairs.push_back({ left->second, &rightViews[i], result.right.views[i].boardToCamera * cameraToBoard });
    }
  }
  return pairs;
}

Eigen::Isometry3d average(const std::vector<Pair>& pairs)
{
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs)
  {
    rotation += pair.leftToRight.linear();
    translation += pair.leftToRight.translation() / double(pairs.size());
  }
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() = nearestRotation(rotation);
  mean.translation() = translation;
  return mean;
}

/// The normal equations of one pair's points in the right image, by (rotation vector, translation) of leftToRight from the left.
/// The
/// board's pose is the left eye's.
struct Normals
{
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double squares = 0;
  int count = 0;
};

Normals linearize(const Pair& pair, const CameraModel& right, const Eigen::Isometry3d& leftToRight)
{
  Normals normals;
  for (std::size_t i = 0; i < pair.rightView->ids.size(); ++i)
  {
    const Eigen::Vector3d point_Left = pair.left->boardToCamera * pair.rightView->points_Board[i];
    const Eigen::Vector3d point_Right = leftToRight * point_Left;
    Eigen::Matrix<double, 2, 3> byPoint;
    const CameraModel::Projection seen = right.project(point_Right, &byPoint);
    if (seen.isUsable())
    {
      Eigen::Matrix<double, 2, 6> jacobian;
      jacobian << -byPoint * skew(point_Right), byPoint;
      const Eigen::Vector2d residual = seen.point_Image - pair.rightView->points_Image[i];
      normals.hessian += jacobian.transpose() * jacobian;
      normals.gradient += jacobian.transpose() * residual;
      normals.squares += residual.squaredNorm();
      ++normals.count;
    }
  }
  return normals;
}

double rmsOf(const Normals& normals)
{
  return normals.count > 0 ? std::sqrt(normals.squares / normals.count) : std::numeric_limits<double>::infinity();
}

/// Gauss and Newton's iteration on the right eye's pixels, and the covariance by the scatter of the pairs (a sandwich): what the
/// left
/// eye gets wrong of a board's pose is shared by all its points.
void refine(const std::vector<Pair>& pairs, const CameraModel& right, StereoLensResult& result)
{
  for (int iteration = 0; iteration < 15; ++iteration)
  {
    Matrix6 hessian = Matrix6::Zero(), scatter = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    for (const Pair& pair : pairs)
    {
      const Normals normals = linearize(pair, right, result.leftToRight);
      hessian += normals.hessian;
      gradient += normals.gradient;
      scatter += normals.gradient * normals.gradient.transpose();
    }
    const Matrix6 inverse = hessian.ldlt().solve(Matrix6::Identity());
    const double n = double(pairs.size());
    result.covariance = n / (n - 1) * inverse * scatter * inverse;
    const Vector6 step = -inverse * gradient;
    const Eigen::Matrix3d turn = rotationFromVector(step.head<3>());
    result.leftToRight.linear() = nearestRotation(turn * result.leftToRight.linear());
    result.leftToRight.translation() = turn * result.leftToRight.translation() + step.tail<3>();
    if (step.norm() < 1e-12)
    {
      break;
    }
  }
}

StereoLensResult failed(StereoLensResult result, Status status, const std::string& message)
{
  result.status = status;
  result.message = message;
  return result;
}

}  // namespace

StereoLensResult calibrateStereoLens(const std::vector<LensView>& leftViews, int leftWidth, int leftHeight,
  const std::vector<LensView>& rightViews, int rightWidth, int rightHeight, const LensCalibrationOptions& options)
{
  StereoLensResult result;
  result.left = calibrateLens(leftViews, leftWidth, leftHeight, options);
  result.right = calibrateLens(rightViews, rightWidth, rightHeight, options);
  if (!result.left.isUsable() || !result.right.isUsable())
  {
    const bool isLeft = !result.left.isUsable();
    const std::string reason = isLeft ? result.left.message : result.right.message;
    return failed(std::move(result), Status::LensFailed, std::string(isLeft ? "left" : "right") + " lens: " + reason);
  }
  std::vector<Pair> pairs = pairsOf(rightViews, result);
  const std::size_t seen = pairs.size();
  for (;;)
  {
    if (int(pairs.size()) < FewestPairs)
    {
      const std::string message = seen < FewestPairs
        ? std::to_string(seen) + " moments at which both eyes saw the board, at least " + std::to_string(FewestPairs) +
          " are needed"
        : "the pairs of pictures do not share one relation of the eyes: are they of the same moments?";
      return failed(std::move(result), seen < FewestPairs ? Status::TooFewPairs : Status::Disagreement, message);
    }
    result.leftToRight = average(pairs);
    refine(pairs, *result.right.camera, result);
    std::vector<double> rms;
    for (const Pair& pair : pairs)
    {
      rms.push_back(rmsOf(linearize(pair, *result.right.camera, result.leftToRight)));
    }
    const auto worst = std::max_element(rms.begin(), rms.end());
    const double limit = std::max(OutlierFactor * median(rms), 3 * result.right.rmsPx);
    if (!(*worst > limit) || 3 * pairs.size() <= 2 * seen)
    {
      result.pairRmsPx = rms;
      break;
    }
    pairs.erase(pairs.begin() + (worst - rms.begin()));
  }
  double squares = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    result.frames.push_back(pairs[i].rightView->frame);
    squares += result.pairRmsPx[i] * result.pairRmsPx[i] / double(pairs.size());
  }
  result.rmsPx = std::sqrt(squares);
  if (!(result.rmsPx <= LargestPairPx))
  {
    const std::string px = fixedDigits(result.rmsPx, 1);
    return failed(std::move(result), Status::Disagreement,
      "the eyes' views of the board do not fit together (" + px + " px RMS): are the pictures of the same moments?");
  }
  result.status = Status::Ok;
  result.message = "both eyes " + fixedDigits(result.leftToRight.translation().norm(), 2) + " mm apart, " +
    fixedDigits(result.rmsPx, 2) + " px RMS over " + std::to_string(pairs.size()) + " pairs";
  return result;
}

std::string toString(StereoLensResult::Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::LensFailed:
      return "lens_failed";
    case Status::TooFewPairs:
      return "too_few_pairs";
    case Status::Disagreement:
      return "disagreement";
  }
  return "unknown";
}

}  // namespace handeye
