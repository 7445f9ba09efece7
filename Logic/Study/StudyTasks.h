// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeStudy.h"

#include <memory>
#include <vector>

namespace handeye::study
{

/// One repetition for one eye, and what came out. Internal.
struct StudyTask
{
  int camera = 0, eye = 0, repetition = 0;
  bool isRendered = false;
  bool hasSubsets = false;
  double tiltDeg = 0;     ///< of the range of the board's directions that is looked into; 0: the study's own
  std::string condition;  ///< StudyCondition::words, of a repetition for one of them
  StudyNoise noise;
  TrialSize size;
  bool hasBranchAndBound = true;
  unsigned seed = 0;
  bool isDone = false;
  std::vector<MethodResult> methods;      ///< against the validation as a user has it
  std::vector<MethodResult> trueMethods;  ///< against the balls without noise
  std::vector<MethodResult> subsets;      ///< with one random subset of each size
  std::vector<double> floorPx;            ///< errors that the validation shows of the true calibration
};

/// All of a study, each with its own seed.
std::vector<StudyTask> planTasks(const StudyOptions& options, const std::vector<StudyCameraResult>& cameras);

/// Runs them on the threads that the options allow. @return false if it was stopped
/// @throws what a task throws
bool runTasks(const StudyOptions& options, const std::vector<StudyCameraResult>& cameras,
  const std::vector<std::unique_ptr<StudyPictures>>& pictures, std::vector<StudyTask>& tasks);

}  // namespace handeye::study
