// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeStudy.h"

#include "IoTestSupport.h"
#include "OffscreenRendering.h"
#include "StudyReport.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace handeye;
using namespace handeye::study;
using handeye::io::test::readBytes;
using handeye::io::test::TemporaryFolder;

namespace
{

StudyOptions small()
{
  StudyOptions options;
  options.repetitions = 2;
  options.subsetRepetitions = options.tiltRepetitions = options.conditionRepetitions = 0;
  options.noisePictures = 4;
  options.branchAndBoundSec = 0;
  options.cameras = { "webcam" };
  return options;
}

const MethodResult& methodOf(const ComparisonResult& comparison, const std::string& name)
{
  return *std::find_if(
    comparison.methods.begin(), comparison.methods.end(), [&](const MethodResult& method) { return method.name == name; });
}

}  // namespace

TEST(HandEyeStudy, NoiseFree_EveryMethodFindsTheTruth)
{
  StudyOptions options = small();
  options.isNoiseFree = true;
  options.cameras = {};
  const StudyResult result = runStudy(options);
  ASSERT_EQ(result.cameras.size(), 3U);
  for (const StudyCameraResult& camera : result.cameras)
  {
    const std::size_t captures = 2 * camera.camera.eyes.size();
    ASSERT_EQ(camera.comparison.methods.size(), 8U + 6) << camera.camera.name;
    EXPECT_LT(camera.floorPx.maximum, 1e-6);
    for (const MethodResult& method : camera.comparison.methods)
    {
      EXPECT_EQ(std::size_t(method.usableCount()), captures) << camera.camera.name << ", " << method.name << ": " << method.message;
      // EPnP and the iteration of OpenCV 4.6 stop early.
      const double tolerance = method.name == "epnp" || method.name == "iterative" ? 0.05 : 1e-3;
      EXPECT_LT(method.errorPx.maximum, tolerance) << camera.camera.name << ", " << method.name;
    }
  }
}

TEST(HandEyeStudy, BranchAndBound_IsPartOfIt)
{
  StudyOptions options = small();
  options.repetitions = 1;
  options.isNoiseFree = true;
  options.branchAndBoundSec = 2;
  const StudyResult result = runStudy(options);
  const MethodResult& search = methodOf(result.cameras[0].comparison, "branch-and-bound");
  ASSERT_TRUE(search.isUsable()) << search.message;
  ASSERT_TRUE(search.captures[0].answer.gap.has_value());
  EXPECT_LT(search.errorPx.maximum, 20) << "within its gap of the truth";
}

TEST(HandEyeStudy, Noise_IsMeasuredOnPictures)
{
  const StudyCamera camera = studyCameras().front();
  const StudyPictures pictures(camera, camera.eyes.front());
  const FeatureNoise noise = measureFeatureNoise(camera, camera.eyes.front(), pictures, 6, 3);
  EXPECT_GE(noise.ballsFound, 5);
  EXPECT_GE(noise.boardsFound, 5);
  EXPECT_EQ(noise.corners, 54 * noise.boardsFound);
  EXPECT_GT(noise.ballSigmaPx, 0.002);
  EXPECT_LT(noise.ballSigmaPx, 0.3);
  EXPECT_GT(noise.cornerSigmaPx, 0.002);
  EXPECT_LT(noise.cornerSigmaPx, 0.3);
}

TEST(HandEyeStudy, TrackerNoise_IsWhatTheValidationShowsOfTheTruth)
{
  // One eye, no noise of features: a ball at 425 mm +- ..., f = 602: the tip's noise in px is what the floor must be.
  const StudyCamera camera = studyCameras().front();
  TrialSize size;
  size.validationSamples = 400;
  const StudyTrial trial = makeTrial(camera, camera.eyes.front(), { 0.12, 0.0, 0, 0 }, size, 5);
  ASSERT_EQ(trial.validation.size(), 400U);
  double squares = 0;
  for (std::size_t i = 0; i < trial.validation.size(); ++i)
  {
    squares += (trial.validation[i].tip_Marker - trial.trueValidation[i].tip_Marker).squaredNorm();
  }
  // Two markers' positions, three axes each; the pivoted tip adds some hundredths.
  EXPECT_NEAR(std::sqrt(squares / 400), 0.12 * std::sqrt(6.0), 0.02);
}

