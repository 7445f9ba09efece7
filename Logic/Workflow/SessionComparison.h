// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "Capture.h"
#include "ComparedMethods.h"
#include "MethodComparison.h"
#include "Recording.h"

#include <Eigen/Core>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// What of a session is compared: its samples, which were evaluated already, with their pictures, and what a person adds.
struct SessionComparisonInput
{
  CameraModel camera;
  std::string lensOrigin;                                ///< for the report: where the lens is from
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();  ///< mm
  Eigen::Matrix3d tipCovariance_Stylus = Eigen::Matrix3d::Zero();
  double ballRadiusMm = 0;
  BallDetectionOptions detection;
  ToolNames tools;
  /// Samples to calibrate from and to validate on; `frame` is the number of the picture in the folder.
  std::vector<CapturedFrame> capture, validation;
  std::filesystem::path captureFolder, validationFolder;
  /// Independent captures of the ball, for the repeatability: recordings or sessions that share no sample with each other, the
  /// session's own capture or its validation.
  std::vector<std::filesystem::path> otherCaptures;
  /// A board that stands still while the tracked camera moves; without it only the methods with the ball are compared.
  std::filesystem::path boardRecording;
  std::optional<BoardDescription> board;
  double branchAndBoundSec = 30;  ///< at most so long for a capture; 0 leaves it out
  ComparisonOptions comparison;   ///< its progress is not looked at
};

struct SessionComparison
{
  ComparisonResult result;
  CameraModel camera;
  std::vector<HandEyeSample> validation;
  std::vector<CapturedFrame> validationFrames;
  std::optional<io::Recording> validationRecording;  ///< the pictures
  std::vector<std::string> facts;                    ///< sentences: what was compared, from which files
};

/// Told what is being done, and how many of how many are; returns false to stop.
using ComparisonProgress = std::function<bool(const std::string& what, int done, int total)>;

/// Every method on a session's samples, as `handeye compare` does it on recordings; see compareMethods(). The samples' pictures are
/// looked at by the paper's segmentation as well.
///
/// @return `result.wasStopped` where progress said so
/// @throws io::FileError, std::invalid_argument where a file cannot be read or does not belong to the camera, where captures have
/// samples in common (see DistinctCaptures), and where a latency cannot be applied to a recording's poses (see latencyNotes())
/// Thread-safe; needs no session to be open.
[[nodiscard]] SessionComparison compareSession(const SessionComparisonInput& input, const ComparisonProgress& progress = {});

}  // namespace handeye
