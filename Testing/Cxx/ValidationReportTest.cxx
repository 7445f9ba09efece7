// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationReport.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"
#include "NumberWords.h"
#include "OffscreenRendering.h"
#include "ReportPlots.h"
#include "ValidationStep.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::readBytes;
using handeye::io::test::TemporaryFolder;

namespace
{

int countOf(const std::string& text, const std::string& word)
{
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
  {
    ++count;
  }
  return count;
}

bool isGreen(const cv::Vec3b& pixel)
{
  return pixel[1] > 150 && pixel[0] < 140 && pixel[2] < 140;
}

bool isYellow(const cv::Vec3b& pixel)
{
  return pixel[1] > 150 && pixel[2] > 180 && pixel[0] < 90;
}

/// Some pixel within two of this place is of this colour.
template<typename IsColor> bool hasColorNear(const cv::Mat& picture, const Eigen::Vector2d& place, IsColor isColor)
{
  for (int row = int(place.y()) - 2; row <= int(place.y()) + 2; ++row)
  {
    for (int column = int(place.x()) - 2; column <= int(place.x()) + 2; ++column)
    {
      if (isColor(picture.at<cv::Vec3b>(row, column)))
      {
        return true;
      }
    }
  }
  return false;
}

/// Four frames: the third has no picture, the fourth no stylus. The calibration is off by 8 mm sideways.
class ValidationReport : public testing::Test
{
protected:
  void SetUp() override
  {
    registerOffscreenRendering();
    auto tracking = session.trackAll();
    tracking[3].transforms["StylusToTracker"].status = "INVALID";
    const auto path = session.write(folder.path() / "capture", tracking);
    std::filesystem::remove(SimulatedSession::picturePath(path, 2));
    const io::Recording recording = io::Recording::open(path);
    const auto frames = readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
    const Eigen::Isometry3d markerToCamera = makeRigid({ 0, 0, 0 }, { 8, 0, 0 }) * session.markerToCamera;
    result = validateCapture(frames, session.camera, markerToCamera);
    result.subject.calibrationFile = "some/calibration.json";
    result.subject.ballRadiusMm = session.ballRadiusMm;
    writeValidationReport(report, result, recording);
  }

  const SimulatedSession session{ 4 };
  const TemporaryFolder folder;
  const std::filesystem::path report = folder.path() / "out" / "report";
  ValidationStepResult result;
};

}  // namespace

