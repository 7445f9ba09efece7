// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeGuidance.h"

#include "HandEyePrediction.h"
#include "NumberWords.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

using Jacobian = Eigen::Matrix<double, 2, 6>;

constexpr std::size_t EnoughToPredict = 4;
/// Before there are samples, the pose is known to this (rad, mm).
constexpr double PriorTurn = 1;
constexpr double PriorShiftMm = 1000;
/// The mean error decides between places that lower the largest one alike.
constexpr double ShareOfMean = 0.2;

/// A ball needs so many of its radii to the border: it is an ellipse there, and a hand is not exact.
constexpr double BallReach = 1.25;
constexpr double LargestBorder = 0.45;

struct Place
{
  Eigen::Vector2d pixel;
  Eigen::Vector3d point_Camera;
  Jacobian byPose;
  Eigen::Matrix2d covariancePx;
};

/// What a ball at a point would be seen with; false where it is not seen.
bool look(const Eye& eye, const HandEyeGuidanceOptions& options, const Eigen::Vector3d& point_Camera, Place& place)
{
  Eigen::Matrix<double, 2, 3> byPoint;
  const CameraModel::Projection seen = eye.camera.project(eye.cameraToEye * point_Camera, &byPoint);
  if (!seen.isUsable())
  {
    return false;
  }
  const Eigen::Matrix<double, 2, 3> byPoint_Camera = byPoint * eye.cameraToEye.linear();
  place.pixel = seen.point_Image;
  place.point_Camera = point_Camera;
  place.byPose = byPoint_Camera * motionJacobian(point_Camera);
  place.covariancePx = options.trackingSigmaMm * options.trackingSigmaMm * byPoint_Camera * byPoint_Camera.transpose();
  place.covariancePx.diagonal().array() += options.segmentationSigmaPx * options.segmentationSigmaPx;
  return true;
}

/// Places on a grid over the image, `border` of its size away from its edges and further where a ball of this radius would reach
/// beyond them, and over the depths.
std::vector<Place> gridOfPlaces(
  const Eye& eye, const HandEyeGuidanceOptions& options, int columns, int rows, int depths, double border, double ballRadiusMm = 0)
{
  const double width = eye.camera.hasImageSize() ? eye.camera.width() : 2 * eye.camera.cx() + 1;
  const double height = eye.camera.hasImageSize() ? eye.camera.height() : 2 * eye.camera.cy() + 1;
  std::vector<Place> places;
  for (int k = 0; k < columns * rows * depths; ++k)
  {
    const double depth = options.nearestMm + (options.furthestMm - options.nearestMm) * (k / columns / rows) / (depths - 1);
    const double reachPx = BallReach * ballRadiusMm / depth * std::max(eye.camera.fx(), eye.camera.fy());
    const double beside = std::min(LargestBorder, std::max(border, reachPx / width));
    const double above = std::min(LargestBorder, std::max(border, reachPx / height));
    const double across = beside + (1 - 2 * beside) * (k % columns) / (columns - 1);
    const double down = above + (1 - 2 * above) * (k / columns % rows) / (rows - 1);
    const auto point_Camera = pointSeenAt(eye, { across * (width - 1), down * (height - 1) }, depth);
    Place place;
    if (point_Camera && look(eye, options, *point_Camera, place))
    {
      places.push_back(place);
    }
  }
  return places;
}

struct Error
{
  double maximumPx = 0;
  double meanPx = 0;
  double size() const { return maximumPx + ShareOfMean * meanPx; }
};

/// Over the volume, with the covariance that a further sample leaves: C - K S^-1 K^T, K = C G^T, S = G K + noise.
Error errorWith(const Place& next, const Covariance6& covariance, const std::vector<Place>& volume)
{
  const Eigen::Matrix<double, 6, 2> gained = covariance * next.byPose.transpose();
  const Eigen::Matrix2d innovation = next.byPose * gained + next.covariancePx, inverse = innovation.inverse();
  Error error;
  for (const Place& place : volume)
  {
    const Eigen::Matrix2d mixed = place.byPose * gained;
    const double before = (place.byPose * covariance).cwiseProduct(place.byPose).sum();
    const double square = before - (mixed * inverse).cwiseProduct(mixed).sum();
    const double px = square < 0 ? 0 : std::sqrt(square);  // what is not a number stays none
    error.maximumPx = px <= error.maximumPx ? error.maximumPx : px;
    error.meanPx += px / double(volume.size());
  }
  return error;
}

double largestError(const Covariance6& covariance, const std::vector<Place>& volume)
{
  double largest = 0;
  for (const Place& place : volume)
  {
    largest = std::max(largest, (place.byPose * covariance).cwiseProduct(place.byPose).sum());
  }
  return std::sqrt(largest);
}

Covariance6 covarianceOf(const std::vector<Eigen::Vector3d>& balls_Camera, const Eye& eye, const HandEyeGuidanceOptions& options)
{
  Eigen::Matrix<double, 6, 1> prior;
  prior << Eigen::Vector3d::Constant(1 / (PriorTurn * PriorTurn)), Eigen::Vector3d::Constant(1 / (PriorShiftMm * PriorShiftMm));
  Covariance6 information = prior.asDiagonal();
  for (const Eigen::Vector3d& ball_Camera : balls_Camera)
  {
    Place place;
    if (look(eye, options, ball_Camera, place))
    {
      information += place.byPose.transpose() * place.covariancePx.inverse() * place.byPose;
    }
  }
  return information.inverse();
}

