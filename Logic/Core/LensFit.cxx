// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensFit.h"

#include "RigidTransform.h"

#include <opencv2/calib3d.hpp>

namespace handeye
{

namespace
{

constexpr int CircleCorrections = 3;

/// What OpenCV takes.
struct Points
{
  std::vector<std::vector<cv::Point3f>> object;
  std::vector<std::vector<cv::Point2f>> image;
};

Points toOpenCV(const std::vector<const LensView*>& views)
{
  Points points;
  for (const LensView* view : views)
  {
    points.object.emplace_back();
    points.image.emplace_back();
    for (std::size_t i = 0; i < view->ids.size(); ++i)
    {
      const Eigen::Vector3f board = view->points_Board[i].cast<float>();
      const Eigen::Vector2f image = view->points_Image[i].cast<float>();
      points.object.back().emplace_back(board.x(), board.y(), board.z());
      points.image.back().emplace_back(image.x(), image.y());
    }
  }
  return points;
}

/// Zhang's closed form where it makes sense, otherwise a lens of a usual opening angle.
cv::Mat startingMatrix(const Points& points, const cv::Size& size)
{
  cv::Mat matrix = cv::initCameraMatrix2D(points.object, points.image, size, 1);
  const double focal = matrix.at<double>(0, 0);
  if (!(focal > 0.3 * size.width) || !(focal < 10 * size.width) || !cv::checkRange(matrix))
  {
    matrix = (cv::Mat_<double>(3, 3) << size.width, 0, (size.width - 1) / 2.0, 0, size.width, (size.height - 1) / 2.0, 0, 0, 1);
  }
  return matrix;
}

int flagsFor(int coefficients)
{
  const int model = coefficients == 4 ? cv::CALIB_FIX_K3 : coefficients == 8 ? cv::CALIB_RATIONAL_MODEL : 0;
  return model | cv::CALIB_USE_INTRINSIC_GUESS;
}

Eigen::Isometry3d toTransform(const cv::Mat& rotation, const cv::Mat& translation)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotationFromVector(Eigen::Map<const Eigen::Vector3d>(rotation.ptr<double>()));
  transform.translation() = Eigen::Map<const Eigen::Vector3d>(translation.ptr<double>());
  return transform;
}

/// Where OpenCV's model puts the points; ours has no answer beyond the fold, and residuals are wanted there, too.
std::vector<Eigen::Vector2d> residualsOf(
  const LensView& view, const cv::Mat& rotation, const cv::Mat& translation, const cv::Mat& matrix, const cv::Mat& coefficients)
{
  std::vector<cv::Point3d> object;
  for (const Eigen::Vector3d& point_Board : view.points_Board)
  {
    object.emplace_back(point_Board.x(), point_Board.y(), point_Board.z());
  }
  std::vector<cv::Point2d> projected;
  cv::projectPoints(object, rotation, translation, matrix, coefficients, projected);
  std::vector<Eigen::Vector2d> residuals;
  for (std::size_t i = 0; i < projected.size(); ++i)
  {
    residuals.push_back(view.points_Image[i] - Eigen::Vector2d(projected[i].x, projected[i].y));
  }
  return residuals;
}

std::optional<LensFit> fitOnce(const std::vector<const LensView*>& views, int width, int height, int coefficientCount)
{
  const cv::Size size(width, height);
  const Points points = toOpenCV(views);
  cv::Mat matrix, coefficients = cv::Mat::zeros(1, coefficientCount == 8 ? 8 : 5, CV_64F), sigmas, poseSigmas, perView;
  std::vector<cv::Mat> rotations, translations;
  try
  {
    matrix = startingMatrix(points, size);
    cv::calibrateCamera(points.object, points.image, size, matrix, coefficients, rotations, translations, sigmas, poseSigmas,
      perView, flagsFor(coefficientCount), cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-12));
  }
  catch (const cv::Exception&)
  {
    return std::nullopt;  // a view without a homography, or a lens that went out of its range
  }
  if (!cv::checkRange(matrix) || !cv::checkRange(coefficients) || !(matrix.at<double>(0, 0) > 0) || !(matrix.at<double>(1, 1) > 0))
  {
    return std::nullopt;
  }
  Eigen::Matrix3d cameraMatrix = Eigen::Matrix3d::Identity();
  cameraMatrix << matrix.at<double>(0, 0), 0, matrix.at<double>(0, 2), 0, matrix.at<double>(1, 1), matrix.at<double>(1, 2), 0, 0, 1;
  const double* values = coefficients.ptr<double>();
  LensFit fit{ CameraModel(width, height, cameraMatrix, std::vector<double>(values, values + coefficientCount)), {}, {}, {}, {}, {},
    0, 0 };
  for (int i = 0; i < 4; ++i)
  {
    fit.cameraMatrixSigmas(i) = sigmas.at<double>(i);
  }
  for (int i = 0; i < coefficientCount; ++i)
  {
    fit.coefficientSigmas.push_back(sigmas.at<double>(4 + i));
  }
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    fit.boardToCamera.push_back(toTransform(rotations[i], translations[i]));
    fit.residuals_Image.push_back(residualsOf(*views[i], rotations[i], translations[i], matrix, coefficients));
    double squares = 0;
    for (const Eigen::Vector2d& residual : fit.residuals_Image.back())
    {
      squares += residual.squaredNorm();
    }
    fit.viewRmsPx.push_back(std::sqrt(squares / double(views[i]->ids.size())));
    fit.squares += squares;
    fit.pointCount += int(views[i]->ids.size());
  }
  return fit;
}

