// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallOptions.h"
#include "BoardCapture.h"
#include "Capture.h"
#include "CommandOutput.h"
#include "ComparedMethods.h"
#include "Recording.h"

#include <optional>
#include <string>
#include <vector>

namespace handeye::cli
{

/// What `handeye compare` reads.
struct CompareInputs
{
  std::string validation;
  std::vector<std::string> ballRecordings, boardRecordings;
  std::optional<BoardDescription> board;  ///< where there are recordings of one
  TrackedBoardNames trackedBoard;
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  double ballRadiusMm = 0;
  ToolNames tools;
  bool withPublished = true;
};

struct CompareCaptures
{
  CameraModel camera;
  io::Recording validationRecording;
  std::vector<CapturedFrame> validationFrames;
  std::vector<HandEyeSample> validation;
  std::vector<BallCapture> balls;
  std::vector<std::vector<BoardHandEyeView>> boards;
  std::vector<std::string> facts;  ///< a sentence a capture
};

/// Finds the ball in all recordings; those to calibrate from are looked at with the paper's segmentation, too. The validation's
/// ball is found by the segmentation that the options name, for all methods. A board that looks the same after half a turn is
/// given the numbering that agrees with the tracker.
/// @throws io::FileError, std::invalid_argument as readCapture(), and where two of them share samples (see DistinctCaptures);
///   std::runtime_error where Ctrl+C stopped it
CompareCaptures readCompareCaptures(
  const CompareInputs& inputs, const CameraModel& camera, const BallOptions& ball, const CommandOutput& output);

}  // namespace handeye::cli
