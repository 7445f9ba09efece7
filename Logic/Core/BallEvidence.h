// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallColorLevels.h"
#include "BallDetection.h"
#include "CameraModel.h"
#include "OutlineFit.h"

#include <opencv2/core.hpp>

namespace handeye
{

/// What speaks for a fitted outline being the ball's: how much of it was seen, what colour lies inside, and whether the colour ends
/// there. Internal to the detection.
struct BallEvidence
{
  double radiusPx = 0;  ///< the root of the outline's area over pi
  double fill = 0;      ///< share of what the seen outline encloses, or of its rim, that has the ball's colour or is a highlight
  double continuedShare = 0;  ///< of the outline: the colour goes on across it, without an edge
  bool isBall = false;        ///< passes every test
  bool isPartOfBall = false;  ///< passes all but the visible share
  double score = 0;           ///< 0 to 1
};

/// @param image the whole image
/// @param largestSigmaPx edge points that scatter more are not the outline of a ball
/// @param level which of the colour levels the outline was found in
BallEvidence judgeOutline(const OutlineFit& fit, const cv::Mat& image, const BallColorLevels& levels, int level,
  const CameraModel& camera, const BallDetectionOptions& options, double largestSigmaPx);

}  // namespace handeye
