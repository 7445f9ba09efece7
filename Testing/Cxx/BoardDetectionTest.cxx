// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boards in rendered pictures: what is found, where, and what is refused.
#include "BoardDetection.h"

#include "BoardPattern.h"
#include "BoardPicture.h"
#include "BoardPose.h"
#include "BoardSimulation.h"
#include "GeometryMatchers.h"
#include "Statistics.h"
#include "TestCameras.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <iostream>

namespace
{

using namespace handeye;
using namespace handeye::test;
using Status = BoardDetection::Status;

/// Looked at from the front, the middle in the middle, tilted by `tilt` about an axis in the board.
Eigen::Isometry3d inFront(const BoardDescription& board, double distanceMm, const Eigen::Vector3d& tilt)
{
  Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
  boardToCamera.linear() = rotationFromVector(tilt);
  boardToCamera.translation() = Eigen::Vector3d(0, 0, distanceMm) - boardToCamera.linear() * boardCenter(board);
  return boardToCamera;
}

/// Root mean square distance (px) of the points from where they are.
double rmsPx(const BoardDetection& detection, const CameraModel& camera, const Eigen::Isometry3d& boardToCamera)
{
  double squares = 0;
  for (std::size_t i = 0; i < detection.ids.size(); ++i)
  {
    squares += (camera.project(boardToCamera * detection.points_Board[i]).point_Image - detection.points_Image[i]).squaredNorm();
  }
  return std::sqrt(squares / double(detection.ids.size()));
}

const char* const Boards[] = { "chessboard:9x6:20", "chessboard:8x6:20", "charuco:9x6:22:16:DICT_4X4_50",
  "charuco:8x5:24:18:DICT_APRILTAG_36H11", "circles:8x6:22", "acircles:4x11:11" };

}  // namespace

TEST(BoardDescription, Text_IsReadAndWritten)
{
  const BoardDescription board = parseBoard("charuco:8x6:30:22.5:DICT_5X5_100");
  EXPECT_EQ(board.kind, BoardDescription::Kind::Charuco);
  EXPECT_EQ(board.columns, 8);
  EXPECT_EQ(board.rows, 6);
  EXPECT_EQ(board.pointCount(), 35);
  EXPECT_EQ(board.spacingMm, 30);
  EXPECT_EQ(board.markerMm, 22.5);
  for (const char* text : Boards)
  {
    EXPECT_EQ(toString(parseBoard(text)), text);
  }
  EXPECT_EQ(arucoDictionaryNames().size(), 21U);
  for (const std::string& dictionary : arucoDictionaryNames())
  {
    EXPECT_NO_THROW(parseBoard("charuco:5x4:30:20:" + dictionary)) << dictionary;
  }
}

TEST(BoardDescription, WrongText_SaysWhatIsExpected)
{
  const std::pair<const char*, const char*> cases[] = { { "", "no kind of board" }, { "checker:9x6:20", "'checker'" },
    { "chessboard:9x6", "2 parts" }, { "chessboard:9:20", "COLSxROWS" }, { "chessboard:9x6:-2", "'-2'" },
    { "chessboard:9x6:2e400", "mm" }, { "chessboard:9x6:nan", "mm" }, { "chessboard:9.5x6:20", "'9.5'" },
    { "chessboard:1x6:20", "columns and rows" }, { "chessboard:2x6:20", "3 x 3" }, { "charuco:8x6:30:22", "4 parts" },
    { "charuco:8x6:20:22:DICT_4X4_50", "smaller" }, { "charuco:8x6:30:22:DICT_4X4_60", "DICT_7X7_1000" },
    { "charuco:20x20:30:22:DICT_4X4_50", "200 markers" }, { "circles:7x6:20:5", "parts" },
    { "chessboard:99999999999x6:20", "whole number" } };
  for (const auto& [text, words] : cases)
  {
    expectInvalidArgument([text = text] { (void)parseBoard(text); }, { words });
  }
  EXPECT_THROW((void)boardPoint(parseBoard("chessboard:9x6:20"), 54), std::out_of_range);
}

