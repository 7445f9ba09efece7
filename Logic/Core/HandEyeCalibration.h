// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "PointLineRegistration.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// One eye of the camera head. A monocular camera has one, the head's `Camera` frame being its own.
struct Eye
{
  CameraModel camera;
  Eigen::Isometry3d cameraToEye = Eigen::Isometry3d::Identity();  ///< p_Eye = cameraToEye * p_Camera
};

/// One placement of the ball: where the tracker says it is, and the ray on which an eye sees it.
struct HandEyeSample
{
  int frame = 0;                                         ///< index in the recording, passed through
  int eye = 0;                                           ///< index into the eyes
  Eigen::Vector3d tip_Marker = Eigen::Vector3d::Zero();  ///< the ball's centre from the tracker, mm
  Eigen::Vector2d ball_Image = Eigen::Vector2d::Zero();  ///< the ball's centre in the eye's image, px
  Eigen::Vector3d ray_Eye = Eigen::Vector3d::UnitZ();    ///< the unit ray of that pixel
  double apparentDistanceMm = 0;  ///< of the ball from the eye, by its apparent size; 0 where it is not known
  double sigmaPx = 0;             ///< of the segmentation (one standard deviation per axis, px); 0 where it is not known
  /// Rotation of p_Marker = stylusToMarker * p_Stylus: says what an error of the tip's offset does here. Zero where not known.
  Eigen::Matrix3d stylusToMarker = Eigen::Matrix3d::Zero();
};

struct HandEyeCalibrationOptions
{
  PointLineOptions::Method method = PointLineOptions::Method::MaximumLikelihood;
  /// What the tracker (mm, at the tip) and the segmentation (px, of a sample that does not say itself) contribute to a sample's
  /// error; sets the samples' weights.
  double trackingSigmaMm = 0.35;
  double segmentationSigmaPx = 0.25;
  /// Of `MaximumLikelihood`: the two sigmas (and those of the samples) are shapes only, their sizes are estimated from the
  /// residuals.
  bool estimateNoise = false;
  /// Of the stylus' tip (mm^2, from the pivot calibration): an error that all samples share. Zero where it is not known.
  Eigen::Matrix3d tipCovariance_Stylus = Eigen::Matrix3d::Zero();
  /// Estimate the tip's offset along with the pose, its covariance being the prior (1 mm where it is not known).
  bool refineTip = false;
  /// Fewer places of the ball than this give no calibration. Samples of one place (a video of a ball that is held still) count as
  /// one.
  int minimumSamples = 6;
  /// Look for samples that disagree with the rest and leave them out.
  bool rejectOutliers = true;
  /// A sample disagrees when its residual exceeds this multiple of what its expected error (or, if larger, the scatter) allows.
  double rejectionFactor = 4.5;
  /// Largest share of samples that may disagree.
  double maximumRejectedShare = 0.5;
  /// Largest scatter of the used samples in multiples of what is expected of them; more is no calibration, whatever its covariance
  /// says.
  double maximumMisfit = 4;
  /// Largest deviation of the distances by apparent size from those by tracking, as a share: beyond it the ball's radius or the
  /// focal length is wrong. Shading makes a ball look up to 8 % small.
  double maximumScaleError = 0.15;
  /// Largest mean predicted projection error (px) over the working volume of a result that is called usable.
  double maximumPredictedErrorPx = 20;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// How far a point that the calibration maps may be from where it is seen (px, one standard deviation) and from where it is (mm,
/// the target registration error), as the covariance predicts it.
struct PredictedError
{
  double meanPx = 0;
  double maximumPx = 0;
  double meanMm = 0;
  double maximumMm = 0;
  double nearestMm = 0;  ///< the working volume: the image, between these depths
  double furthestMm = 0;
};

struct HandEyeCalibrationResult
{
  enum class Status
  {
    Ok,
    TooFewSamples,
    NoConsensus,    ///< more samples disagree with each other than agree
    NotObservable,  ///< the placements leave a freedom undetermined
    NotConverged,   ///< the iteration of `procrustes` reached its cap
    Mirrored,       ///< every solution has the ball behind the camera
    Ambiguous,      ///< two different solutions fit equally well
    NotApplicable,  ///< the method takes the rays of one camera only
    WrongScale,     ///< the ball's apparent size does not fit its tracked distance
    MarkerMoved,    ///< the first or the last samples in a row agree with each other, but not with the rest
    PoorFit,        ///< the solution does not explain its samples
    TooUncertain    ///< the predicted error is too large to be of use
  };

