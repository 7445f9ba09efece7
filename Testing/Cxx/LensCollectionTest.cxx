// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Views of a board from pictures as they come.
#include "LensCollection.h"

#include "BoardPattern.h"
#include "BoardPicture.h"
#include "BoardSimulation.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace handeye;
using namespace handeye::test;

namespace
{

class LensCollecting : public testing::Test
{
protected:
  cv::Mat pictureAt(double x, double tilt) const
  {
    Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
    boardToCamera.linear() = rotationFromVector({ 0, tilt, 0 });
    boardToCamera.translation() = Eigen::Vector3d(x, 0, 150) - boardToCamera.linear() * boardCenter(board);
    return picture.take(boardToCamera);
  }

  const CameraModel camera = makeCamera(480, 360, 450, 451, 238.2, 181.7, { -0.12, 0.05, 0.0006, -0.0008 });
  const BoardDescription board = parseBoard("charuco:7x5:12:9:DICT_4X4_50");
  const simulation::BoardPicture picture{ board, camera };
};

}  // namespace

TEST_F(LensCollecting, StillBoards_AreTakenOnceEach_AndNumbered)
{
  LensViewCollectorOptions options;
  options.stillFrames = 2;
  LensCollection collection(board, options);
  EXPECT_EQ(collection.collector(), nullptr);
  EXPECT_EQ(collection.width(), 0);
  for (const double x : { -20.0, 15.0 })
  {
    for (int i = 0; i < 4; ++i)
    {
      const LensCollection::Look look = collection.add(pictureAt(x, x < 0 ? 0.3 : -0.3));
      EXPECT_EQ(look.isTaken, i == 1) << "picture " << i << " at " << x << ": " << look.message;
      EXPECT_EQ(look.message.empty(), false);
    }
  }
  EXPECT_EQ(collection.width(), 480);
  EXPECT_EQ(collection.height(), 360);
  EXPECT_EQ(collection.pictureCount(), 8);
  EXPECT_EQ(collection.withBoardCount(), 8);
  ASSERT_EQ(collection.views().size(), 2U);
  ASSERT_EQ(collection.detections().size(), 2U);
  EXPECT_EQ(collection.views()[1].frame, 1) << "views are numbered, not pictures";
  EXPECT_EQ(collection.notTaken().at("moving"), 2);
  EXPECT_EQ(collection.notTaken().at("not_new"), 4);
  EXPECT_EQ(collection.commonestReason(), "");
}

TEST_F(LensCollecting, PicturesWithoutTheBoard_HaveTheirReason)
{
  LensCollection collection(board);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_FALSE(collection.add(cv::Mat(360, 480, CV_8UC3, cv::Scalar(90, 90, 90))).isTaken);
  }
  EXPECT_EQ(collection.withBoardCount(), 0);
  EXPECT_EQ(collection.notTaken().size(), 1U);
  EXPECT_EQ(collection.notTaken().begin()->second, 3);
  EXPECT_FALSE(collection.commonestReason().empty());
  EXPECT_TRUE(collection.views().empty());
}

TEST_F(LensCollecting, AnotherSize_IsRefusedInWords_AndCostsNothing)
{
  LensViewCollectorOptions options;
  options.stillFrames = 1;
  LensCollection collection(board, options);
  ASSERT_TRUE(collection.add(pictureAt(0, 0.2)).isTaken);
  try
  {
    collection.add(cv::Mat(180, 240, CV_8UC3, cv::Scalar::all(0)));
    FAIL() << "a picture of another size was taken";
  }
  catch (const std::runtime_error& error)
  {
    EXPECT_NE(std::string(error.what()).find("480 x 360 to 240 x 180 px"), std::string::npos) << error.what();
  }
  EXPECT_EQ(collection.pictureCount(), 1);
  EXPECT_EQ(collection.views().size(), 1U);
}
