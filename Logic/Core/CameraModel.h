// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace handeye
{

/// A pinhole camera with a Brown-Conrady lens.
///
/// Frames: `Camera` is OpenCV's (x right, y down, z forward, mm); pixels are those of the recorded, distorted image, integer
/// coordinates being pixel centres. For a point p_Camera with x = X/Z, y = Y/Z and r2 = x^2 + y^2,
///
///     radial = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)
///     x' = x radial + 2 p1 x y + p2 (r2 + 2 x^2) + s1 r2 + s2 r2^2
///     y' = y radial + p1 (r2 + 2 y^2) + 2 p2 x y + s3 r2 + s4 r2^2
///     u  = fx x'' + cx,  v = fy y'' + cy,  (x'', y'') = (x', y') seen through the tilt (tauX, tauY) of the sensor
///
/// The coefficients come in OpenCV's order k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tauX tauY]]]]: 0, 4, 5, 8, 12 or 14 of them.
///
/// A lens polynomial is fitted inside the image and folds back on itself somewhere outside of it; a point beyond the fold would be
/// drawn where it is not. project() and unproject() therefore know how far the model can be believed (maximumRadius()) and say so.
///
/// Immutable after construction, hence safe to share between threads.
/// Reference: OpenCV, camera calibration and 3D reconstruction; D. C. Brown, "Close-range camera calibration", 1971.
class CameraModel
{
public:
  enum class Status
  {
    Ok,
    BehindCamera,      ///< Z is not positive
    OutsideLensModel,  ///< further off the axis than the distortion polynomial can be believed
    NotConverged       ///< the iteration of unproject() did not reach 1e-12
  };

  struct Projection
  {
    Status status = Status::BehindCamera;
    Eigen::Vector2d point_Image = Eigen::Vector2d::Zero();  ///< px; not meaningful unless status is Ok
    bool isUsable() const { return status == Status::Ok; }
  };

  struct Unprojection
  {
    Status status = Status::NotConverged;
    Eigen::Vector3d ray_Camera = Eigen::Vector3d::UnitZ();  ///< unit length; not meaningful unless status is Ok
    bool isUsable() const { return status == Status::Ok; }
  };

  /// @param width,height size of the image in px, positive, or both 0 where the camera file does not say
  /// @param cameraMatrix [fx 0 cx; 0 fy cy; 0 0 1], px; fx and fy positive, no skew
  /// @param distortionCoefficients 0, 4, 5, 8, 12 or 14 numbers in OpenCV's order
  /// @throws std::invalid_argument with a sentence for any other input, NaN and infinity included
  CameraModel(int width, int height, const Eigen::Matrix3d& cameraMatrix, const std::vector<double>& distortionCoefficients);

  int width() const { return width_; }
  int height() const { return height_; }
  bool hasImageSize() const { return width_ > 0; }
  const Eigen::Matrix3d& cameraMatrix() const { return cameraMatrix_; }
  const std::vector<double>& distortionCoefficients() const { return coefficients_; }
  double fx() const { return cameraMatrix_(0, 0); }
  double fy() const { return cameraMatrix_(1, 1); }
  double cx() const { return cameraMatrix_(0, 2); }
  double cy() const { return cameraMatrix_(1, 2); }

  /// The same lens for an image of this size; @throws std::invalid_argument where the lens was calibrated for another size.
  CameraModel withImageSize(int width, int height) const;

  /// Projects p_Camera (mm) to the distorted image (px).
  /// @param jacobian if given, the 2x3 derivative of the pixel by p_Camera (px/mm), valid where the status is Ok
  [[nodiscard]] Projection project(const Eigen::Vector3d& point_Camera, Eigen::Matrix<double, 2, 3>* jacobian = nullptr) const;

  /// The unit ray on which everything lies that is seen at this pixel; Newton's iteration until the normalised coordinates
  /// reproduce the pixel to 1e-12.
  [[nodiscard]] Unprojection unproject(const Eigen::Vector2d& point_Image) const;

  /// Undistorted normalised coordinates (x, y) = (X/Z, Y/Z) to distorted ones (x'', y''), and the 2x2 derivative.
  Eigen::Vector2d distort(const Eigen::Vector2d& point_Normalized, Eigen::Matrix2d* jacobian = nullptr) const;

  /// The largest sqrt(x^2 + y^2) of undistorted normalised coordinates for which the radial polynomial still grows
  /// (infinity if it always does).
  double maximumRadius() const { return maximumRadius_; }

private:
  double findMaximumRadius() const;

  int width_ = 0;
  int height_ = 0;
  Eigen::Matrix3d cameraMatrix_;
  std::vector<double> coefficients_;
  double k_[14] = {};  ///< the coefficients, zero where not given
  Eigen::Matrix3d tilt_ = Eigen::Matrix3d::Identity();
  double maximumRadius_ = 0;
};

/// "ok", "behind_camera", ...: the word that result files use.
std::string toString(CameraModel::Status status);

}  // namespace handeye
