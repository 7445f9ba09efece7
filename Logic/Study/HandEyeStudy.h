// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MethodComparison.h"
#include "StudyTrial.h"

#include <functional>
#include <string>
#include <vector>

namespace handeye::study
{

struct StudyOptions
{
  int repetitions = 100;
  unsigned seed = 1;
  int jobs = 1;                   ///< threads
  TrialSize size;                 ///< samples and views of a repetition
  double trackingSigmaMm = 0.12;  ///< of every pose of every marker, per axis
  double trackingSigmaDeg = 0.025;
  double lensFocalShare =
    0;                      ///< error of the lens that all methods are told, anew in each repetition: the focal length, as a share
  double lensCenterPx = 0;  ///< and the principal point, px per axis
  double boardScaleShare = 0;        ///< error of the size in which the board is printed, as a share, anew in each repetition
  double cornerSigmaPx = -1;         ///< noise of the board's corners, px per axis; below 0: measured on pictures
  bool isNoiseFree = false;          ///< neither tracker nor features have noise: every method must find the truth
  int noisePictures = 20;            ///< of ball and board each, from which a camera's feature noise is measured
  int subsetRepetitions = 20;        ///< the first so many repetitions also give random subsets of 3 to 30 samples
  int tiltRepetitions = 20;          ///< of the first eye for each range of the board's directions; 0 leaves that out
  int conditionRepetitions = 20;     ///< of the first eye for each of studyConditions(); 0 leaves that out
  int renderedRepetitions = 0;       ///< repetitions whose features are really found in rendered pictures, besides the others
  double branchAndBoundSec = 2;      ///< time limit of one; 0 leaves it out
  std::vector<std::string> cameras;  ///< names; all where empty
  /// Told how many of how many steps are done, from any of the threads, one at a time; returns false to stop.
  std::function<bool(const std::string& what, int done, int total)> progress;

  /// @throws std::invalid_argument with a sentence where a number makes no sense or there is no such camera
  void check() const;
};

/// What was found with the board seen from a smaller or larger range of directions.
struct StudyTiltResult
{
  double tiltDeg = 0;  ///< up to so far off its normal; turned by up to 4/3 of it
  ComparisonResult comparison, truth;
};

/// What was found under one of studyConditions().
struct StudyConditionResult
{
  std::string words;
  ComparisonResult comparison, truth;
};

/// What was found for one camera. All repetitions and eyes are pooled.
struct StudyCameraResult
{
  StudyCamera camera;
  StudyNoise noise;             ///< that the repetitions had
  FeatureNoise measured;        ///< where the features' part of it comes from
  ComparisonResult comparison;  ///< against what the validation shows: tracked and segmented balls, as a user has them
  ComparisonResult truth;       ///< the same calibrations against the same balls without noise: the calibrations' own error
  Summary floorPx;              ///< what the validation shows of a perfect calibration: the noise of the validation alone
  std::vector<StudyTiltResult> byTilt;
  std::vector<StudyConditionResult> byCondition;
  /// With features that were found in pictures; no methods where none were asked for.
  ComparisonResult rendered;
  int renderedEyes = 0;
};

/// One thing that is to hold of a camera, with what was measured; where it does not hold, with the reason in numbers.
struct StudyCheck
{
  std::string what;  ///< "lowest maximum of the six methods"
  bool holds = false;
  std::string measured;      ///< "ml 3.71 px, tsai 3.47 px"
  std::string reason;        ///< empty where it holds
  bool isOfThePaper = true;  ///< false: of a method that the paper does not have
};

/// Whether what the paper reports holds for a camera.
struct StudyClaim
{
  std::string camera;
  bool hasLowestMean = false;  ///< point-to-line (`ml`) against every method with a board
  bool hasLowestMaximum = false;
  std::string lowestMean, lowestMaximum;  ///< whose they are, of all methods
  double branchAndBoundMean = 0;          ///< its mean error over that of `ml`; 0 where it gave none
  double branchAndBoundMaximum = 0;
  double trackedBoardMean = 0;        ///< the mean error of `tracked-board` over that of `ml`; 0 where it gave none
  double branchAndBoundTrueMean = 0;  ///< the same of the calibrations' own errors
  /// Mean and maximum, as validated and the calibrations' own; a board that is tracked; the factor of three.
  std::vector<StudyCheck> checks;
  std::string message;
};

struct StudyResult
{
  StudyOptions options;
  std::vector<StudyCameraResult> cameras;
  std::vector<StudyClaim> claims;  ///< one a camera
  bool wasStopped = false;
  std::string status;   ///< "ok", "stopped"
  std::string message;  ///< the verdict, for a person

  bool isUsable() const { return status == "ok"; }
};

/// The paper's cameras in simulation: for each repetition and eye a capture of the ball, one of a board and a validation set, all
/// with the noise of one tracker; every method on them.
///
/// Seeds are fixed: the same options give the same numbers, but for the branch and bound where its time limit ends it.
/// @throws std::invalid_argument as StudyOptions::check(); std::runtime_error where a camera's features are not found in its
/// pictures Thread-safe.
[[nodiscard]] StudyResult runStudy(const StudyOptions& options);

/// What holds of a camera's results and what does not, and why; see StudyClaim::checks.
[[nodiscard]] std::vector<StudyCheck> checkClaims(const StudyCameraResult& result);

/// Judges a camera's results; see StudyClaim.
[[nodiscard]] StudyClaim judgeClaim(const StudyCameraResult& result);

}  // namespace handeye::study
