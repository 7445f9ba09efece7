// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkRegistration.h"

#include "NumberWords.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

using Points = std::vector<Eigen::Vector3d>;
using Status = LandmarkRegistrationResult::Status;

/// The second largest extent of a point set must be this share of the largest for the points not to be on a line.
constexpr double CollinearRatio = 0.02;
/// A mirrored fit that is better than the proper one by this factor, and a proper one that is worse than this, give a mirror image
/// away.
constexpr double MirrorFactor = 4;
constexpr double MirrorRmsMm = 3;
/// Larger residuals are no registration of anatomy that was touched with care.
constexpr double LargestRmsMm = 3;

Eigen::Matrix3Xd toMatrix(const Points& points)
{
  Eigen::Matrix3Xd matrix(3, Eigen::Index(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!points[i].allFinite())
    {
      throw std::invalid_argument("landmark " + std::to_string(i + 1) + " is not finite");
    }
    matrix.col(Eigen::Index(i)) = points[i];
  }
  return matrix;
}

bool isCollinear(const Eigen::Matrix3Xd& points)
{
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d extents = Eigen::JacobiSVD<Eigen::Matrix3Xd>(centred).singularValues();
  return !(extents(1) > CollinearRatio * extents(0)) || !(extents(0) > 1e-6);
}

/// The root mean square distance that is left when the model may be mirrored as well.
double mirroredRms(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom)
{
  Eigen::Matrix3Xd mirrored = model;
  mirrored.row(0) *= -1;
  const Eigen::Matrix4d fit = Eigen::umeyama(mirrored, phantom, false);
  const Eigen::Matrix3Xd left = (fit.topLeftCorner<3, 3>() * mirrored).colwise() + fit.topRightCorner<3, 1>() - phantom;
  return std::sqrt(left.colwise().squaredNorm().mean());
}

double rmsWithout(const Points& points_Model, const Points& points_Phantom, std::size_t left)
{
  Points model = points_Model, phantom = points_Phantom;
  model.erase(model.begin() + std::ptrdiff_t(left));
  phantom.erase(phantom.begin() + std::ptrdiff_t(left));
  const Eigen::Matrix3Xd from = toMatrix(model), to = toMatrix(phantom);
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd rest = (fit.topLeftCorner<3, 3>() * from).colwise() + fit.topRightCorner<3, 1>() - to;
  return std::sqrt(rest.colwise().squaredNorm().mean());
}

/// What is wrong: one landmark, or the whole.
std::string describePoorFit(const Points& points_Model, const Points& points_Phantom, double rmsMm)
{
  std::string text = "the landmarks differ by " + fixedDigits(rmsMm, 1) + " mm (RMS), more than the " +
    fixedDigits(LargestRmsMm, 1) + " mm of a usable registration: ";
  std::size_t worst = 0;
  double least = rmsMm;
  for (std::size_t i = 0; points_Model.size() > 4 && i < points_Model.size(); ++i)
  {
    const double rms = rmsWithout(points_Model, points_Phantom, i);
    if (rms < least)
    {
      least = rms;
      worst = i;
    }
  }
  return least <= LargestRmsMm
    ? text + "touch landmark " + std::to_string(worst + 1) + " again, without it " + fixedDigits(least, 1) + " mm are left"
    : text + "check their order and that both lists are in mm";
}

}  // namespace

LandmarkRegistrationResult registerLandmarks(const Points& points_Model, const Points& points_Phantom)
{
  if (points_Model.size() != points_Phantom.size())
  {
    throw std::invalid_argument("the model has " + std::to_string(points_Model.size()) + " landmarks, " +
      std::to_string(points_Phantom.size()) + " were touched: the same number in the same order is expected");
  }
  LandmarkRegistrationResult result;
  if (points_Model.size() < 3)
  {
    result.message = "only " + std::to_string(points_Model.size()) + " landmarks, at least 3 are needed (6 are recommended)";
    return result;
  }
  const Eigen::Matrix3Xd model = toMatrix(points_Model), phantom = toMatrix(points_Phantom);
  if (isCollinear(model) || isCollinear(phantom))
  {
    result.status = Status::Collinear;
    result.message = "the landmarks lie on one line or in one place: nothing fixes the rotation about it";
    return result;
  }
  result.modelToPhantom.matrix() = Eigen::umeyama(model, phantom, false);
  for (std::size_t i = 0; i < points_Model.size(); ++i)
  {
    result.residualsMm.push_back((result.modelToPhantom * points_Model[i] - points_Phantom[i]).norm());
  }
  result.rmsMm = summarize(result.residualsMm).rms;
  if (points_Model.size() > 3 && result.rmsMm > MirrorRmsMm && mirroredRms(model, phantom) * MirrorFactor < result.rmsMm)
  {
    result.status = Status::Mirrored;
    result.message = "the touched points are the mirror image of the model's: check their order and the model's side";
    return result;
  }
  if (!(result.rmsMm <= LargestRmsMm) || !result.modelToPhantom.matrix().allFinite())
  {
    result.status = Status::PoorFit;
    result.message = describePoorFit(points_Model, points_Phantom, result.rmsMm);
    return result;
  }
  result.status = Status::Ok;
  result.message = "registered " + std::to_string(points_Model.size()) + " landmarks";
  return result;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewPoints:
      return "too_few_points";
    case Status::Collinear:
      return "collinear";
    case Status::PoorFit:
      return "poor_fit";
    case Status::Mirrored:
      return "mirrored";
  }
  return "unknown";
}

}  // namespace handeye
