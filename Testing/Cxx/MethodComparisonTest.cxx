// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MethodComparison.h"

#include "ComparisonFiles.h"
#include "GeometryMatchers.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

/// A method whose answer is known: the truth, moved.
ComparedMethod known(const std::string& name, const std::vector<Eigen::Isometry3d>& answers)
{
  ComparedMethod method;
  method.name = name;
  method.title = "known";
  method.reference = "nobody";
  method.sampleCounts = std::vector<int>(answers.size(), 15);
  method.calibrate = [answers](int capture)
  {
    MethodAnswer answer;
    answer.status = "ok";
    answer.markerToCamera = answers.at(std::size_t(capture));
    answer.sampleCount = answer.usedCount = 15;
    return answer;
  };
  return method;
}

ComparedMethod failing(const std::string& name)
{
  ComparedMethod method = known(name, { Eigen::Isometry3d::Identity() });
  method.calibrate = [](int)
  {
    MethodAnswer answer;
    answer.status = "parallel_motions";
    answer.message = "all motions turn about one axis";
    return answer;
  };
  return method;
}

class MethodComparison : public testing::Test
{
protected:
  MethodComparison()
  {
    // A long lens without distortion, balls on the axis' plane at one depth: 1 mm sideways is fx / 300 px everywhere.
    for (int i = 0; i < 12; ++i)
    {
      HandEyeSample sample;
      sample.frame = 10 + i;
      const Eigen::Vector3d ball_Camera(-50 + 9 * i, 4 * i - 20, 300);
      sample.tip_Marker = truth.inverse() * ball_Camera;
      sample.ball_Image = camera.project(ball_Camera).point_Image;
      sample.ray_Eye = ball_Camera.normalized();
      validation.push_back(sample);
    }
  }

  Eigen::Isometry3d moved(double mm) const { return makeRigid({ 0, 0, 0 }, { mm, 0, 0 }) * truth; }

  const CameraModel camera = makeCamera(640, 480, 600, 600, 320, 240, {});
  const Eigen::Isometry3d truth = typicalMarkerToCamera();
  std::vector<HandEyeSample> validation;
};

}  // namespace

TEST_F(MethodComparison, KnownErrors_AreSummarised)
{
  const ComparisonResult result = compareMethods({ known("off", { moved(1) }), known("true", { truth }) }, validation, camera);
  ASSERT_EQ(result.status, "ok");
  const Summary& off = result.methods[0].errorPx;
  EXPECT_EQ(off.count, 12);
  EXPECT_NEAR(off.mean, 2, 1e-9);
  EXPECT_NEAR(off.minimum, 2, 1e-9);
  EXPECT_NEAR(off.maximum, 2, 1e-9);
  EXPECT_NEAR(off.rms, 2, 1e-9);
  EXPECT_NEAR(off.standardDeviation, 0, 1e-9);
  EXPECT_NEAR(result.methods[1].errorPx.maximum, 0, 1e-9);
  EXPECT_EQ(result.ranking, (std::vector<int>{ 1, 0 }));
  EXPECT_NE(result.message.find("true"), std::string::npos);
}

TEST_F(MethodComparison, SeveralCaptures_ArePooled)
{
  const ComparisonResult result = compareMethods({ known("pooled", { moved(1), moved(-3) }) }, validation, camera);
  const Summary& error = result.methods[0].errorPx;
  EXPECT_EQ(error.count, 24);
  EXPECT_NEAR(error.mean, 4, 1e-9);
  EXPECT_NEAR(error.minimum, 2, 1e-9);
  EXPECT_NEAR(error.maximum, 6, 1e-9);
  EXPECT_NEAR(error.rms, std::sqrt(20.0), 1e-9);
}

TEST_F(MethodComparison, Repeatability_IsTheSpreadAboutTheMean)
{
  const ComparisonResult result = compareMethods({ known("repeated", { moved(1), moved(-1), moved(0) }) }, validation, camera);
  const Repeatability& spread = result.methods[0].repeatability;
  EXPECT_FALSE(spread.areHalves);
  EXPECT_EQ(spread.calibrations, 3);
  EXPECT_NEAR(spread.translationMm, 1, 1e-9) << "sqrt((1 + 1 + 0) / 2)";
  EXPECT_NEAR(spread.projectionPx, 2, 1e-9);
  EXPECT_NEAR(spread.worstPx, 2, 1e-9);
  EXPECT_NEAR(spread.rotationDeg, 0, 1e-6);
}

