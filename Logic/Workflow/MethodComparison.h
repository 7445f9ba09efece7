// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeValidation.h"

#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// What one method made of one capture.
struct MethodAnswer
{
  std::string status;                               ///< "ok", or the word of the reason
  std::string message;                              ///< for a person
  std::optional<Eigen::Isometry3d> markerToCamera;  ///< p_Camera = markerToCamera * p_Marker, mm; only if usable
  int sampleCount = 0;                              ///< samples that it was given
  int usedCount = 0;                                ///< those that it kept
  double seconds = 0;
  std::optional<double> gap;  ///< of a method that proves a bound: how far above it the answer is, as a share

  bool isUsable() const { return status == "ok" && markerToCamera.has_value(); }
};

/// A method together with the captures that it is compared on.
struct ComparedMethod
{
  enum class Target
  {
    Ball,
    Board
  };

  std::string name;       ///< the word of files and of the command line
  std::string title;      ///< for a person
  std::string reference;  ///< who published it
  Target target = Target::Ball;
  /// Its own place in the comparison: the calibration that this product is for.
  bool isOurs = false;
  /// For each independent capture the numbers of the samples in it.
  std::vector<int> sampleCounts;
  /// Subsets are drawn from so many samples of the first capture.
  int subsetPool = 0;
  /// The whole capture.
  std::function<MethodAnswer(int capture)> calibrate;
  /// Some of the first capture's samples (0 to subsetPool - 1), however few: the method says itself when they are too few. Empty
  /// where that would take too long.
  std::function<MethodAnswer(const std::vector<int>& samples)> calibrateSome;
};

struct ComparisonOptions
{
  int fewestSamples = 3, mostSamples = 30;  ///< of the random subsets
  int subsetRepetitions = 20;               ///< of each size; 0: no subsets
  int halvings = 5;                         ///< of a capture that stands alone: random halves for the repeatability
  unsigned seed = 1;
  /// Told what is being done and how many of how many are; returns false to stop. Called in the caller's thread.
  std::function<bool(const std::string& what, int done, int total)> progress;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// One method on one capture, against the validation set.
struct ComparedCapture
{
  MethodAnswer answer;
  HandEyeValidationResult validation;  ///< empty unless the answer is usable
};

/// Random subsets of one size. A subset that gave no calibration counts as worse than any that did: a percentile that falls among
/// such is infinite, so that no method looks good by failing where it is difficult.
struct SubsetErrors
{
  int sampleCount = 0;
  int repetitions = 0;
  int usable = 0;        ///< of the repetitions
  double medianPx = 0;   ///< of the mean projection errors on the validation set
  double lowestPx = 0;   ///< their 10th
  double highestPx = 0;  ///< and 90th percentile

  /// Percentiles of the mean errors (px) of those that were usable.
  void summarize(std::vector<double> means);
};

/// How alike calibrations from different data are: root mean squares about their mean.
struct Repeatability
{
  int calibrations = 0;  ///< usable ones; the rest is meaningful from 2 on
  int attempts = 0;
  bool areHalves = false;  ///< of one capture, at random: twice as noisy as whole ones
  double rotationDeg = 0;
  double translationMm = 0;
  double projectionPx = 0;  ///< of where the validation set's balls are put
  double worstPx = 0;
};

struct MethodResult
{
  std::string name, title, reference;
  ComparedMethod::Target target = ComparedMethod::Target::Ball;
  bool isOurs = false;
  std::vector<ComparedCapture> captures;  ///< in the order of the method's captures
  Summary errorPx;                        ///< over all usable captures and all validation samples
  /// What the ranking compares: where every ranked method of its target has an error, at validation samples for which those of the
  /// other target have one, too; nothing for a method that is not ranked with the others.
  Summary commonErrorPx;
  double successShare = 0;  ///< of the errors that it would have, had no capture failed and no ball left the view
  std::string status;       ///< "ok" if one capture at least was usable; otherwise that of the first
  std::string message;      ///< what became of the captures that were not usable; otherwise the answer's own
  std::vector<SubsetErrors> subsets;
  Repeatability repeatability;

  bool isUsable() const { return status == "ok" && errorPx.count > 0; }
  int usableCount() const;
  double medianSeconds() const;  ///< of the whole captures
};

struct ComparisonResult
{
  std::vector<MethodResult> methods;  ///< in the order given
  /// Indices of the usable ones: by the mean of their commonErrorPx, the lowest first; then those of `incomplete`.
  std::vector<int> ranking;
  /// Usable ones that failed so much more often than others that their mean is one of easy cases: ranked after all others.
  std::vector<int> incomplete;
  /// Of the ranking, those whose mean error cannot be told from the best one's: the paired difference over the validation samples
  /// (from 5 captures on: over the captures) is below twice its standard error or, with fewer captures, below what another capture
  /// would have changed.
  std::vector<int> notToldApart;
  int validationCount = 0;
  /// Capture k of the ball and capture k of the board are one repetition with one validation set, as in a simulation. Otherwise they
  /// have nothing in common, and methods with different targets are compared by their mean errors at each validation sample.
  bool hasPairedCaptures = false;
  bool wasStopped = false;
  std::string status;   ///< "ok", "no_validation", "no_method", "stopped"
  std::string message;  ///< the verdict, for a person

  bool isUsable() const { return status == "ok"; }
};

/// Every method on the same captures, the same validation set and the same lens:
///
/// - projection error of each calibration on the validation set, tip_Camera = markerToCamera * tip_Marker through the lens against
///   the segmented centre (mean, standard deviation, least, greatest, RMS; px);
/// - the same for random subsets of the first capture, by their size, with fixed seeds;
/// - repeatability: over the captures, or over random halves where there is only one.
///
/// A method that fails stays, with its status and reason. A method that throws std::invalid_argument is a mistake of the caller.
///
/// @param validation samples of captures that were not fitted, one eye
/// Thread-safe; deterministic but for the times.
/// Reference: Morgan et al., Int J CARS 12:1141 (2017), tables 2-4 and figures 6, 8, 9.
[[nodiscard]] ComparisonResult compareMethods(const std::vector<ComparedMethod>& methods,
  const std::vector<HandEyeSample>& validation, const CameraModel& camera, const ComparisonOptions& options = {});

/// The parts of it, for whoever pools several comparisons: the summary, the status and the message of a method's captures.
void summarizeMethod(MethodResult& method);
/// Ranking, status and verdict of methods that are summarised.
void judgeComparison(ComparisonResult& result);

/// "ball", "board"
std::string toString(ComparedMethod::Target target);
/// A status as a person writes it: "poor fit" of "poor_fit".
std::string statusWords(std::string status);

}  // namespace handeye
