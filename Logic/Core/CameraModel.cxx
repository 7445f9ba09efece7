// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraModel.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

/// In normalised coordinates: 1e-8 px for any focal length there is.
constexpr double UnprojectTolerance = 1e-12;
constexpr int UnprojectIterations = 50;

/// Where in the coefficient vector each term stands (OpenCV's order).
enum Coefficient
{
  K1,
  K2,
  P1,
  P2,
  K3,
  K4,
  K5,
  K6,
  S1,
  S2,
  S3,
  S4,
  TauX,
  TauY
};

/// The radial factor and its derivative by r^2.
struct Radial
{
  double factor;
  double derivative;
  double denominator;
};

Radial radialFactor(const double* k, double r2)
{
  const double numerator = 1 + r2 * (k[K1] + r2 * (k[K2] + r2 * k[K3]));
  const double denominator = 1 + r2 * (k[K4] + r2 * (k[K5] + r2 * k[K6]));
  const double numeratorSlope = k[K1] + r2 * (2 * k[K2] + r2 * 3 * k[K3]);
  const double denominatorSlope = k[K4] + r2 * (2 * k[K5] + r2 * 3 * k[K6]);
  const double factor = numerator / denominator;
  return { factor, (numeratorSlope - factor * denominatorSlope) / denominator, denominator };
}

/// Slope of the distorted radius by the undistorted one; not positive where the lens folds back.
double radialSlope(const double* k, double r)
{
  const Radial radial = radialFactor(k, r * r);
  return radial.denominator > 0 ? radial.factor + 2 * r * r * radial.derivative : -1;
}

/// The homography of a tilted sensor, as OpenCV defines it.
Eigen::Matrix3d tiltHomography(double tauX, double tauY)
{
  Eigen::Matrix3d aboutX;
  aboutX << 1, 0, 0, 0, std::cos(tauX), std::sin(tauX), 0, -std::sin(tauX), std::cos(tauX);
  Eigen::Matrix3d aboutY;
  aboutY << std::cos(tauY), 0, -std::sin(tauY), 0, 1, 0, std::sin(tauY), 0, std::cos(tauY);
  const Eigen::Matrix3d rotation = aboutY * aboutX;
  Eigen::Matrix3d projection;
  projection << rotation(2, 2), 0, -rotation(0, 2), 0, rotation(2, 2), -rotation(1, 2), 0, 0, 1;
  return projection * rotation;
}

}  // namespace

CameraModel::CameraModel(
  int width, int height, const Eigen::Matrix3d& cameraMatrix, const std::vector<double>& distortionCoefficients)
  : width_(width)
  , height_(height)
  , cameraMatrix_(cameraMatrix)
  , coefficients_(distortionCoefficients)
{
  const bool noSize = width == 0 && height == 0;
  if (!noSize && (width <= 0 || height <= 0))
  {
    throw std::invalid_argument(
      "the camera's image size is " + std::to_string(width) + " x " + std::to_string(height) + ", expected two positive numbers");
  }
  if (!cameraMatrix.allFinite() || !(fx() > 0) || !(fy() > 0))
  {
    throw std::invalid_argument("the camera matrix must hold finite numbers and positive focal lengths fx and fy");
  }
  const double offPattern = std::max({ std::abs(cameraMatrix(1, 0)), std::abs(cameraMatrix(2, 0)), std::abs(cameraMatrix(2, 1)),
    std::abs(cameraMatrix(0, 1)), std::abs(cameraMatrix(2, 2) - 1) });
  if (offPattern > 1e-9)
  {
    throw std::invalid_argument("the camera matrix must be [fx 0 cx; 0 fy cy; 0 0 1], without skew");
  }
  const std::size_t count = distortionCoefficients.size();
  if (count != 0 && count != 4 && count != 5 && count != 8 && count != 12 && count != 14)
  {
    throw std::invalid_argument(
      "the lens has " + std::to_string(count) + " distortion coefficients, expected 0, 4, 5, 8, 12 or 14 in OpenCV's order");
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!std::isfinite(distortionCoefficients[i]))
    {
      throw std::invalid_argument("distortion coefficient " + std::to_string(i + 1) + " is not a finite number");
    }
    k_[i] = distortionCoefficients[i];
  }
  tilt_ = tiltHomography(k_[TauX], k_[TauY]);
  maximumRadius_ = findMaximumRadius();
}

CameraModel CameraModel::withImageSize(int width, int height) const
{
  if (hasImageSize() && (width != width_ || height != height_))
  {
    throw std::invalid_argument("the lens was calibrated for images of " + std::to_string(width_) + " x " +
      std::to_string(height_) + " px, these are " + std::to_string(width) + " x " + std::to_string(height) + " px");
  }
  return CameraModel(width, height, cameraMatrix_, coefficients_);
}