TEST_F(MethodComparison, Repeatability_OfRotations)
{
  const auto turned = [&](double degrees) { return makeRigid({ 0, 0, degrees * double(EIGEN_PI) / 180 }, { 0, 0, 0 }) * truth; };
  const ComparisonResult result = compareMethods({ known("turned", { turned(2), turned(-2) }) }, validation, camera);
  EXPECT_NEAR(result.methods[0].repeatability.rotationDeg, 2 * std::sqrt(2.0), 1e-9) << "two about their mean, n - 1";
}

TEST_F(MethodComparison, FailedMethod_IsARowThatSaysWhy)
{
  const ComparisonResult result = compareMethods({ failing("classical"), known("true", { truth }) }, validation, camera);
  ASSERT_EQ(result.methods.size(), 2U);
  EXPECT_EQ(result.methods[0].status, "parallel_motions");
  EXPECT_EQ(result.methods[0].message, "all motions turn about one axis");
  EXPECT_EQ(result.methods[0].errorPx.count, 0);
  EXPECT_EQ(result.ranking, (std::vector<int>{ 1 }));
  EXPECT_NE(result.message.find("classical (parallel motions)"), std::string::npos) << result.message;
  const nlohmann::json json = comparisonJson(result);
  EXPECT_FALSE(json["methods"][0].contains("projectionErrorPx"));
  EXPECT_FALSE(json["methods"][0]["captures"][0].contains("markerToCamera"));
  EXPECT_NE(methodsCsv(result).find("classical,ball,parallel_motions,,,,,,0,0,1,"), std::string::npos) << methodsCsv(result);
}

TEST_F(MethodComparison, NothingWorks_IsNoResult)
{
  const ComparisonResult none = compareMethods({ failing("a") }, validation, camera);
  EXPECT_EQ(none.status, "no_method");
  EXPECT_FALSE(none.isUsable());
  const ComparisonResult blind = compareMethods({ known("true", { truth }) }, {}, camera);
  EXPECT_EQ(blind.status, "no_validation");
}

TEST_F(MethodComparison, CalibrationThatSeesNothing_IsNotRanked)
{
  const Eigen::Isometry3d behind = makeRigid({ 0, double(EIGEN_PI), 0 }, { 0, 0, 0 }) * truth;
  const ComparisonResult result = compareMethods({ known("behind", { behind }), known("true", { truth }) }, validation, camera);
  EXPECT_EQ(result.methods[0].status, "not_in_view");
  EXPECT_EQ(result.ranking, (std::vector<int>{ 1 }));
}

TEST_F(MethodComparison, DifferenceWithinTheNoise_IsNotToldApart)
{
  // Errors of both change from sample to sample by more than they differ on average.
  std::vector<HandEyeSample> noisy = validation;
  Random random(4);
  for (HandEyeSample& sample : noisy)
  {
    sample.ball_Image += random.normal3(2).head<2>();
  }
  const ComparisonResult alike =
    compareMethods({ known("a", { moved(0.05) }), known("b", { truth }), known("far", { moved(8) }) }, noisy, camera);
  ASSERT_EQ(alike.ranking.size(), 3U);
  ASSERT_EQ(alike.notToldApart.size(), 1U);
  EXPECT_EQ(alike.notToldApart[0], alike.ranking[1]);
  EXPECT_EQ(alike.ranking[2], 2);
}