TEST(HandEyeStudy, SameSeeds_SameNumbersWhateverTheThreads)
{
  StudyOptions options = small();
  options.repetitions = 3;
  const StudyResult one = runStudy(options);
  options.jobs = 3;
  const StudyResult three = runStudy(options);
  options.seed = 2;
  const StudyResult other = runStudy(options);
  const auto& methods = one.cameras[0].comparison.methods;
  for (std::size_t i = 0; i < methods.size(); ++i)
  {
    EXPECT_EQ(methods[i].errorPx.mean, three.cameras[0].comparison.methods[i].errorPx.mean) << methods[i].name;
    EXPECT_NE(methods[i].errorPx.mean, other.cameras[0].comparison.methods[i].errorPx.mean) << methods[i].name;
  }
}

TEST(HandEyeStudy, Noise_IsTheReasonOfTheErrors)
{
  StudyOptions options = small();
  options.repetitions = 6;
  const StudyResult result = runStudy(options);
  const StudyCameraResult& camera = result.cameras[0];
  const MethodResult& ml = methodOf(camera.comparison, "ml");
  EXPECT_EQ(ml.errorPx.count, 6 * 15);
  EXPECT_GT(ml.errorPx.mean, 0.8 * camera.floorPx.mean) << "nobody is much better than a perfect calibration would seem";
  EXPECT_LT(ml.errorPx.mean, 2 * camera.floorPx.mean);
  EXPECT_LT(methodOf(camera.truth, "ml").errorPx.mean, ml.errorPx.mean) << "without the noise of the validation";
}

TEST(HandEyeStudy, Rendered_FeaturesAreFoundInPictures)
{
  StudyOptions options = small();
  options.repetitions = 1;
  options.renderedRepetitions = 1;
  const StudyResult result = runStudy(options);
  const StudyCameraResult& camera = result.cameras[0];
  EXPECT_EQ(camera.renderedEyes, 1);
  const MethodResult& ml = methodOf(camera.rendered, "ml");
  ASSERT_TRUE(ml.isUsable()) << ml.message;
  EXPECT_GE(ml.captures[0].answer.sampleCount, 13);
  EXPECT_LT(ml.errorPx.mean, 3);
  EXPECT_GE(methodOf(camera.rendered, "park").captures[0].answer.sampleCount, 13);
  EXPECT_EQ(methodOf(camera.rendered, "as-published").captures.size(), 1U) << "the paper's segmentation needs pictures";
}

TEST(HandEyeStudy, NarrowRange_IsWhyMotionsFail)
{
  StudyOptions options = small();
  options.cameras = { "laparoscope" };
  options.tiltRepetitions = 6;
  const StudyResult result = runStudy(options);
  const std::vector<StudyTiltResult>& tilts = result.cameras[0].byTilt;
  ASSERT_EQ(tilts.size(), 6U);
  EXPECT_EQ(tilts.front().tiltDeg, 5);
  EXPECT_EQ(tilts.back().tiltDeg, 45);
  EXPECT_GT(methodOf(tilts[1].truth, "park").errorPx.mean, 2 * methodOf(tilts.back().truth, "park").errorPx.mean);
  EXPECT_LT(methodOf(tilts[1].truth, "ml").errorPx.mean, 2 * methodOf(tilts.back().truth, "ml").errorPx.mean);
}

