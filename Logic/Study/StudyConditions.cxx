// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyConditions.h"

#include "NumberWords.h"

#include <algorithm>

namespace handeye::study
{

namespace
{

std::string percent(double share)
{
  return significantDigits(100 * share, 3) + " %";
}

bool areEqual(const StudyNoise& a, const StudyNoise& b)
{
  return a.cornerSigmaPx == b.cornerSigmaPx && a.boardScaleShare == b.boardScaleShare && a.lensFocalShare == b.lensFocalShare &&
    a.lensCenterPx == b.lensCenterPx && a.stylusShare == b.stylusShare;
}

}  // namespace

std::vector<StudyCondition> studyConditions(const TrialSize& size, const StudyNoise& noise)
{
  std::vector<StudyCondition> conditions = { { "as it is", noise, size } };
  const auto add = [&](const std::string& words, const StudyNoise& changed)
  {
    if (!areEqual(changed, noise))
    {
      conditions.push_back({ words, changed, size });
    }
  };
  StudyNoise corners = noise, print = noise, lens = noise, stylus = noise;
  corners.cornerSigmaPx = std::max(noise.cornerSigmaPx, CornerPxOfPractice);
  print.boardScaleShare = std::max(noise.boardScaleShare, BoardScaleOfPractice);
  lens.lensFocalShare = std::max(noise.lensFocalShare, LensFocalOfPractice);
  lens.lensCenterPx = std::max(noise.lensCenterPx, LensCenterPxOfPractice);
  add("corners found to " + significantDigits(corners.cornerSigmaPx, 3) + " px", corners);
  add("board printed " + percent(print.boardScaleShare) + " off", print);
  add("lens " + percent(lens.lensFocalShare) + " and " + significantDigits(lens.lensCenterPx, 3) + " px off", lens);
  StudyNoise together = lens;
  together.cornerSigmaPx = corners.cornerSigmaPx;
  together.boardScaleShare = print.boardScaleShare;
  add(ConditionOfPractice, together);
  stylus.stylusShare = noise.trackingSigmaMm > 0 || noise.trackingSigmaRad > 0 ? 0 : noise.stylusShare;
  add("stylus tracked without noise", stylus);
  conditions.push_back({ "twice as many balls", noise, size });
  conditions.back().size.ballSamples *= 2;
  return conditions;
}

}  // namespace handeye::study