TEST_F(MethodComparison, MethodThatFailsOften_IsNotTheBest)
{
  // Perfect in the one capture of five that it can do, in which the others are good as well.
  ComparedMethod patchy = known("patchy", std::vector<Eigen::Isometry3d>(5, truth));
  patchy.calibrate = [whole = patchy.calibrate](int capture)
  {
    MethodAnswer answer = whole(capture);
    answer.status = capture == 0 ? "ok" : "no_fit";
    answer.message = "too difficult";
    return answer;
  };
  const ComparedMethod steady = known("steady", { moved(0.1), moved(2), moved(2), moved(2), moved(2) });
  const ComparisonResult result = compareMethods({ patchy, steady }, validation, camera);
  ASSERT_EQ(result.status, "ok");
  EXPECT_LT(result.methods[0].errorPx.mean, result.methods[1].errorPx.mean);
  EXPECT_EQ(result.ranking, (std::vector<int>{ 1, 0 }));
  EXPECT_EQ(result.incomplete, (std::vector<int>{ 0 }));
  EXPECT_TRUE(result.notToldApart.empty());
  EXPECT_NEAR(result.methods[0].successShare, 0.2, 1e-12);
  EXPECT_NE(result.message.find("Lowest mean projection error: steady"), std::string::npos) << result.message;
  EXPECT_NE(
    result.message.find("patchy (1 of 5 calibrations, 0.00 px mean over what it has, where steady has 0.20 px)"), std::string::npos)
    << result.message;
  const nlohmann::json json = comparisonJson(result);
  EXPECT_EQ(json["incomplete"], nlohmann::json::array({ "patchy" }));
  EXPECT_EQ(json["ranking"], nlohmann::json::array({ "steady", "patchy" }));
}

TEST_F(MethodComparison, DifficultCaptureThatOneFails_IsLeftOutForAll)
{
  // The last of twenty captures is difficult: `brave` has a result there, `shy` has none.
  std::vector<Eigen::Isometry3d> answers(20, moved(0.5));
  answers.back() = moved(20);
  const ComparedMethod brave = known("brave", answers);
  ComparedMethod shy = known("shy", std::vector<Eigen::Isometry3d>(20, moved(0.6)));
  shy.calibrate = [whole = shy.calibrate](int capture)
  {
    MethodAnswer answer = whole(capture);
    answer.status = capture == 19 ? "no_fit" : "ok";
    return answer;
  };
  const ComparisonResult result = compareMethods({ shy, brave }, validation, camera);
  EXPECT_GT(result.methods[1].errorPx.mean, result.methods[0].errorPx.mean) << "over all that each has";
  EXPECT_EQ(result.ranking, (std::vector<int>{ 1, 0 }));
  EXPECT_TRUE(result.incomplete.empty());
  EXPECT_EQ(result.methods[1].errorPx.count, 20 * 12);
  EXPECT_EQ(result.methods[1].commonErrorPx.count, 19 * 12);
  EXPECT_NEAR(result.methods[1].commonErrorPx.mean, 1, 1e-9);
  EXPECT_NE(
    result.message.find("1.00 px mean, 1.00 px at most, over 228 validation samples that every ranked method"), std::string::npos)
    << result.message;
}

TEST_F(MethodComparison, CapturesOfBallAndBoard_HaveNothingInCommonButTheValidation)
{
  // Five captures of the ball, one of a board. The first of the ball's is the only one in which `b` is the better one.
  const ComparedMethod a = known("a", { moved(3), moved(0.5), moved(0.5), moved(0.5), moved(0.5) });
  const ComparedMethod b = known("b", { moved(0.5), moved(2), moved(2), moved(2), moved(2) });
  ComparedMethod board = known("board", { moved(1.25) });
  board.target = ComparedMethod::Target::Board;
  const ComparisonResult result = compareMethods({ b, board, a }, validation, camera);
  EXPECT_EQ(result.ranking, (std::vector<int>{ 2, 1, 0 }));
  EXPECT_EQ(result.methods[2].commonErrorPx.count, 5 * 12) << "all captures of the ball";
  EXPECT_NEAR(result.methods[2].commonErrorPx.mean, 2, 1e-9);
  EXPECT_NEAR(result.methods[1].commonErrorPx.mean, 2.5, 1e-9);
  EXPECT_NEAR(result.methods[0].commonErrorPx.mean, 3.4, 1e-9);
}

