// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardCapture.h"
#include "LensRepeatability.h"
#include "LensStereo.h"

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

namespace handeye
{

/// A lens calibration as `handeye camera calibrate --json` prints it: `status`, `message`, `board`, `camera`, `reprojectionRmsPx`,
/// `sigmas`, `models`, `modelHint`, `views` (one a frame) and, where there are any, `coverage` and `tilts`.
nlohmann::json lensJson(const LensCalibrationResult& result, const BoardDescription& board, const std::vector<BoardFrame>& frames,
  const LensViewCollector* collector);

/// `repetitions`: how many, how many failed, mean and standard deviation of each parameter, and the shift in px.
nlohmann::json repetitionJson(const LensRepetition& repetition);

/// A board-based calibration and all that belongs to it.
struct BoardCalibration
{
  BoardHandEyeResult result;
  BoardHandEyeOptions::Method method = BoardHandEyeOptions::Method::Daniilidis;
  BoardDescription board;
  CameraModel camera;
  std::vector<BoardFrame> frames;
  std::vector<int> viewFrames;  ///< the frame of each view of the result
  ToolNames tools;
  std::optional<Eigen::Vector3d> tip_Stylus;  ///< for `handeye validate`, which needs the ball
  std::optional<double> ballRadiusMm;
};

/// calibration.json as `handeye calibrate` writes it, with `method`, `board`, `boardToTracker` and, of the branch and bound,
/// `branchAndBound`. `samples` has one row a frame: {`frame`, `status`, `used`, `residualPx`, `residualMm`, `residualDeg`}.
/// `covariance` is there where the method has one. `handeye validate` reads it if it has the stylus and the ball.
nlohmann::json boardCalibrationJson(const BoardCalibration& calibration);

}  // namespace handeye
