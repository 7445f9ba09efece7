// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentationStudy.h"

#include "SphereCone.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

namespace handeye::test
{

namespace
{

constexpr double Pi = double(EIGEN_PI);
constexpr double BallRadiusMm = 15;
constexpr double BlurPx = 0.7;
constexpr double LargestErrorPx = 1;
/// The direction that the hiding edge comes from, against the direction from the image's centre to the ball.
constexpr double HiddenFrom = 0.8;
/// Step of the numeric derivatives, px in the image.
constexpr double StepPx = 0.25;
constexpr double RoundingVariance = 1.0 / 12;

/// The ball at one place, the part of the sensor around it and what hides it.
struct Place
{
  CameraModel camera;  ///< of the part
  RenderedBall ball;
  Eigen::Vector2d center_Image;      ///< px of the part
  Eigen::Matrix2d imageToRadial;     ///< turns errors so that x points away from the image's centre
  Eigen::Vector2d hidden_Direction;  ///< what is further than `hiddenFrom` in this direction is hidden
  double hiddenFrom = 0;
};

const CameraModel& lensNamed(const std::string& name)
{
  for (const StudyLens& lens : studyLenses())
  {
    if (lens.name == name)
    {
      return lens.camera;
    }
  }
  throw std::invalid_argument("there is no lens " + name + " in the study");
}

CameraModel movedTo(const CameraModel& camera, const cv::Rect& part)
{
  Eigen::Matrix3d cameraMatrix = camera.cameraMatrix();
  cameraMatrix(0, 2) -= part.x;
  cameraMatrix(1, 2) -= part.y;
  return CameraModel(part.width, part.height, cameraMatrix, camera.distortionCoefficients());
}

std::vector<Eigen::Vector2d> outlineOf(const CameraModel& camera, const RenderedBall& ball)
{
  constexpr int Points = 360;
  const double distance = ball.center_Camera.norm();
  const SphereCone cone{ ball.center_Camera / distance, std::asin(ball.radiusMm / distance) };
  std::vector<Eigen::Vector2d> points = cone.outline(camera, Points).points_Image;
  if (points.size() < Points)
  {
    throw std::invalid_argument("the lens model does not cover the whole ball");
  }
  return points;
}

/// The place number `index` of a cell: turned about the axis by the golden angle each time, and somewhere else within a pixel.
Place makePlace(const StudyCell& cell, const StudyEffort& effort, int index)
{
  const CameraModel& lens = lensNamed(cell.lens);
  const double focal = (lens.fx() + lens.fy()) / 2;
  std::mt19937 random(unsigned(1000 + index));
  std::uniform_real_distribution<double> withinPixel(-0.5, 0.5);
  const double azimuth = 2.399963 * index + 0.3, offAxis = cell.offAxisDeg * Pi / 180;
  const Eigen::Vector3d nominal_Camera(
    std::sin(offAxis) * std::cos(azimuth), std::sin(offAxis) * std::sin(azimuth), std::cos(offAxis));
  RenderedBall ball;
  ball.radiusMm = BallRadiusMm;
  ball.isShaded = effort.isShaded;
  const double distance = BallRadiusMm / std::sin(std::atan(cell.radiusPx / focal));
  const Eigen::Vector3d shift_Camera(withinPixel(random) / focal, withinPixel(random) / focal, 0);
  ball.center_Camera = distance * (nominal_Camera + shift_Camera).normalized();

  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : outlineOf(lens, ball))
  {
    box.extend(point);
  }
  const int margin = int(std::max(14.0, 0.25 * cell.radiusPx));
  const cv::Rect part(int(std::floor(box.min().x())) - margin, int(std::floor(box.min().y())) - margin,
    int(std::ceil(box.sizes().x())) + 2 * margin, int(std::ceil(box.sizes().y())) + 2 * margin);
  Place place{ movedTo(lens, part), ball, {}, {}, {}, 0 };
  place.center_Image = place.camera.project(ball.center_Camera).point_Image;
  place.imageToRadial << std::cos(azimuth), std::sin(azimuth), -std::sin(azimuth), std::cos(azimuth);
  place.hidden_Direction = Eigen::Vector2d(std::cos(azimuth + HiddenFrom), std::sin(azimuth + HiddenFrom));
  std::vector<double> along;
  for (const Eigen::Vector2d& point : outlineOf(place.camera, ball))
  {
    along.push_back(point.dot(place.hidden_Direction));
  }
  std::sort(along.begin(), along.end(), std::greater<>());
  place.hiddenFrom = along[std::size_t(cell.hiddenShare * double(along.size() - 1))];
  return place;
}

/// A sensor with `parts` x `parts` pixels in the place of each.
CameraModel dividedPixels(const CameraModel& camera, int parts)
{
  Eigen::Matrix3d cameraMatrix = parts * camera.cameraMatrix();
  cameraMatrix(0, 2) += (parts - 1) / 2.0;
  cameraMatrix(1, 2) += (parts - 1) / 2.0;
  cameraMatrix(2, 2) = 1;
  return CameraModel(parts * camera.width(), parts * camera.height(), cameraMatrix, camera.distortionCoefficients());
}

/// The light on the sensor, with the ball where it is asked for and the hiding edge where it is: blurred as by optics, then summed up
/// over each pixel.
cv::Mat lightOn(const Place& place, const StudyCell& cell, const StudyEffort& effort, const Eigen::Vector3d& center_Camera)
{
  RenderedBall ball = place.ball;
  ball.center_Camera = center_Camera;
  const int parts = effort.parts;
  cv::Mat light = SphereScene(dividedPixels(place.camera, parts)).add(ball).light();
  if (cell.hiddenShare > 0)
  {
    const Eigen::Vector2d shift = Eigen::Vector2d::Constant((parts - 1) / 2.0);
    for (int row = 0; row < light.rows; ++row)
    {
      for (int column = 0; column < light.cols; ++column)
      {
        const double inside = (Eigen::Vector2d(column, row) - shift).dot(place.hidden_Direction) - parts * place.hiddenFrom;
        const float share = float(std::clamp(inside + 0.5, 0.0, 1.0));
        Light& pixel = light.at<Light>(row, column);
        pixel += share * (GloveBlue - pixel);
      }
    }
  }
  cv::GaussianBlur(light, light, {}, parts * BlurPx, parts * BlurPx, cv::BORDER_REPLICATE);
  cv::Mat ofPixels;
  cv::resize(light, ofPixels, { place.camera.width(), place.camera.height() }, 0, 0, cv::INTER_AREA);
  return ofPixels;
}

/// Grey levels of the noise-free picture, not rounded.
cv::Mat greyLevels(const cv::Mat& light)
{
  cv::Mat levels(light.size(), CV_32FC3);
  for (int row = 0; row < light.rows; ++row)
  {
    const float* from = light.ptr<float>(row);
    float* to = levels.ptr<float>(row);
    std::transform(from, from + 3 * light.cols, to, [](float value) { return 255 * encode(value); });
  }
  return levels;
}

double boundOf(const Place& place, const StudyCell& cell, const StudyEffort& effort)
{
  Eigen::Matrix<double, 2, 3> jacobian;  // px/mm
  (void)place.camera.project(place.ball.center_Camera, &jacobian);
  const double pixelMm = place.ball.center_Camera.norm() / place.camera.fx();
  const double depthMm = place.ball.center_Camera.norm() / cell.radiusPx;  // changes the radius by a pixel
  const Eigen::Vector3d towards = place.ball.center_Camera.normalized(), across = towards.unitOrthogonal();
  Eigen::Matrix3d steps_Camera;  // mm for a pixel
  steps_Camera << pixelMm * across, pixelMm * towards.cross(across), depthMm * towards;
  std::vector<cv::Mat> derivatives;
  for (int i = 0; i < 3; ++i)
  {
    const Eigen::Vector3d step_Camera = StepPx * steps_Camera.col(i);
    const cv::Mat more = greyLevels(lightOn(place, cell, effort, place.ball.center_Camera + step_Camera));
    const cv::Mat less = greyLevels(lightOn(place, cell, effort, place.ball.center_Camera - step_Camera));
    derivatives.emplace_back((more - less) / (2 * StepPx));
  }
  Eigen::Matrix3d information;
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      information(i, k) =
        derivatives[std::size_t(i)].dot(derivatives[std::size_t(k)]) / (cell.noise * cell.noise + RoundingVariance);
    }
  }
  const Eigen::Matrix<double, 2, 3> pixelsPerStep = jacobian * steps_Camera;
  const Eigen::Matrix2d covariance = pixelsPerStep * information.inverse() * pixelsPerStep.transpose();
  return std::sqrt(covariance.trace() / 2);
}