TEST(BoardPattern, BlackAreas_AreWhereTheDescriptionPutsThem)
{
  const BoardPattern chess(parseBoard("chessboard:9x6:20"));
  EXPECT_EQ(chess.blackRectangles().size(), 35U);
  EXPECT_TRUE(chess.isBlack({ -10, -10 })) << "the first square";
  EXPECT_TRUE(chess.isBlack({ 10, 10 })) << "the square after point 0";
  EXPECT_FALSE(chess.isBlack({ 30, 10 }));
  EXPECT_FALSE(chess.isBlack({ -30, 10 })) << "the margin";
  EXPECT_TRUE(pointNear(chess.sheet().upper_Board, Eigen::Vector2d(200, 140), 1e-12));
  const BoardPattern circles(parseBoard("acircles:4x11:11"));
  EXPECT_TRUE(circles.isBlack({ 11 + 5.4, 11 }));
  EXPECT_FALSE(circles.isBlack({ 11 + 5.6, 11 }));
}

/// Point by point in the right order, for turned boards and mirrored orders, to a few hundredths of a pixel.
TEST(BoardDetection, EachBoard_IsFoundToHundredthsOfAPixel)
{
  const CameraModel camera = webcam();
  for (const char* text : Boards)
  {
    const BoardDescription board = parseBoard(text);
    const simulation::BoardPicture picture(board, camera);
    double worst = 0;
    int found = 0;
    for (const Eigen::Vector3d& tilt : { Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.5, 0, 0.2), Eigen::Vector3d(0, -0.5, 0.1),
           Eigen::Vector3d(0.3, 0.3, -0.3), Eigen::Vector3d(0.1, 0, 3.1), Eigen::Vector3d(0, 0, 1.6) })
    {
      const Eigen::Isometry3d boardToCamera = inFront(board, 330, tilt);
      Photograph how;
      how.noise = 1.5;
      const BoardDetection detection = detectBoard(picture.take(boardToCamera, how), board);
      ASSERT_TRUE(detection.isUsable()) << text << " at " << tilt.transpose() << ": " << detection.message;
      ++found;
      EXPECT_EQ(int(detection.ids.size()), board.pointCount()) << text;
      const bool isTurned = tilt.z() > 1.5 && board.looksTheSameTurned();
      if (!isTurned)
      {
        worst = std::max(worst, rmsPx(detection, camera, boardToCamera));
      }
      EXPECT_GT(detection.edgeWidthPx, 1) << text;
      EXPECT_LT(detection.edgeWidthPx, 4) << text;
    }
    std::cout << text << ": " << worst << " px RMS at worst, " << found << " found\n";
    // Circles have the shift of a circle's centre in them, which calibrateLens() takes out.
    EXPECT_LT(worst, board.kind == BoardDescription::Kind::Circles ? 0.3 : 0.1) << text;
  }
}

TEST(BoardDetection, CharucoHalfOutside_IsUsed)
{
  const CameraModel camera = webcam();
  const BoardDescription board = parseBoard("charuco:9x6:22:16:DICT_5X5_50");
  const simulation::BoardPicture picture(board, camera);
  Eigen::Isometry3d boardToCamera = inFront(board, 300, { 0.2, 0.3, 0 });
  boardToCamera.translation().x() += 160;  // the middle is at the right border
  const BoardDetection detection = detectBoard(picture.take(boardToCamera), board);
  ASSERT_TRUE(detection.isUsable()) << detection.message;
  EXPECT_GE(detection.ids.size(), 12U);
  EXPECT_LE(detection.ids.size(), 28U) << "of 40";
  EXPECT_LT(rmsPx(detection, camera, boardToCamera), 0.1);
  const BoardPose pose = estimateBoardPose(detection.points_Board, detection.points_Image, camera);
  ASSERT_TRUE(pose.isUsable()) << pose.message;
  EXPECT_TRUE(rigid3dNear(pose.boardToCamera, boardToCamera, 0.004, 0.6));
}

