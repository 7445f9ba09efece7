// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkFiles.h"

#include "GeometryMatchers.h"
#include "IoTestSupport.h"

#include <gtest/gtest.h>

#include <fstream>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::TemporaryFolder;
using nlohmann::json;

namespace
{

class LandmarkFiles : public ::testing::Test
{
protected:
  std::filesystem::path write(const char* name, const std::string& text) const
  {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }

  static TouchedLandmarksResult touched()
  {
    TouchedLandmarksResult result;
    result.status = TouchedLandmarksResult::Status::Ok;
    result.stylusToTracker = "StylusToTracker";
    result.phantomToTracker = "ReferenceToTracker";
    for (int i = 0; i < 3; ++i)
    {
      TouchedLandmark landmark;
      landmark.point_Phantom = Eigen::Vector3d(1.25 * i, 20, -3.5);
      landmark.rest.tip_World = landmark.point_Phantom;
      landmark.rest.firstSample = 100 * i;
      landmark.rest.lastSample = 100 * i + 40;
      result.landmarks.push_back(landmark);
    }
    return result;
  }

  TemporaryFolder folder_;
};

}  // namespace

TEST_F(LandmarkFiles, WhatWasWritten_IsReadBackFromTextAndFromJson)
{
  for (const char* name : { "touched.txt", "touched.json" })
  {
    writeTouchedLandmarks(folder_.path() / name, touched(), "recording.igs.mha");
    const LandmarkList list = readLandmarks(folder_.path() / name);
    EXPECT_TRUE(list.isTouched) << name;
    ASSERT_EQ(list.points.size(), 3U) << name;
    EXPECT_TRUE(pointNear(list.points[2], Eigen::Vector3d(2.5, 20, -3.5), 1e-4)) << name;
  }
}

TEST_F(LandmarkFiles, PlainText_IsNeither)
{
  const LandmarkList list = readLandmarks(write("points.txt", "# picked\n1 2 3\n4 5 6\n"));
  EXPECT_FALSE(list.isTouched);
  EXPECT_EQ(list.points.size(), 2U);
}

TEST_F(LandmarkFiles, RowsOfNumbers_AreLandmarksIfTheyAreNoCamera)
{
  const TemporaryFolder texts;
  EXPECT_TRUE(isLandmarkText(texts.write("model.txt", "0.4 -65.4 -15.7\n-42.2 -35.6 2.9\n42.2 -35.8 1.5\n-16.7 -31.8 23.2\n")));
  EXPECT_TRUE(isLandmarkText(texts.write("named.txt", "# tip\n1 2 3\n# base\n4 5 6\n")));
  EXPECT_FALSE(isLandmarkText(texts.write("camera.txt", "800 0 320\n0 800 240\n0 0 1\n0 0 0 0\n")));
  EXPECT_FALSE(isLandmarkText(texts.write("words.txt", "dear diary\n")));
  EXPECT_FALSE(isLandmarkText(texts.path() / "not there.txt"));
}

TEST_F(LandmarkFiles, Names_AreTheCommentsOfThePoints_IfAllHaveOne)
{
  const std::vector<std::string> expected = { "tip", "left rim" };
  EXPECT_EQ(readLandmarkNames(write("above.txt", "# Landmarks, mm\n# tip\n1 2 3\n# left rim\r\n4 5 6\r\n")), expected);
  EXPECT_EQ(readLandmarkNames(write("beside.txt", "1 2 3 # tip\n4 5 6\t#left rim \n")), expected);
  // A heading is no name of the first point.
  EXPECT_TRUE(readLandmarkNames(write("heading.txt", "# picked with a mouse\n1 2 3\n4 5 6\n")).empty());
  EXPECT_TRUE(readLandmarkNames(write("points.json", "{ \"points_Phantom_Mm\": [[1, 2, 3]] }")).empty());
}

TEST_F(LandmarkFiles, ExchangedLists_AreRefused)
{
  writeTouchedLandmarks(folder_.path() / "a.txt", touched(), "recording.igs.mha");
  writeTouchedLandmarks(folder_.path() / "a.json", touched(), "recording.igs.mha");
  const auto model = write("b.txt", "1 2 3\n4 5 6\n7 8 1\n");
  EXPECT_EQ(readLandmarkLists(model, folder_.path() / "a.txt").points_Phantom.size(), 3U);
  for (const char* name : { "a.txt", "a.json" })
  {
    expectFileError([&] { (void)readLandmarkLists(folder_.path() / name, model); }, { name, "were touched", "second" });
  }
  const auto byName = write("L2_model_points.txt", "1 2 3\n"), touchedByName = write("L2_Touched_points.txt", "1 2 3\n");
  EXPECT_NO_THROW((void)readLandmarkLists(byName, touchedByName));
  expectFileError(
    [&] { (void)readLandmarkLists(touchedByName, byName); }, { "L2_Touched_points.txt", "by their names", "L2_model_points.txt" });
}

TEST_F(LandmarkFiles, DamagedJson_IsASentence)
{
  expectFileError([&] { (void)readLandmarks(write("cut.json", "{ \"points")); }, { "cut.json", "neither" });
  expectFileError([&] { (void)readLandmarks(write("none.json", "{}")); }, { "none.json", "points_Phantom_Mm" });
  expectFileError(
    [&] { (void)readLandmarks(write("two.json", "{\"points_Phantom_Mm\": [[1,2,3],[1,2]]}")); }, { "two.json", "landmark 2" });
  expectFileError(
    [&] { (void)readLandmarks(write("word.json", "{\"points_Phantom_Mm\": [[1,2,\"x\"]]}")); }, { "word.json", "landmark 1" });
  expectFileError([&] { (void)readLandmarks(write("bad.json", "{\"status\": \"no_rests\"}")); }, { "bad.json", "no_rests" });
  expectFileError([&] { (void)readLandmarks(folder_.path() / "missing.txt"); }, { "missing.txt" });
}

TEST_F(LandmarkFiles, UnusableResult_HasAReasonAndNoPoints)
{
  TouchedLandmarksResult result = touched();
  result.status = TouchedLandmarksResult::Status::WrongTip;
  result.message = "the tip is another";
  const json object = touchedLandmarksJson(result);
  EXPECT_EQ(object["status"], "wrong_tip");
  EXPECT_FALSE(object.contains("points_Phantom_Mm"));
}