double CameraModel::findMaximumRadius() const
{
  constexpr double step = 0.01;
  constexpr double furthest = 20;  // 87 degrees off the axis
  for (double r = step; r < furthest; r += step)
  {
    if (radialSlope(k_, r) <= 0)
    {
      double inside = r - step, outside = r;
      for (int i = 0; i < 50; ++i)
      {
        const double middle = (inside + outside) / 2;
        (radialSlope(k_, middle) > 0 ? inside : outside) = middle;
      }
      return inside;
    }
  }
  return std::numeric_limits<double>::infinity();
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& point_Normalized, Eigen::Matrix2d* jacobian) const
{
  const double x = point_Normalized.x(), y = point_Normalized.y();
  const double r2 = x * x + y * y;
  const Radial radial = radialFactor(k_, r2);
  const Eigen::Vector2d bent(x * radial.factor + 2 * k_[P1] * x * y + k_[P2] * (r2 + 2 * x * x) + r2 * (k_[S1] + k_[S2] * r2),
    y * radial.factor + k_[P1] * (r2 + 2 * y * y) + 2 * k_[P2] * x * y + r2 * (k_[S3] + k_[S4] * r2));
  const Eigen::Vector3d tilted = tilt_ * bent.homogeneous();
  if (jacobian)
  {
    const double prismX = 2 * (k_[S1] + 2 * k_[S2] * r2), prismY = 2 * (k_[S3] + 2 * k_[S4] * r2);
    Eigen::Matrix2d bend;
    bend << radial.factor + 2 * x * x * radial.derivative + 2 * k_[P1] * y + 6 * k_[P2] * x + prismX * x,
      2 * x * y * radial.derivative + 2 * k_[P1] * x + 2 * k_[P2] * y + prismX * y,
      2 * x * y * radial.derivative + 2 * k_[P1] * x + 2 * k_[P2] * y + prismY * x,
      radial.factor + 2 * y * y * radial.derivative + 6 * k_[P1] * y + 2 * k_[P2] * x + prismY * y;
    const Eigen::Vector2d seen = tilted.hnormalized();
    const Eigen::Matrix2d tilting = (tilt_.topLeftCorner<2, 2>() - seen * tilt_.bottomLeftCorner<1, 2>()) / tilted.z();
    *jacobian = tilting * bend;
  }
  return tilted.hnormalized();
}

CameraModel::Projection CameraModel::project(const Eigen::Vector3d& point_Camera, Eigen::Matrix<double, 2, 3>* jacobian) const
{
  Projection result;
  if (!point_Camera.allFinite() || !(point_Camera.z() > 0))
  {
    return result;
  }
  const Eigen::Vector2d normalized = point_Camera.hnormalized();
  Eigen::Matrix2d lens;
  const Eigen::Vector2d distorted = distort(normalized, jacobian ? &lens : nullptr);
  result.point_Image = { fx() * distorted.x() + cx(), fy() * distorted.y() + cy() };
  result.status = normalized.norm() < maximumRadius_ ? Status::Ok : Status::OutsideLensModel;
  if (jacobian)
  {
    Eigen::Matrix<double, 2, 3> perspective;
    perspective << 1, 0, -normalized.x(), 0, 1, -normalized.y();
    *jacobian = Eigen::Vector2d(fx(), fy()).asDiagonal() * lens * perspective / point_Camera.z();
  }
  return result;
}

CameraModel::Unprojection CameraModel::unproject(const Eigen::Vector2d& point_Image) const
{
  Unprojection result;
  if (!point_Image.allFinite())
  {
    return result;
  }
  const Eigen::Vector2d target((point_Image.x() - cx()) / fx(), (point_Image.y() - cy()) / fy());
  // The radial part alone, inverted by bisection where it is monotonous, starts Newton's iteration inside the valid region.
  const double targetRadius = target.norm();
  double inside = 0, outside = std::min(maximumRadius_, 2 * targetRadius + 1);
  while (outside < maximumRadius_ && outside * radialFactor(k_, outside * outside).factor < targetRadius && outside < 1e3)
  {
    outside = std::min(maximumRadius_, 2 * outside);
  }
  for (int i = 0; i < 20; ++i)
  {
    const double middle = (inside + outside) / 2;
    (middle * radialFactor(k_, middle * middle).factor < targetRadius ? inside : outside) = middle;
  }
  Eigen::Vector2d normalized = targetRadius > 0 ? Eigen::Vector2d(target * (inside / targetRadius)) : Eigen::Vector2d::Zero();
  for (int i = 0; i < UnprojectIterations; ++i)
  {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d error = distort(normalized, &jacobian) - target;
    if (!(error.norm() < 1e6) || !(jacobian.determinant() > 1e-12))
    {
      result.status = Status::OutsideLensModel;
      return result;
    }
    if (error.norm() <= UnprojectTolerance * std::max(1.0, targetRadius))
    {
      result.status = normalized.norm() < maximumRadius_ ? Status::Ok : Status::OutsideLensModel;
      result.ray_Camera = normalized.homogeneous().normalized();
      return result;
    }
    normalized -= jacobian.inverse() * error;
  }
  return result;
}

std::string toString(CameraModel::Status status)
{
  switch (status)
  {
    case CameraModel::Status::Ok:
      return "ok";
    case CameraModel::Status::BehindCamera:
      return "behind_camera";
    case CameraModel::Status::OutsideLensModel:
      return "outside_lens_model";
    case CameraModel::Status::NotConverged:
      return "not_converged";
  }
  return "unknown";
}

}  // namespace handeye
