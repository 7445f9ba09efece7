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

/// What boards and lenses have in practice, one standard deviation: corners in pictures of a room, an office printer's page, a lens
/// calibrated from some twenty views.
inline constexpr double CornerPxOfPractice = 0.1;
inline constexpr double BoardScaleOfPractice = 2e-3;
inline constexpr double LensFocalOfPractice = 2e-3;
inline constexpr double LensCenterPxOfPractice = 2;

/// The words of the condition in which corners, board and lens are all at least as bad as in practice.
inline constexpr const char* ConditionOfPractice = "corners, print and lens together";

/// First the study as it is, then one thing changed at a time: what is known exactly of a board here and is not in practice, and
/// what the ball has more of (a second tracked marker). Each says in numbers what it is; what changes nothing is left out.
std::vector<StudyCondition> studyConditions(const TrialSize& size, const StudyNoise& noise);

}  // namespace handeye::study