TEST(BoardDetection, OtherBoards_AreNotTakenForThisOne)
{
  const CameraModel camera = webcam();
  struct Case
  {
    const char* shown;
    const char* wanted;
    std::vector<Status> allowed;
  };
  const Case cases[] = { { "chessboard:9x6:20", "chessboard:8x5:20", { Status::NotFound, Status::WrongBoard } },
    { "chessboard:7x5:20", "chessboard:9x6:20", { Status::NotFound } },
    { "charuco:9x6:22:16:DICT_4X4_50", "charuco:9x6:22:16:DICT_6X6_250",
      { Status::NotFound, Status::WrongBoard, Status::TooFewPoints } },
    { "charuco:9x6:22:16:DICT_4X4_50", "charuco:8x6:22:16:DICT_4X4_50", { Status::WrongBoard, Status::TooFewPoints } },
    { "circles:8x6:22", "acircles:4x11:11", { Status::NotFound, Status::WrongBoard } },
    { "chessboard:9x6:20", "circles:8x6:22", { Status::NotFound, Status::WrongBoard } } };
  for (const Case& each : cases)
  {
    const BoardDescription shown = parseBoard(each.shown);
    const cv::Mat image = simulation::BoardPicture(shown, camera).take(inFront(shown, 350, { 0.2, 0.2, 0 }));
    const BoardDetection detection = detectBoard(image, parseBoard(each.wanted));
    EXPECT_NE(std::count(each.allowed.begin(), each.allowed.end(), detection.status), 0)
      << each.shown << " for " << each.wanted << " gives " << toString(detection.status) << ": " << detection.message;
    EXPECT_TRUE(says(detection.message, {}));
  }
}

TEST(BoardDetection, NoBoard_IsNoBoard)
{
  cv::Mat image(480, 640, CV_8UC3);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 0, 255);
  for (const char* text : { "chessboard:9x6:20", "charuco:9x6:22:16:DICT_4X4_50", "circles:8x6:22" })
  {
    EXPECT_EQ(detectBoard(image, parseBoard(text)).status, Status::NotFound) << text;
    EXPECT_EQ(detectBoard(cv::Mat::zeros(480, 640, CV_8UC1), parseBoard(text)).status, Status::NotFound) << text;
  }
  expectInvalidArgument([] { (void)detectBoard(cv::Mat(), parseBoard("chessboard:9x6:20")); }, { "image" });
  expectInvalidArgument(
    [] { (void)detectBoard(cv::Mat::zeros(9, 9, CV_32F), parseBoard("chessboard:9x6:20")); }, { "8 or 16 bits" });
}

TEST(BoardDetection, DepthsAndBlur_AreSeenAsTheyAre)
{
  const CameraModel camera = webcam();
  const BoardDescription board = parseBoard("chessboard:9x6:20");
  const simulation::BoardPicture picture(board, camera);
  const Eigen::Isometry3d boardToCamera = inFront(board, 330, { 0.3, 0.2, 0 });
  Photograph wide, blurred;
  wide.type = CV_16UC3;
  blurred.blurPx = 3;
  const BoardDetection of16 = detectBoard(picture.take(boardToCamera, wide), board);
  ASSERT_TRUE(of16.isUsable());
  EXPECT_LT(rmsPx(of16, camera, boardToCamera), 0.1);
  const BoardDetection soft = detectBoard(picture.take(boardToCamera, blurred), board);
  ASSERT_TRUE(soft.isUsable());
  // A Gaussian's step rises from 10 to 90 % within 2.56 standard deviations, and the camera's gamma widens its dark side.
  EXPECT_NEAR(soft.edgeWidthPx, 2.56 * 3, 1.5);
  EXPECT_GT(soft.edgeWidthPx, 2 * of16.edgeWidthPx);
}