/// How far the centre of a circle's picture is from the picture of its centre.
Eigen::Vector2d centerShift(
  const CameraModel& camera, const Eigen::Isometry3d& boardToCamera, const Eigen::Vector3d& center_Board, double radiusMm)
{
  constexpr int Corners = 48;
  const CameraModel::Projection center = camera.project(boardToCamera * center_Board);
  Eigen::Vector2d outline[Corners];
  for (int i = 0; i < Corners; ++i)
  {
    const double turn = 2 * EIGEN_PI * i / Corners;
    const Eigen::Vector3d rim_Board = center_Board + radiusMm * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0);
    const CameraModel::Projection rim = camera.project(boardToCamera * rim_Board);
    if (!rim.isUsable() || !center.isUsable())
    {
      return Eigen::Vector2d::Zero();
    }
    outline[i] = rim.point_Image - center.point_Image;
  }
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  for (int i = 0; i < Corners; ++i)
  {
    const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % Corners];
    const double cross = a.x() * b.y() - a.y() * b.x();
    moment += cross * (a + b) / 3;
    area += cross;
  }
  return area != 0 ? Eigen::Vector2d(moment / area) : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

std::vector<LensView> corrected(const std::vector<const LensView*>& views, const LensFit& fit, double radiusMm)
{
  std::vector<LensView> result;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    result.push_back(*views[i]);
    for (std::size_t k = 0; k < views[i]->ids.size(); ++k)
    {
      result.back().points_Image[k] -= centerShift(fit.camera, fit.boardToCamera[i], views[i]->points_Board[k], radiusMm);
    }
  }
  return result;
}

[[noreturn]] void failView(std::size_t view, const std::string& what)
{
  throw std::invalid_argument("calibrateLens: view " + std::to_string(view) + " " + what);
}

}  // namespace

std::optional<LensFit> fitLens(
  const std::vector<const LensView*>& views, int width, int height, int coefficients, double circleDiameterMm)
{
  std::optional<LensFit> fit = fitOnce(views, width, height, coefficients);
  for (int i = 0; fit && circleDiameterMm > 0 && i < CircleCorrections; ++i)
  {
    const std::vector<LensView> moved = corrected(views, *fit, circleDiameterMm / 2);
    std::vector<const LensView*> movedViews;
    for (const LensView& view : moved)
    {
      movedViews.push_back(&view);
    }
    fit = fitOnce(movedViews, width, height, coefficients);
  }
  return fit;
}

double tiltSpreadRad(const std::vector<Eigen::Isometry3d>& boardToCamera)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : boardToCamera)
  {
    mean += pose.linear().col(2);
  }
  std::vector<double> angles;
  for (const Eigen::Isometry3d& pose : boardToCamera)
  {
    const Eigen::Vector3d normal_Camera = pose.linear().col(2);
    angles.push_back(std::atan2(normal_Camera.cross(mean).norm(), normal_Camera.dot(mean)));
  }
  std::sort(angles.rbegin(), angles.rend());
  return angles.size() < 3 ? 0 : angles[2];
}

void checkLensViews(const std::vector<LensView>& views, int width, int height)
{
  if (width <= 0 || height <= 0)
  {
    throw std::invalid_argument("calibrateLens: the pictures' width and height are expected to be positive");
  }
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const LensView& view = views[i];
    if (view.ids.size() != view.points_Board.size() || view.ids.size() != view.points_Image.size())
    {
      failView(i,
        "has " + std::to_string(view.ids.size()) + " ids, but " + std::to_string(view.points_Board.size()) +
          " points of the board and " + std::to_string(view.points_Image.size()) + " of the image");
    }
    for (std::size_t k = 0; k < view.ids.size(); ++k)
    {
      if (!view.points_Board[k].allFinite() || !view.points_Image[k].allFinite() || view.points_Board[k].z() != 0)
      {
        failView(
          i, "has a point (" + std::to_string(k) + ") with a number that is not finite, or that is not in the board's plane");
      }
    }
  }
}

}  // namespace handeye