  struct Sample
  {
    bool used = false;
    double residualPx = 0;  ///< distance between the projected tip and the segmented ball, in its eye's image
    double residualMm = 0;  ///< distance of the tip to its ray
    double deviation = 0;   ///< the residual in multiples of what is expected of it; a large one is why a sample is left out
  };

  Status status = Status::TooFewSamples;
  std::string message;                                               ///< for a person, verdict first
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();  ///< p_Camera = markerToCamera * p_Marker; only if usable
  /// Of (rotation vector rad, translation mm) acting from the left in the camera frame: markerToCamera -> (exp(w), v) *
  /// markerToCamera.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<Sample> samples;  ///< one per sample given
  int usedCount = 0;
  int placeCount = 0;            ///< different places of the ball among the used samples
  double reprojectionRmsPx = 0;  ///< root mean square of the used samples' residuals; the data that were fitted, not a validation
  double pointToLineRmsMm = 0;
  int iterations = 0;
  double conditionNumber = 0;
  int rank = 0;  ///< freedoms that are determined, 6 if all
  /// The samples would fit much better with another focal length: the message says so. Looked for where the result is poor.
  bool isLensSuspect = false;
  std::string weakestFreedom;  ///< in words, with what it amounts to; of a covariance that is there
  PredictedError predicted;    ///< of the first eye
  std::vector<PredictedError> predictedByEye;
  double trackingSigmaMm = 0;  ///< the noise that the solution rests on, given or estimated
  double segmentationSigmaPx = 0;
  /// Only if it was asked for and the data determine it: the tip's offset that fits best, relative to the one given, and the
  /// covariance of it that remains.
  std::optional<Eigen::Vector3d> tipCorrection_Stylus;
  Eigen::Matrix3d refinedTipCovariance_Stylus = Eigen::Matrix3d::Zero();
  std::string tipMessage;  ///< what became of the refinement, if it was asked for

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds where the camera sits relative to its marker: points (the tracked ball) must lie on lines (the rays on which the eyes see
/// it).
///
/// Samples that disagree are found by consensus: each set of four (a few hundred of them if there are more) is registered, and the
/// one that most of the others agree with decides who stays. The rest is solved by the chosen method. `MaximumLikelihood` weights
/// each residual by the inverse of its covariance  sigma_px^2 I + sigma_mm^2 J J^T, J the projection's derivative by the point: the
/// tracker acts in mm and the segmentation in px. `Global` takes 1 / (sigma_mm^2 + (sigma_px distance / f)^2), the others no
/// weights.
///
/// The covariance is that of the method's own weights under this noise (a sandwich): samples of one place share the tracker's
/// error, also between two eyes, and repeated ones of one eye the segmentation's; an error of the tip turns with the stylus.
///
/// @param eyes one camera, or two of a stereo head with a known relation
/// @throws std::invalid_argument if a sample names an eye that is not there or holds a number that is not finite
/// Thread-safe, deterministic.
/// Reference: Morgan et al., Int J CARS 12:1141 (2017).
[[nodiscard]] HandEyeCalibrationResult calibrateHandEye(
  const std::vector<HandEyeSample>& samples, const std::vector<Eye>& eyes, const HandEyeCalibrationOptions& options = {});

/// "ok", "too_few_samples", ...: the word that result files use.
std::string toString(HandEyeCalibrationResult::Status status);

}  // namespace handeye