TEST_F(MethodComparison, SampleThatTheBoardDoesNotSee_IsLeftOutForTheBallToo)
{
  const ComparisonResult ball = compareMethods({ known("a", { moved(1), moved(1) }) }, validation, camera);
  ComparisonResult result = ball;
  result.methods.push_back(ball.methods[0]);
  result.methods[1].target = ComparedMethod::Target::Board;
  result.methods[1].captures.resize(1);
  result.methods[1].captures[0].validation.samples[3].status = CameraModel::Status::BehindCamera;
  result.methods[0].captures[1].validation.samples[5].status = CameraModel::Status::BehindCamera;
  for (MethodResult& method : result.methods)
  {
    summarizeMethod(method);
  }
  judgeComparison(result);
  EXPECT_EQ(result.methods[0].commonErrorPx.count, 24 - 1 - 2);
  EXPECT_EQ(result.methods[1].commonErrorPx.count, 12 - 1) << "sample 5 was seen in a capture of the ball";
  // Capture k of both is one repetition: only what both have in the same one counts.
  result.hasPairedCaptures = true;
  judgeComparison(result);
  EXPECT_EQ(result.methods[0].commonErrorPx.count, 12 - 1);
  EXPECT_EQ(result.methods[1].commonErrorPx.count, 12 - 1);
}

TEST_F(MethodComparison, IncompleteMethod_IsNotTheBestOfItsTargetAndHasNoCommonMean)
{
  ComparedMethod patchy = known("patchy", { truth, truth });
  patchy.target = ComparedMethod::Target::Board;
  patchy.calibrate = [whole = patchy.calibrate](int capture)
  {
    MethodAnswer answer = whole(capture);
    answer.status = capture == 0 ? "ok" : "no_fit";
    return answer;
  };
  const ComparisonResult result = compareMethods({ known("steady", { moved(1), moved(1) }), patchy }, validation, camera);
  EXPECT_EQ(result.incomplete, (std::vector<int>{ 1 }));
  EXPECT_EQ(result.message.find("The best of the methods with a board"), std::string::npos) << result.message;
  EXPECT_EQ(result.methods[1].commonErrorPx.count, 0);
  EXPECT_FALSE(comparisonJson(result)["methods"][1].contains("commonProjectionErrorPx"));
  EXPECT_NE(methodsCsv(result).find(",,0,known,nobody"), std::string::npos) << methodsCsv(result);
}

TEST_F(MethodComparison, SubsetsThatFail_CountAsTheWorst)
{
  ComparedMethod method = known("lucky", { truth });
  method.subsetPool = 12;
  int attempt = 0;
  method.calibrateSome = [&](const std::vector<int>& samples)
  {
    // Of 3 samples one in five works, of 4 four in five, from 5 on all.
    MethodAnswer answer;
    const int fifth = attempt++ % 5;
    const bool works = samples.size() > 4 || (samples.size() == 3 ? fifth == 0 : fifth != 0);
    answer.status = works ? "ok" : "no_fit";
    answer.markerToCamera = moved(0.5);
    return answer;
  };
  ComparisonOptions options;
  options.mostSamples = 5;
  const ComparisonResult result = compareMethods({ method }, validation, camera, options);
  const std::vector<SubsetErrors>& subsets = result.methods[0].subsets;
  ASSERT_EQ(subsets.size(), 3U);
  EXPECT_EQ(subsets[0].usable, 4);
  EXPECT_TRUE(std::isinf(subsets[0].medianPx));
  EXPECT_EQ(subsets[1].usable, 16);
  EXPECT_NEAR(subsets[1].medianPx, 1, 1e-9);
  EXPECT_TRUE(std::isinf(subsets[1].highestPx)) << "more than one in ten failed";
  EXPECT_NEAR(subsets[2].highestPx, 1, 1e-9);
  const nlohmann::json json = comparisonJson(result)["methods"][0]["subsets"];
  EXPECT_FALSE(json[0].contains("medianPx"));
  EXPECT_TRUE(json[1].contains("medianPx"));
  EXPECT_FALSE(json[1].contains("percentile90Px"));
  EXPECT_EQ(subsetsCsv(result).find("inf"), std::string::npos);
}