TEST(BoardPose, NoiseFree_IsExactForEachCamera)
{
  Random random(1);
  const BoardDescription board = parseBoard("chessboard:9x6:20");
  for (const auto& [name, camera] : allCameras())
  {
    for (int i = 0; i < 10; ++i)
    {
      const Eigen::Isometry3d truth = BoardViews().pose(board, camera, random);
      const LensView view = seenBoard(0, board, camera, truth, 0, random);
      const BoardPose pose = estimateBoardPose(view.points_Board, view.points_Image, camera);
      ASSERT_TRUE(pose.isUsable()) << name << ": " << pose.message;
      EXPECT_TRUE(rigid3dNear(pose.boardToCamera, truth, 1e-8, 1e-6)) << name;
    }
  }
}

/// What the covariance promises is what the errors are.
TEST(BoardPose, Covariance_IsThatOfTheErrors)
{
  Random random(2);
  const BoardDescription board = parseBoard("chessboard:9x6:20");
  const CameraModel camera = webcam();
  double normalized = 0;
  constexpr int Trials = 400;
  for (int i = 0; i < Trials; ++i)
  {
    const Eigen::Isometry3d truth = BoardViews().pose(board, camera, random);
    const LensView view = seenBoard(0, board, camera, truth, 0.2, random);
    const BoardPose pose = estimateBoardPose(view.points_Board, view.points_Image, camera);
    ASSERT_NE(pose.status, BoardPose::Status::PoorFit);
    const Eigen::Isometry3d error = pose.boardToCamera * truth.inverse();
    const Eigen::AngleAxisd turn(error.linear());
    Eigen::Matrix<double, 6, 1> difference;
    difference << turn.angle() * turn.axis(), pose.boardToCamera.translation() - error.linear() * truth.translation();
    normalized += difference.dot(pose.covariance.ldlt().solve(difference)) / Trials;
  }
  EXPECT_NEAR(normalized, 6, 1) << "the mean of a chi square with 6 degrees of freedom";
}

TEST(BoardPose, BadPoints_HaveTheirStatus)
{
  using PoseStatus = BoardPose::Status;
  const CameraModel camera = webcam();
  const BoardDescription board = parseBoard("chessboard:9x6:20");
  Random random(3);
  const Eigen::Isometry3d truth = inFront(board, 300, { 0.3, 0.1, 0 });
  LensView view = seenBoard(0, board, camera, truth, 0, random);
  std::vector<Eigen::Vector3d> line(view.points_Board.begin(), view.points_Board.begin() + 9);
  std::vector<Eigen::Vector2d> lineSeen(view.points_Image.begin(), view.points_Image.begin() + 9);
  EXPECT_EQ(estimateBoardPose(line, lineSeen, camera).status, PoseStatus::NotObservable);
  line.resize(3);
  lineSeen.resize(3);
  EXPECT_EQ(estimateBoardPose(line, lineSeen, camera).status, PoseStatus::TooFewPoints);
  std::vector<Eigen::Vector2d> shuffled = view.points_Image;
  std::reverse(shuffled.begin(), shuffled.begin() + 27);
  EXPECT_EQ(estimateBoardPose(view.points_Board, shuffled, camera).status, PoseStatus::PoorFit);
  // Small and far away: which way it is tilted drowns in the noise.
  const BoardDescription small = parseBoard("chessboard:4x3:2");
  const LensView far = seenBoard(0, small, camera, inFront(small, 600, { 0.3, 0.1, 0 }), 0.3, random);
  EXPECT_EQ(estimateBoardPose(far.points_Board, far.points_Image, camera).status, PoseStatus::Ambiguous);
  expectInvalidArgument([&] { (void)estimateBoardPose(line, view.points_Image, camera); }, { "3 points" });
  view.points_Board[4].y() = std::nan("");
  expectInvalidArgument([&] { (void)estimateBoardPose(view.points_Board, view.points_Image, camera); }, { "point 4" });
}