/// Means and squares of errors, place by place.
class Errors
{
public:
  void addPlace(const std::vector<Eigen::Vector2d>& errors)
  {
    if (errors.size() < 2)
    {
      return;
    }
    const double count = double(errors.size());
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& error : errors)
    {
      mean += error / count;
    }
    for (const Eigen::Vector2d& error : errors)
    {
      squares_ += (error - mean).squaredNorm() / 2;
    }
    degreesOfFreedom_ += count - 1;
    meanSquares_ += mean.squaredNorm();
    inverseCounts_ += 1 / count;
    mean_ += mean;
    ++places_;
  }

  void evaluate(StudyResult& result) const
  {
    if (places_ == 0)
    {
      return;
    }
    const double variance = squares_ / degreesOfFreedom_, noiseOfMeans = 2 * variance * inverseCounts_ / places_;
    result.spreadPx = std::sqrt(variance);
    result.biasPx = std::sqrt(std::max(0.0, meanSquares_ / places_ - noiseOfMeans));
    result.biasUncertaintyPx = std::sqrt(noiseOfMeans / std::sqrt(double(places_)));
    result.systematicPx = mean_.norm() / places_;
  }

private:
  double squares_ = 0, degreesOfFreedom_ = 0, meanSquares_ = 0, inverseCounts_ = 0;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
  int places_ = 0;
};

}  // namespace