TEST_F(ValidationReport, Page_HasVerdictTablesAndPlots)
{
  const std::string page = readBytes(report / "report.html");
  EXPECT_NE(page.find(result.message), std::string::npos);
  EXPECT_EQ(countOf(page, "data:image/png"), 2) << "error against distance, and the errors' directions";
  EXPECT_EQ(countOf(page, "<tr>"), 2 + 5) << "the summary; a heading and a row for each frame";
  EXPECT_NE(page.find("image_missing"), std::string::npos);
  EXPECT_NE(page.find("stylus_invalid"), std::string::npos);
  char error[32];
  std::snprintf(error, sizeof(error), "<td>%.2f</td>", result.frames[1].validated->errorPx);
  EXPECT_GE(countOf(page, error), 1) << error;
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST_F(ValidationReport, Page_NamesWhatWasValidated)
{
  const std::string page = readBytes(report / "report.html");
  for (const std::string words :
    { "Calibration: some/calibration.json", "Camera: 320 x 240 px, focal lengths ", "Ball: radius ", "Capture: " })
  {
    EXPECT_NE(page.find("<p>" + words), std::string::npos) << words;
  }
}

TEST_F(ValidationReport, Directions_AreTheSameInTableAndPlot)
{
  const std::string page = readBytes(report / "report.html");
  const handeye::report::Plot plot = handeye::report::errorDirections(result).value();
  EXPECT_NE(page.find(">" + plot.xLabel + "<"), std::string::npos) << plot.xLabel;
  EXPECT_NE(page.find(">" + plot.yLabel + "<"), std::string::npos) << plot.yLabel;
  EXPECT_NE(page.find(">" + fixedDigits(plot.series[0].y[1], 2) + "<"), std::string::npos) << plot.series[0].y[1];
}

TEST_F(ValidationReport, Page_IsOneFileAndAPdfIsBesideIt)
{
  const std::string page = readBytes(report / "report.html");
  EXPECT_EQ(countOf(page, "src="), countOf(page, "src='data:image/")) << "nothing is loaded from elsewhere";
  EXPECT_EQ(countOf(page, "data:image/jpeg"), 3) << "the frames that have a picture";
  EXPECT_EQ(readBytes(report / "report.pdf").rfind("%PDF-", 0), 0U);
}

TEST_F(ValidationReport, Csv_HasALineAFrame)
{
  const std::string csv = readBytes(report / "errors.csv");
  EXPECT_EQ(countOf(csv, "\r\n"), 5);
  EXPECT_NE(csv.find("\r\n2,image_missing,,,,,,\r\n"), std::string::npos) << csv;
  std::size_t line = csv.find("\r\n1,ok,");
  ASSERT_NE(line, std::string::npos);
  double distance = 0, error = 0;
  ASSERT_EQ(std::sscanf(csv.c_str() + line, "\r\n1,ok,%lf,%lf,", &distance, &error), 2);
  EXPECT_EQ(error, result.frames[1].validated->errorPx) << "as it was, not rounded";
  EXPECT_EQ(distance, result.frames[1].validated->distanceMm);
}

TEST_F(ValidationReport, Pictures_AreBesideThePage)
{
  for (int frame = 0; frame < 4; ++frame)
  {
    const std::string name = SimulatedSession::picturePath("", frame).filename().string();
    EXPECT_EQ(std::filesystem::exists(report / name), frame != 2) << name;
  }
}

TEST_F(ValidationReport, Picture_ShowsBothCentres)
{
  const cv::Mat picture = cv::imread((report / "0001.png").string());
  ASSERT_EQ(picture.size(), cv::Size(320, 240));
  const ValidatedFrame& frame = result.frames[1];
  ASSERT_GT(frame.validated->errorPx, 6) << "far enough apart to be told";
  EXPECT_TRUE(hasColorNear(picture, frame.captured.ball.ball_Image, isGreen));
  EXPECT_TRUE(hasColorNear(picture, frame.validated->projected_Image, isYellow));
  int greenEdges = 0;
  for (const Eigen::Vector2d& edge : frame.captured.ball.outline_Image)
  {
    greenEdges += hasColorNear(picture, edge, isGreen) ? 1 : 0;
  }
  EXPECT_GT(greenEdges, 40);
}

TEST_F(ValidationReport, PictureOfAFrameWithoutTracking_ShowsTheBallOnly)
{
  const cv::Mat picture = cv::imread((report / "0003.png").string());
  EXPECT_TRUE(hasColorNear(picture, result.frames[3].captured.ball.ball_Image, isGreen));
  int yellow = 0;
  for (int i = 0; i < int(picture.total()); ++i)
  {
    yellow += isYellow(picture.at<cv::Vec3b>(i / picture.cols, i % picture.cols)) ? 1 : 0;
  }
  EXPECT_EQ(yellow, 0);
}

TEST_F(ValidationReport, NothingValidated_StillMakesAPage)
{
  const io::Recording recording = io::Recording::open(folder.path() / "capture");
  auto frames = detectBalls(recording, session.camera, session.ballRadiusMm);
  for (CapturedFrame& frame : frames)
  {
    frame.status = "not_found";
  }
  const ValidationStepResult none = validateCapture(frames, session.camera, session.markerToCamera);
  writeValidationReport(folder.path() / "none", none, recording);
  const std::string page = readBytes(folder.path() / "none" / "report.html");
  EXPECT_NE(page.find("nothing could be validated"), std::string::npos);
  EXPECT_EQ(countOf(page, "data:image/png"), 0) << "no plot of nothing";
}

TEST_F(ValidationReport, FolderThatCannotBeMade_IsReported)
{
  const auto inTheWay = folder.write("file", "in the way");
  expectFileError(
    [&] { writeValidationReport(inTheWay / "report", result, io::Recording::open(folder.path() / "capture")); }, { "file" });
}