TEST(HandEyeStudy, Conditions_AreWhyTheOrderTurns)
{
  StudyOptions options = small();
  options.conditionRepetitions = 8;
  const StudyResult result = runStudy(options);
  const std::vector<StudyConditionResult>& conditions = result.cameras[0].byCondition;
  ASSERT_EQ(conditions.size(), 7U);
  const auto own = [&](std::size_t condition, const char* method)
  { return methodOf(conditions[condition].truth, method).errorPx.mean; };
  EXPECT_EQ(conditions[0].words, "as it is");
  for (const std::size_t ofTheBoard : { 1U, 2U })
  {
    EXPECT_EQ(own(ofTheBoard, "ml"), own(0, "ml")) << "the ball does not know of it: " << conditions[ofTheBoard].words;
    EXPECT_GT(own(ofTheBoard, "park"), 1.3 * own(0, "park")) << conditions[ofTheBoard].words;
  }
  EXPECT_GT(own(3, "park") - own(0, "park"), own(3, "ml") - own(0, "ml")) << "the board suffers more from a wrong lens";
  EXPECT_GT(own(4, "park"), own(4, "ml"));
  EXPECT_EQ(own(5, "park"), own(0, "park")) << "the board has no stylus";
  EXPECT_LT(own(5, "ml"), own(0, "ml"));
  EXPECT_LT(own(6, "ml"), own(0, "ml"));
}

TEST(HandEyeStudy, CornerNoise_IsWhatWasAskedFor)
{
  StudyOptions options = small();
  options.cornerSigmaPx = 0.4;
  const StudyCameraResult noisy = runStudy(options).cameras[0];
  EXPECT_EQ(noisy.noise.cornerSigmaPx, 0.4);
  EXPECT_LT(noisy.measured.cornerSigmaPx, 0.1) << "what was measured stays said";
  options.lensFocalShare = 0.02;
  EXPECT_EQ(runStudy(options).cameras[0].floorPx.count, noisy.floorPx.count);
  EXPECT_LT(runStudy(options).cameras[0].floorPx.mean, 1.5 * noisy.floorPx.mean)
    << "the validation's noise has no part of the lens";
  options.boardScaleShare = 0.5;
  EXPECT_THROW((void)runStudy(options), std::invalid_argument);
}

TEST(HandEyeStudy, Report_HasATableACamera)
{
  StudyOptions options = small();
  options.subsetRepetitions = options.tiltRepetitions = options.conditionRepetitions = 2;
  const StudyResult result = runStudy(options);
  registerOffscreenRendering();
  const TemporaryFolder folder;
  writeStudyReport(folder.path(), result);
  const std::string html = readBytes(folder.path() / "report.html");
  EXPECT_NE(html.find(report::escapeHtml(result.message)), std::string::npos);
  EXPECT_NE(html.find("tracked-board-lines"), std::string::npos);
  EXPECT_NE(html.find("lowest maximum of the calibrations&#39; own errors"), std::string::npos)
    << "each statement, whether it holds";
  EXPECT_NE(html.find("corners, print and lens together"), std::string::npos) << "what the order depends on";
  for (const char* const name : { "report.pdf", "webcam-methods.csv", "webcam-true.csv", "webcam-subsets.csv",
         "webcam-distance.png", "webcam-samples.png", "webcam-repeatability.csv", "webcam-tilt.png" })
  {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }
  const MethodResult& ml = methodOf(result.cameras[0].comparison, "ml");
  EXPECT_EQ(ml.subsets.front().sampleCount, 3);
  EXPECT_EQ(ml.subsets.back().sampleCount, 30);
  EXPECT_EQ(ml.subsets.back().repetitions, 2);
}

TEST(HandEyeStudy, Stopped_SaysSo)
{
  StudyOptions options = small();
  options.isNoiseFree = true;
  options.repetitions = 5;
  int told = 0;
  options.progress = [&](const std::string&, int, int total)
  {
    EXPECT_EQ(total, 5);
    return ++told < 2;
  };
  const StudyResult result = runStudy(options);
  EXPECT_TRUE(result.wasStopped);
  EXPECT_EQ(result.status, "stopped");
  EXPECT_EQ(told, 2);
}

TEST(HandEyeStudy, OptionsThatMakeNoSense_AreRefused)
{
  StudyOptions options = small();
  options.cameras = { "endoscope" };
  EXPECT_THROW((void)runStudy(options), std::invalid_argument);
  options = small();
  options.repetitions = 0;
  EXPECT_THROW((void)runStudy(options), std::invalid_argument);
  options = small();
  options.size.boardViews = 2;
  EXPECT_THROW((void)runStudy(options), std::invalid_argument);
}