void checkBalls(const std::vector<Eigen::Vector3d>& balls_Camera)
{
  for (std::size_t i = 0; i < balls_Camera.size(); ++i)
  {
    if (!balls_Camera[i].allFinite() || !(balls_Camera[i].z() > 0))
    {
      throw std::invalid_argument(
        "guidance: ball " + std::to_string(i + 1) + ": finite numbers and a place in front of the camera are expected");
    }
  }
}

std::string sideOf(double share, const char* low, const char* high)
{
  return share < 0.4 ? low : share > 0.6 ? high : "";
}

void say(const Eye& eye, std::size_t count, const HandEyeGuidanceOptions& options, HandEyeGuidance& guidance)
{
  const double width = eye.camera.hasImageSize() ? eye.camera.width() : 2 * eye.camera.cx() + 1;
  const double height = eye.camera.hasImageSize() ? eye.camera.height() : 2 * eye.camera.cy() + 1;
  const std::string down = sideOf(guidance.ball_Image.y() / height, "upper ", "lower ");
  const std::string across = sideOf(guidance.ball_Image.x() / width, "left", "right");
  const std::string side = down + across;
  const std::string where = (side.empty() ? "the middle" : "the " + side + (across.empty() ? "middle" : "")) + " (" +
    fixedDigits(guidance.ball_Image.x(), 0) + ", " + fixedDigits(guidance.ball_Image.y(), 0) + " px), " +
    fixedDigits(guidance.ball_Camera.z(), 0) + " mm away";
  if (count < EnoughToPredict)
  {
    guidance.message = "hold the ball at " + where;
    return;
  }
  const std::string change = "the largest predicted error by " + fixedDigits(100 * guidance.gain, 0) + " %";
  guidance.message = guidance.isWorthwhile() ? "hold the ball at " + where + ": lowers " + change
                                             : "another sample is hardly worth while (less than " +
      fixedDigits(100 * options.minimumGain, 0) + " %): the best one, at " + where + ", would lower " + change;
}

}  // namespace

void HandEyeGuidanceOptions::check() const
{
  const bool depths = nearestMm > 0 && furthestMm > nearestMm && std::isfinite(furthestMm);
  const bool noise = trackingSigmaMm >= 0 && segmentationSigmaPx >= 0 && trackingSigmaMm + segmentationSigmaPx > 0;
  if (!depths || !noise || !(borderShare >= 0 && borderShare < 0.5) || !(ballRadiusMm >= 0 && ballRadiusMm < nearestMm) ||
    !(separationMm >= 0) || !(minimumGain >= 0))
  {
    throw std::invalid_argument(
      "guidance options: two depths, the nearer first, noise of at least 0, a border below half the image, "
      "a ball that is smaller than the nearest depth, a separation and a gain of at least 0 are expected");
  }
}

HandEyeGuidance suggestPlacement(
  const std::vector<Eigen::Vector3d>& balls_Camera, const Eye& eye, const HandEyeGuidanceOptions& options)
{
  options.check();
  checkBalls(balls_Camera);
  const std::vector<Place> volume = gridOfPlaces(eye, options, 5, 5, 3, 0);
  const Covariance6 covariance = covarianceOf(balls_Camera, eye, options);
  const bool canPredict = balls_Camera.size() >= EnoughToPredict;
  HandEyeGuidance guidance;
  double best = std::numeric_limits<double>::infinity();
  for (const Place& place : gridOfPlaces(eye, options, 9, 7, 5, options.borderShare, options.ballRadiusMm))
  {
    const bool isTaken = std::any_of(balls_Camera.begin(), balls_Camera.end(),
      [&](const Eigen::Vector3d& ball) { return (ball - place.point_Camera).norm() < options.separationMm; });
    if (isTaken)
    {
      continue;
    }
    const Eigen::Matrix2d innovation = place.byPose * covariance * place.byPose.transpose() + place.covariancePx;
    const Error error = canPredict ? errorWith(place, covariance, volume) : Error{};
    const double score = canPredict ? error.size() : -innovation.determinant() / place.covariancePx.determinant();
    if (score < best)
    {
      best = score;
      guidance.status = HandEyeGuidance::Status::HoldHere;
      guidance.ball_Image = place.pixel;
      guidance.ball_Camera = place.point_Camera;
      guidance.maximumAfterPx = error.maximumPx;
    }
  }
  if (guidance.status == HandEyeGuidance::Status::NoPlace)
  {
    guidance.message = "there is no place left to hold the ball at";
    return guidance;
  }
  guidance.maximumPx = canPredict ? largestError(covariance, volume) : std::numeric_limits<double>::infinity();
  guidance.gain = canPredict ? 1 - guidance.maximumAfterPx / guidance.maximumPx : 1;
  if (guidance.gain < options.minimumGain)
  {
    guidance.status = HandEyeGuidance::Status::Enough;
  }
  say(eye, balls_Camera.size(), options, guidance);
  return guidance;
}

std::string toString(HandEyeGuidance::Status status)
{
  switch (status)
  {
    case HandEyeGuidance::Status::HoldHere:
      return "hold_here";
    case HandEyeGuidance::Status::Enough:
      return "enough";
    case HandEyeGuidance::Status::NoPlace:
      return "no_place";
  }
  return "unknown";
}

}  // namespace handeye
