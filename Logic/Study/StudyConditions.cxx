// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyConditions.h"

#include <algorithm>

namespace handeye::study
{

namespace
{

// What boards and lenses have in practice, one standard deviation.
constexpr double CornerPx = 0.1;          // of corners in pictures of a room
constexpr double BoardScaleShare = 2e-3;  // of an office printer's page
constexpr double LensFocalShare = 2e-3;   // of a calibration from some twenty views
constexpr double LensCenterPx = 2;

}  // namespace

std::vector<StudyCondition> studyConditions(const TrialSize& size, const StudyNoise& noise)
{
  std::vector<StudyCondition> conditions(7, { "as it is", noise, size });
  conditions[1].words = "corners found to 0.1 px";
  conditions[1].noise.cornerSigmaPx = std::max(noise.cornerSigmaPx, CornerPx);
  conditions[2].words = "board printed 0.2 % off";
  conditions[2].noise.boardScaleShare = std::max(noise.boardScaleShare, BoardScaleShare);
  conditions[3].words = "lens 0.2 % and 2 px off";
  conditions[3].noise.lensFocalShare = std::max(noise.lensFocalShare, LensFocalShare);
  conditions[3].noise.lensCenterPx = std::max(noise.lensCenterPx, LensCenterPx);
  conditions[4].words = ConditionOfPractice;
  conditions[4].noise = conditions[3].noise;
  conditions[4].noise.cornerSigmaPx = conditions[1].noise.cornerSigmaPx;
  conditions[4].noise.boardScaleShare = conditions[2].noise.boardScaleShare;
  conditions[5].words = "stylus tracked without noise";
  conditions[5].noise.stylusShare = 0;
  conditions[6].words = "twice as many balls";
  conditions[6].size.ballSamples *= 2;
  return conditions;
}

}  // namespace handeye::study
