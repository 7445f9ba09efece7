// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardHandEye.h"
#include "ComparedMethods.h"
#include "StudyCamera.h"
#include "StudyPictures.h"

#include <vector>

namespace handeye::study
{

/// How noisy the study's tracker and features are: one standard deviation, per axis.
struct StudyNoise
{
  double trackingSigmaMm = 0;   ///< of every pose, at the marker's origin
  double trackingSigmaRad = 0;  ///< of every pose
  double ballSigmaPx = 0;       ///< of the segmented centre
  double cornerSigmaPx = 0;     ///< of the board's corners
  double lensFocalShare = 0;    ///< of the focal length that the methods are told, as a share of it
  double lensCenterPx = 0;      ///< of the principal point that the methods are told
  double boardScaleShare = 0;   ///< of the size in which the board is printed, as a share of it
  double stylusShare = 1;       ///< the stylus' poses have so much of the tracking noise while its ball is captured
};

struct TrialSize
{
  int ballSamples = 15, boardViews = 15, validationSamples = 15, pivotPoses = 320;
  double boardTiltDeg = 45;  ///< the board is looked at from up to so far off its normal
  double boardRollDeg = 60;  ///< the camera is turned about its axis by up to so much, to either side
};

/// What one repetition gives to the methods, and to judge them by.
struct StudyTrial
{
  CameraModel lens;  ///< as the methods are told; of the truth it differs by the noise of the lens
  BallCapture ball;
  std::vector<BoardHandEyeView> board;
  std::vector<HandEyeSample> validation;      ///< as a user has it: tracked and segmented
  std::vector<HandEyeSample> trueValidation;  ///< the same balls without noise
  Eigen::Matrix3d tipCovariance_Stylus = Eigen::Matrix3d::Zero();
};

/// One repetition for one eye, all of it from one tracker: a stylus is pivoted (its tip is what the pivot calibration finds), its
/// ball is held at random places in the view and the depths, the camera looks at a board that stands still from random directions,
/// and the ball is held at other places for the validation. Every pose of every marker has fresh noise.
///
/// @param pictures the features are found in rendered pictures, taken with the true lens and of the board as it was printed; their
///   noise is that of the pictures. Without, they are projected and given the noise
/// Thread-safe, deterministic.
[[nodiscard]] StudyTrial makeTrial(const StudyCamera& camera, const StudyEye& eye, const StudyNoise& noise, const TrialSize& size,
  unsigned seed, const StudyPictures* pictures = nullptr);

}  // namespace handeye::study
