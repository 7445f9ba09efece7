// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeStudy.h"

#include "StudyConditions.h"
#include "StudyMethods.h"
#include "StudyReport.h"
#include "StudyTables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

using namespace handeye;
using namespace handeye::study;

namespace
{

/// Each capture has the same errors.
MethodResult methodWith(
  const char* name, ComparedMethod::Target target, const std::vector<double>& errorsPx, std::size_t captures = 1)
{
  MethodResult method;
  method.name = name;
  method.target = target;
  ComparedCapture capture;
  capture.answer.status = "ok";
  capture.answer.markerToCamera = Eigen::Isometry3d::Identity();
  for (const double error : errorsPx)
  {
    HandEyeValidationSample sample;
    sample.status = CameraModel::Status::Ok;
    sample.errorPx = error;
    capture.validation.samples.push_back(sample);
  }
  method.captures.assign(captures, capture);
  summarizeMethod(method);
  return method;
}

constexpr auto Ball = ComparedMethod::Target::Ball;
constexpr auto Board = ComparedMethod::Target::Board;

/// Point-to-line is behind `tsai` in its own mean.
StudyCameraResult someResult()
{
  StudyCameraResult result;
  result.camera = studyCameras().back();
  result.comparison.methods = { methodWith("ml", Ball, { 1, 2 }), methodWith("tsai", Board, { 2, 3 }),
    methodWith("branch-and-bound", Board, { 6, 8 }), methodWith("tracked-board", Board, { 1, 1 }) };
  result.truth.methods = { methodWith("ml", Ball, { 0.5, 0.6 }), methodWith("tsai", Board, { 0.2, 0.4 }),
    methodWith("branch-and-bound", Board, { 5, 6 }), methodWith("tracked-board", Board, { 0.1, 0.1 }) };
  return result;
}

const StudyCheck& checkOf(const std::vector<StudyCheck>& checks, const std::string& what)
{
  return *std::find_if(checks.begin(), checks.end(), [&](const StudyCheck& check) { return check.what == what; });
}

bool has(const std::string& text, const std::string& words)
{
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST(StudyConditions, Words_AreTheNumbersThatAreApplied)
{
  StudyNoise noise;
  noise.trackingSigmaMm = 0.1;
  const auto wordsOf = [](const StudyNoise& given)
  {
    std::vector<std::string> words;
    for (const StudyCondition& condition : studyConditions({}, given))
    {
      words.push_back(condition.words);
    }
    return words;
  };
  EXPECT_EQ(wordsOf(noise),
    (std::vector<std::string>{ "as it is", "corners found to 0.1 px", "board printed 0.2 % off", "lens 0.2 % and 2 px off",
      ConditionOfPractice, "stylus tracked without noise", "twice as many balls" }));
  noise.cornerSigmaPx = 0.4;
  noise.lensFocalShare = 0.005;
  EXPECT_EQ(wordsOf(noise),
    (std::vector<std::string>{ "as it is", "board printed 0.2 % off", "lens 0.5 % and 2 px off", ConditionOfPractice,
      "stylus tracked without noise", "twice as many balls" }))
    << "corners are worse than that already";
  noise.boardScaleShare = 0.01;
  noise.lensCenterPx = 3;
  noise.trackingSigmaMm = 0;
  EXPECT_EQ(wordsOf(noise), (std::vector<std::string>{ "as it is", "twice as many balls" }));
}

TEST(StudyChecks, OwnMean_HasAReasonOfItsOwn)
{
  const StudyCameraResult result = someResult();
  const std::vector<StudyCheck> checks = checkClaims(result);
  const StudyCheck& mean = checkOf(checks, "lowest mean of the calibrations' own errors");
  EXPECT_FALSE(mean.holds);
  EXPECT_TRUE(has(mean.reason, "tsai has 0.30 px against 0.55 px")) << mean.reason;
  EXPECT_TRUE(has(mean.reason, "two tracked markers")) << mean.reason;
  EXPECT_FALSE(has(mean.reason, "largest")) << mean.reason;
  EXPECT_TRUE(has(checkOf(checks, "lowest maximum of the calibrations' own errors").reason, "the largest of 2 errors"));
}

TEST(StudyChecks, WhatFavoursTheBoard_DependsOnTheNoise)
{
  StudyCameraResult result = someResult();
  result.byCondition = { { "as it is", result.comparison, result.truth } };
  const auto ownMean = [&] { return checkOf(checkClaims(result), "lowest mean of the calibrations' own errors").reason; };
  const auto tracked = [&] { return checkOf(checkClaims(result), "lower mean than a board that is tracked itself").reason; };
  EXPECT_TRUE(has(ownMean(), "Better here than in practice, which favours the board: print, corners, lens.")) << ownMean();
  EXPECT_TRUE(has(tracked(), "known exactly here;")) << tracked();
  result.noise.boardScaleShare = 0.01;
  result.noise.cornerSigmaPx = 0.2;
  EXPECT_TRUE(has(ownMean(), "favours the board: lens.")) << ownMean();
  EXPECT_TRUE(has(tracked(), "known exactly here but for the print;")) << tracked();
  result.noise.lensFocalShare = 0.01;
  result.noise.lensCenterPx = 5;
  EXPECT_FALSE(has(ownMean(), "favours the board")) << ownMean();
}

TEST(StudyChecks, Practice_IsComparedWithTheBestBoardThatStandsStill)
{
  StudyCameraResult result = someResult();
  StudyConditionResult practice{ ConditionOfPractice, {}, {} };
  practice.comparison.methods = { methodWith("ml", Ball, { 1 }), methodWith("park", Board, { 4 }),
    methodWith("horaud", Board, { 3 }), methodWith("tracked-board", Board, { 2 }) };
  result.byCondition = { practice };
  const std::string message = judgeClaim(result).message;
  EXPECT_TRUE(has(message, "1.00 px against 3.00 px (horaud")) << message;
  EXPECT_TRUE(has(message, "branch and bound not being among them")) << message;
}

TEST(StudyChecks, Tilts_AreComparedInTheSameRepetitions)
{
  StudyCameraResult result = someResult();
  StudyTiltResult tilt;
  tilt.tiltDeg = 5;
  MethodResult ours = methodWith("ml", Ball, { 1, 1 }, 4);
  for (std::size_t later : { 2U, 3U })
  {
    ours.captures[later].validation.samples[0].errorPx = 9;
  }
  summarizeMethod(ours);
  const MethodResult search = methodWith("branch-and-bound", Board, { 2, 2 }, 2);
  tilt.comparison.methods = tilt.truth.methods = { ours, search };
  result.byTilt = { tilt };
  EXPECT_NEAR(*ratioOfMeans(search, ours), 2, 1e-12);
  for (MethodResult& method : result.comparison.methods)
  {
    // Below the factor of three, so that a reason is given.
    method = method.name == "branch-and-bound" ? methodWith("branch-and-bound", Board, { 2, 3 }) : method;
  }
  const std::string reason = checkOf(checkClaims(result), "branch-and-bound has at least 3 times the mean").reason;
  EXPECT_TRUE(has(reason, "2.0 times up to 5 degrees, over the 2 repetitions that have a branch and bound")) << reason;
  const report::Table table = tiltTable(result);
  EXPECT_TRUE(has(table.caption, "4 repetitions, 2 of branch and bound")) << table.caption;
  const auto row = [&](const std::string& name)
  {
    return *std::find_if(table.rows.begin(), table.rows.end(), [&](const std::vector<std::string>& one) { return one[0] == name; });
  };
  EXPECT_EQ(row("ml")[1], "3.00 (3.00)");
  EXPECT_EQ(row("ml (the same 2 repetitions)")[1], "1.00 (1.00)");
  EXPECT_EQ(row("branch-and-bound (2 repetitions)")[1], "2.00 (2.00)");
}

TEST(StudyChecks, TrackedBoard_IsNotOneOfThePapersMethods)
{
  StudyResult result;
  result.cameras = { someResult() };
  result.cameras[0].truth.methods[1] = methodWith("tsai", Board, { 1, 2 });
  result.claims = { judgeClaim(result.cameras[0]) };
  for (const StudyCheck& check : result.claims[0].checks)
  {
    EXPECT_EQ(check.holds, check.isOfThePaper) << check.what << ": " << check.measured;
  }
  EXPECT_EQ(checksTable(result, true).rows.size(), result.claims[0].checks.size() - 1);
  const report::Table beyond = checksTable(result, false);
  ASSERT_EQ(beyond.rows.size(), 1U);
  EXPECT_EQ(beyond.rows[0][1], "lower mean than a board that is tracked itself");
  EXPECT_TRUE(has(beyond.caption, "none of its five methods"));
}

TEST(StudyChecks, Claim_IsJudgedByTheNumbers)
{
  StudyCameraResult result;
  result.camera = studyCameras().back();
  const auto add = [&](const char* name, ComparedMethod::Target target, double mean, double maximum)
  {
    for (ComparisonResult* comparison : { &result.comparison, &result.truth })
    {
      MethodResult method;
      method.name = name;
      method.target = target;
      method.status = "ok";
      method.errorPx = { 10, mean, 0, 0, maximum, mean };
      comparison->methods.push_back(method);
    }
  };
  add("ml", Ball, 1, 3);
  add("sqpnp", Ball, 0.9, 3.5);
  add("branch-and-bound", Board, 4, 9);
  StudyClaim claim = judgeClaim(result);
  EXPECT_TRUE(claim.hasLowestMean);
  EXPECT_TRUE(claim.hasLowestMaximum);
  EXPECT_EQ(claim.lowestMean, "sqpnp") << "of all methods, whatever they take";
  EXPECT_EQ(claim.lowestMaximum, "ml");
  EXPECT_DOUBLE_EQ(claim.branchAndBoundMean, 4);
  EXPECT_DOUBLE_EQ(claim.branchAndBoundMaximum, 3);
  add("tracked-board", Board, 0.5, 2);
  claim = judgeClaim(result);
  EXPECT_TRUE(claim.hasLowestMean) << "not one of the paper's five";
  EXPECT_DOUBLE_EQ(claim.trackedBoardMean, 0.5);
  EXPECT_EQ(claim.lowestMean, "tracked-board") << "but said";
  add("park", Board, 1.5, 2.5);
  claim = judgeClaim(result);
  EXPECT_TRUE(claim.hasLowestMean);
  EXPECT_FALSE(claim.hasLowestMaximum);
  EXPECT_NE(claim.message.find("the maximum not"), std::string::npos) << claim.message;
}

TEST(StudyChecks, Checks_SayWhatDoesNotHoldAndWhy)
{
  StudyCameraResult result;
  result.camera = studyCameras().back();
  ASSERT_EQ(result.camera.name, "laparoscope");
  result.floorPx = { 3, 0.9, 0, 0, 3.8, 1 };
  result.comparison.methods = { methodWith("ml", Ball, { 1, 4, 1 }), methodWith("tsai", Board, { 2.5, 2, 3 }),
    methodWith("branch-and-bound", Board, { 6, 4, 5 }), methodWith("tracked-board", Board, { 1, 1, 1 }) };
  result.truth.methods = { methodWith("ml", Ball, { 0.2, 0.3, 0.1 }), methodWith("tsai", Board, { 0.9, 0.7, 1.5 }),
    methodWith("branch-and-bound", Board, { 2, 2, 2 }), methodWith("tracked-board", Board, { 0.1, 0.1, 0.1 }) };
  const std::vector<StudyCheck> checks = checkClaims(result);
  ASSERT_EQ(checks.size(), 6U);
  const auto& [mean, maximum, ownMean, ownMaximum] = std::tie(checks[0], checks[1], checks[2], checks[3]);
  EXPECT_TRUE(mean.holds);
  EXPECT_EQ(mean.reason, "");
  EXPECT_EQ(mean.measured, "ml 2.00 px, tsai 2.50 px");
  EXPECT_FALSE(maximum.holds);
  EXPECT_EQ(maximum.measured, "ml 4.00 px, tsai 3.00 px");
  EXPECT_NE(maximum.reason.find("one sample of 3. At that ball the calibration is off by 0.30 px itself; the rest of the 4.00 px"),
    std::string::npos)
    << maximum.reason;
  EXPECT_NE(maximum.reason.find("without the validation's noise the largest errors are 0.30 px and 1.50 px"), std::string::npos)
    << maximum.reason;
  EXPECT_TRUE(ownMean.holds);
  EXPECT_TRUE(ownMaximum.holds);
  EXPECT_FALSE(checks[4].holds) << "the board that is tracked";
  EXPECT_FALSE(checks[5].holds) << "2.5 times, not three";
  EXPECT_EQ(checks[5].measured, "2.50 times; own errors 10.00 times");
  EXPECT_NE(checks[5].reason.find("0.90 px of the 2.00 px are the tracker's noise"), std::string::npos) << checks[5].reason;
  EXPECT_NE(judgeClaim(result).message.find("the mean below every method with a board that stands still, the maximum not"),
    std::string::npos);
}
