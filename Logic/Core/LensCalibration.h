// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDetection.h"
#include "CameraModel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// One picture of a board.
struct LensView
{
  int frame = 0;                              ///< index in the recording, passed through
  std::vector<int> ids;                       ///< of the points
  std::vector<Eigen::Vector3d> points_Board;  ///< mm, one per id, z = 0
  std::vector<Eigen::Vector2d> points_Image;  ///< px, one per id
};

/// The view of a detection.
LensView toLensView(int frame, const BoardDetection& detection);

struct LensCalibrationOptions
{
  /// Distortion coefficients: 4 (k1 k2 p1 p2), 5 (and k3) or 8 (and k4 k5 k6, rational).
  int coefficients = 5;
  /// Fit the other two models as well, to say which one the data support.
  bool compareModels = true;
  int minimumViews = 6;
  bool rejectOutlierViews = true;
  /// A view is an outlier when its root mean square residual exceeds this multiple of the median of all views'.
  double rejectionFactor = 3;
  double maximumRejectedShare = 0.34;
  /// A larger root mean square residual (px) is no lens of this kind, or not this board.
  double maximumRmsPx = 2;
  /// A focal length whose standard deviation is above this share of it is not observed: the views are all parallel, or too few.
  double maximumFocalDeviation = 0.02;
  /// The views' planes must differ by this angle (rad); a lens that only sees parallel boards has no focal length.
  double minimumTiltSpreadRad = 0.12;
  /// Diameter of the circles of a circle grid, mm: the centre of a circle's picture is not the picture of its centre. 0: no
  /// circles.
  double circleDiameterMm = 0;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// How well one of the lens models fits the same views.
struct LensModelComparison
{
  int coefficients = 0;
  double rmsPx = 0;
  double informationCriterion = 0;  ///< Schwarz': n ln(cost / n) + parameters ln(n); smaller is better
  double focalPx = 0;               ///< mean of fx and fy
  bool isSupported = false;         ///< the smallest model, or one that lowers the criterion by more than 10
};

struct LensCalibrationResult
{
  enum class Status
  {
    Ok,
    TooFewViews,
    ParallelViews,  ///< the board always stood the same way: the focal length cannot be told from the distance
    TooUncertain,   ///< the parameters' standard deviations are too large to be of use
    MixedViews,     ///< too many views disagree: another board, or a zoom that changed
    NoFit,          ///< no lens explains the views
    /// the lens polynomial folds back on itself inside the image: too few points near the border, or too many coefficients
    FoldsInImage
  };

  struct View
  {
    int frame = 0;
    bool used = false;
    std::string message;  ///< of a view that was left out: why
    double rmsPx = 0;
    double maximumPx = 0;
    std::vector<Eigen::Vector2d> residuals_Image;                     ///< one per point, seen minus projected, px
    Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();  ///< p_Camera = boardToCamera * p_Board
  };

  Status status = Status::TooFewViews;
  std::string message;                ///< for a person, verdict first
  std::optional<CameraModel> camera;  ///< only if usable
  double rmsPx = 0;                   ///< root of the mean square distance over all points that were used
  double meanPx = 0;
  int usedCount = 0;
  std::vector<View> views;  ///< one per view given
  /// Standard deviations, px: of fx, fy, cx, cy; and of the coefficients in their order.
  Eigen::Vector4d cameraMatrixSigmas = Eigen::Vector4d::Zero();
  std::vector<double> coefficientSigmas;
  std::vector<LensModelComparison> models;  ///< of 4, 5 and 8 coefficients, where they were compared
  int supportedCoefficients = 0;            ///< the model that the data support; 0 where not compared
  std::string modelHint;                    ///< a sentence about it

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds a lens from pictures of a board: Zhang's method, by OpenCV, with what is needed to believe it.
///
/// Views that disagree with the rest are left out and named, one at a time, the worst first. The standard deviations follow from
/// the
/// normal equations and the scatter of the residuals. Which model the data support: the largest that lowers Schwarz' criterion by
/// more than 10 against the smaller ones, which takes the standard deviations of its coefficients, and how they hide each other,
/// into
/// account.
///
/// @param views of one board, taken with the same zoom and focus
/// @param width,height of the pictures, px
/// @throws std::invalid_argument, naming the view (index, from 0), where sizes differ, a number is not finite or a size is not
///         positive
/// Thread-safe, deterministic.
/// Reference: Zhang, "A flexible new technique for camera calibration", PAMI 22:1330 (2000).
[[nodiscard]] LensCalibrationResult calibrateLens(
  const std::vector<LensView>& views, int width, int height, const LensCalibrationOptions& options = {});

/// "ok", "too_few_views", ...: the word that result files use.
std::string toString(LensCalibrationResult::Status status);

}  // namespace handeye
