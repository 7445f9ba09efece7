// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeStudy.h"
#include "NumberWords.h"
#include "StudyConditions.h"
#include "StudyMethods.h"

#include <algorithm>

namespace handeye::study
{

namespace
{

std::string ratioWords(double ratio)
{
  return fixedDigits(ratio, 2) + " times";
}

/// The same with a board and a lens as they are in practice, where that was looked into.
std::string practiceWords(const StudyCameraResult& result)
{
  for (const StudyConditionResult& condition : result.byCondition)
  {
    const MethodResult *ours = findMethod(condition.comparison, "ml"), *rival = lowestWithBoard(condition.comparison);
    if (condition.words == ConditionOfPractice && ours != nullptr && rival != nullptr)
    {
      return "; with corners, print and lens as in practice " + fixedDigits(ours->errorPx.mean, 2) + " px against " +
        fixedDigits(rival->errorPx.mean, 2) + " px (" + rival->name +
        ", the lowest with a board that stands still, branch and bound not being among them)";
    }
  }
  return {};
}

std::string describe(const StudyClaim& claim, const MethodResult& ours, const StudyCameraResult& result)
{
  std::string text = result.camera.name + ": point-to-line " + fixedDigits(ours.errorPx.mean, 2) + " px mean, " +
    fixedDigits(ours.errorPx.maximum, 2) + " px at most, ";
  text += claim.hasLowestMean && claim.hasLowestMaximum ? "both below every method with a board that stands still"
    : claim.hasLowestMean    ? "the mean below every method with a board that stands still, the maximum not"
    : claim.hasLowestMaximum ? "the maximum below every method with a board that stands still, the mean not"
                             : "mean and maximum not below the best method with a board that stands still";
  text += practiceWords(result);
  if (claim.branchAndBoundMean > 0)
  {
    text += "; branch and bound has " + ratioWords(claim.branchAndBoundMean) + " the mean (" +
      ratioWords(claim.branchAndBoundTrueMean) + " without the noise of the validation)";
  }
  if (claim.trackedBoardMean > 0)
  {
    text += "; a board that is tracked has " + ratioWords(claim.trackedBoardMean) + " the mean";
  }
  return text + ".";
}

}  // namespace

StudyClaim judgeClaim(const StudyCameraResult& result)
{
  StudyClaim claim;
  claim.camera = result.camera.name;
  const MethodResult* ours = findMethod(result.comparison, "ml");
  if (ours == nullptr)
  {
    claim.message = result.camera.name + ": the point-to-line calibration gave no result.";
    return claim;
  }
  claim.hasLowestMean = claim.hasLowestMaximum = true;
  const MethodResult *leastMean = ours, *leastMaximum = ours;
  for (const MethodResult& method : result.comparison.methods)
  {
    if (!method.isUsable())
    {
      continue;
    }
    const bool isRival = isOfThePaper(method);
    claim.hasLowestMean = claim.hasLowestMean && !(isRival && method.errorPx.mean <= ours->errorPx.mean);
    claim.hasLowestMaximum = claim.hasLowestMaximum && !(isRival && method.errorPx.maximum <= ours->errorPx.maximum);
    leastMean = method.errorPx.mean < leastMean->errorPx.mean ? &method : leastMean;
    leastMaximum = method.errorPx.maximum < leastMaximum->errorPx.maximum ? &method : leastMaximum;
  }
  claim.lowestMean = leastMean->name;
  claim.lowestMaximum = leastMaximum->name;
  const MethodResult* rival = findMethod(result.comparison, "branch-and-bound");
  const MethodResult *trueRival = findMethod(result.truth, "branch-and-bound"), *trueOurs = findMethod(result.truth, "ml");
  if (rival != nullptr && trueRival != nullptr && trueOurs != nullptr && ours->errorPx.maximum > 0 && trueOurs->errorPx.mean > 0)
  {
    claim.branchAndBoundMean = rival->errorPx.mean / ours->errorPx.mean;
    claim.branchAndBoundMaximum = rival->errorPx.maximum / ours->errorPx.maximum;
    claim.branchAndBoundTrueMean = trueRival->errorPx.mean / trueOurs->errorPx.mean;
  }
  const MethodResult* tracked = findMethod(result.comparison, "tracked-board");
  claim.trackedBoardMean = tracked != nullptr && ours->errorPx.mean > 0 ? tracked->errorPx.mean / ours->errorPx.mean : 0;
  claim.checks = checkClaims(result);
  claim.message = describe(claim, *ours, result);
  return claim;
}

}  // namespace handeye::study