const std::vector<StudyLens>& studyLenses()
{
  static const std::vector<StudyLens> lenses = {
    { "webcam", makeCamera(640, 480, 650, 651.2, 321.4, 238.7, { 0.041, -0.112, -0.0007, 0.0011, 0.02 }) },
    { "headset", makeCamera(960, 720, 571, 570.1, 484.2, 356.9, { -0.19, 0.041, 0.0004, -0.0006 }) },
    { "barrel", makeCamera(1280, 1024, 1100, 1102.5, 637.2, 515.8, { -0.4, 0.15, 0.0008, -0.001 }) },
  };
  return lenses;
}

StudyResult runStudyCell(const StudyCell& cell, const StudyEffort& effort, const BallDetectionOptions& options)
{
  StudyResult result;
  Errors errors;
  double claimed = 0;
  for (int index = 0; index < effort.places; ++index)
  {
    const Place place = makePlace(cell, effort, index);
    if (index == 0)
    {
      result.boundPx = boundOf(place, cell, effort);
    }
    const cv::Mat light = lightOn(place, cell, effort, place.ball.center_Camera);
    std::vector<Eigen::Vector2d> ofPlace;
    for (int draw = 0; draw < effort.draws; ++draw)
    {
      Photograph how;
      how.noise = cell.noise;
      how.seed = unsigned(7919 * (index + 1) + draw);
      const BallDetection found = detectBall(develop(light, how), place.camera, BallRadiusMm, options);
      const Eigen::Vector2d error = found.ball_Image - place.center_Image;
      ++result.tried;
      if (found.isFound() && error.norm() < LargestErrorPx)
      {
        ofPlace.emplace_back(place.imageToRadial * error);
        claimed += found.covariance_Image.trace() / 2;
        ++result.found;
      }
    }
    errors.addPlace(ofPlace);
  }
  errors.evaluate(result);
  result.claimedPx = std::sqrt(claimed / std::max(1, result.found));
  return result;
}

double studyBound(const StudyCell& cell, const StudyEffort& effort)
{
  return boundOf(makePlace(cell, effort, 0), cell, effort);
}

}  // namespace handeye::test