TEST_F(MethodComparison, Subsets_HaveTheSizesAndSeedsAskedFor)
{
  std::vector<std::vector<int>> drawn;
  ComparedMethod method = known("subsets", { truth });
  method.subsetPool = 7;
  method.calibrateSome = [&](const std::vector<int>& samples)
  {
    drawn.push_back(samples);
    MethodAnswer answer;
    answer.status = samples.size() < 4 ? "too_few_samples" : "ok";
    if (samples.size() >= 4)
    {
      answer.markerToCamera = moved(0.1 * double(samples.size()));
    }
    return answer;
  };
  ComparisonOptions options;
  options.subsetRepetitions = 9;
  options.halvings = 2;
  const ComparisonResult result = compareMethods({ method }, validation, camera, options);
  const std::vector<SubsetErrors>& subsets = result.methods[0].subsets;
  ASSERT_EQ(subsets.size(), 5U) << "3 to 7";
  EXPECT_EQ(subsets[0].usable, 0);
  EXPECT_EQ(subsets[1].usable, 9);
  EXPECT_NEAR(subsets[1].medianPx, 0.8, 1e-9);
  EXPECT_NEAR(subsets[4].medianPx, 1.4, 1e-9);
  ASSERT_EQ(drawn.size(), 5U * 9 + 4);
  for (const std::vector<int>& samples : drawn)
  {
    const std::set<int> different(samples.begin(), samples.end());
    EXPECT_EQ(different.size(), samples.size());
    EXPECT_GE(*different.begin(), 0);
    EXPECT_LT(*different.rbegin(), 7);
  }
  for (std::size_t half = 45; half < drawn.size(); half += 2)
  {
    std::set<int> both(drawn[half].begin(), drawn[half].end());
    both.insert(drawn[half + 1].begin(), drawn[half + 1].end());
    EXPECT_EQ(both.size(), 7U) << "halves share nothing and leave nothing out";
  }
  const auto first = drawn;
  drawn.clear();
  (void)compareMethods({ method }, validation, camera, options);
  EXPECT_EQ(drawn, first) << "fixed seeds";
  drawn.clear();
  options.seed = 2;
  (void)compareMethods({ method }, validation, camera, options);
  EXPECT_NE(drawn, first);
}

TEST_F(MethodComparison, Stopped_SaysSo)
{
  ComparisonOptions options;
  int told = 0;
  options.progress = [&](const std::string&, int done, int total)
  {
    EXPECT_LE(done, total);
    return ++told < 2;
  };
  const ComparisonResult result =
    compareMethods({ known("a", { truth }), known("b", { truth }), known("c", { truth }) }, validation, camera, options);
  EXPECT_TRUE(result.wasStopped);
  EXPECT_EQ(result.status, "stopped");
  EXPECT_EQ(told, 2);
}

TEST_F(MethodComparison, Progress_ReachesItsEnd)
{
  ComparisonOptions options;
  std::pair<int, int> last;
  options.progress = [&](const std::string&, int done, int total)
  {
    last = { done, total };
    return true;
  };
  (void)compareMethods({ known("a", { truth, truth }), failing("b") }, validation, camera, options);
  EXPECT_GT(last.second, 0);
  EXPECT_EQ(last.first, last.second);
}

TEST_F(MethodComparison, OptionsThatMakeNoSense_AreRefused)
{
  ComparisonOptions options;
  options.mostSamples = 2;
  EXPECT_THROW((void)compareMethods({}, validation, camera, options), std::invalid_argument);
  options = {};
  options.subsetRepetitions = -1;
  EXPECT_THROW((void)compareMethods({}, validation, camera, options), std::invalid_argument);
}

TEST_F(MethodComparison, ErrorsCsv_HasALineASample)
{
  const ComparisonResult result = compareMethods({ known("a,\"b\"", { moved(1) }) }, validation, camera);
  const std::string csv = errorsCsv(result, validation);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
  EXPECT_NE(csv.find("\"a,\"\"b\"\"\",0,10,ok,"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("nan"), std::string::npos);
}
