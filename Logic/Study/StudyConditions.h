// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "StudyTrial.h"

#include <string>
#include <vector>

namespace handeye::study
{

/// A change of one thing of a study, to see what it does to the order of the methods.
struct StudyCondition
{
  std::string words;  ///< "corners found to 0.1 px"
  StudyNoise noise;
  TrialSize size;
};

/// The words of the condition in which board and lens are as they are in practice.
inline constexpr const char* ConditionOfPractice = "these three together";

/// First the study as it is, then one thing changed at a time: what is known exactly of a board here and is not in practice, and
/// what the ball has more of (a second tracked marker).
std::vector<StudyCondition> studyConditions(const TrialSize& size, const StudyNoise& noise);

}  // namespace handeye::study
