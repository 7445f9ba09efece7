// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TouchTask.h"

#include <gtest/gtest.h>

#include <thread>

using handeye::TouchTask;

namespace
{

const Eigen::Vector3d Tip_Stylus(-1.9, 0.4, 186.4);
const Eigen::Vector3d Landmark_Phantom(12, -7, 30);

handeye::devices::DeviceSample poseSample(const char* name, double timeSec, const Eigen::Isometry3d& pose, bool isValid = true)
{
  handeye::devices::DeviceSample sample;
  sample.name = name;
  sample.timeSec = timeSec;
  handeye::devices::TrackedPose tracked;
  tracked.isValid = isValid;
  tracked.transform = pose;
  sample.content = tracked;
  return sample;
}

/// A phantom that drifts, and a stylus whose tip stays on its landmark.
class TouchTaskTest : public testing::Test
{
protected:
  TouchTaskTest() { task_.follow(Tip_Stylus, "StylusToTracker", "PhantomToTracker"); }

  Eigen::Isometry3d phantomAt(double timeSec) const
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(0.3 + 0.02 * timeSec, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(40 + 20 * timeSec, -100, -1200);
    return pose;
  }
  Eigen::Isometry3d stylusAt(double timeSec) const
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(1.1 + 0.02 * timeSec, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    pose.translation() = phantomAt(timeSec) * Landmark_Phantom - pose.linear() * Tip_Stylus;
    return pose;
  }
  /// 60 poses a second of each tool, the phantom's in between the stylus'.
  void play(double fromSec, double toSec, bool isPhantomSeen = true)
  {
    constexpr double step = 1 / 60.0;
    for (double time = fromSec; time < toSec; time += step)
    {
      task_.onSample(poseSample("StylusToTracker", time, stylusAt(time)));
      task_.onSample(poseSample("PhantomToTracker", time + step / 2, phantomAt(time + step / 2), isPhantomSeen));
    }
  }

  TouchTask task_;
};

}  // namespace

TEST_F(TouchTaskTest, PosesAlone_WithoutVideo_GiveTheTipAndItsRest)
{
  play(5, 7);
  const TouchTask::Touch touch = task_.newest();
  EXPECT_TRUE(touch.problem.isEmpty()) << touch.problem.toStdString();
  ASSERT_TRUE(touch.tip_Phantom && touch.rest_Phantom);
  EXPECT_LT((*touch.tip_Phantom - Landmark_Phantom).norm(), 1e-3) << "the phantom's pose is that of the stylus' moment";
  EXPECT_LT((*touch.rest_Phantom - Landmark_Phantom).norm(), 1e-3) << "it rests on the phantom, however that moves";
}

TEST_F(TouchTaskTest, HiddenPhantom_IsNamed)
{
  play(5, 7);
  play(7, 8, false);
  const TouchTask::Touch touch = task_.newest();
  EXPECT_FALSE(touch.tip_Phantom || touch.rest_Phantom);
  EXPECT_TRUE(touch.problem.startsWith("PhantomToTracker: ")) << touch.problem.toStdString();
}

TEST_F(TouchTaskTest, PhantomThatNeverComes_IsNamed)
{
  for (double time = 5; time < 7; time += 1 / 60.0)
  {
    task_.onSample(poseSample("StylusToTracker", time, stylusAt(time)));
  }
  EXPECT_TRUE(task_.newest().problem.startsWith("PhantomToTracker: ")) << task_.newest().problem.toStdString();
}

TEST_F(TouchTaskTest, StreamThatEnds_IsNamed)
{
  play(5, 7);
  ASSERT_TRUE(task_.newest().tip_Phantom);
  std::this_thread::sleep_for(std::chrono::milliseconds(900));
  EXPECT_FALSE(task_.newest().tip_Phantom);
  EXPECT_TRUE(task_.newest().problem.startsWith("StylusToTracker: ")) << task_.newest().problem.toStdString();
}

TEST_F(TouchTaskTest, ClockThatIsSetBack_BeginsAnew)
{
  play(500, 502);
  play(5, 7);
  ASSERT_TRUE(task_.newest().rest_Phantom) << task_.newest().problem.toStdString();
  EXPECT_LT((*task_.newest().rest_Phantom - Landmark_Phantom).norm(), 1e-3);
}

TEST_F(TouchTaskTest, NoStylus_IsSaid)
{
  task_.follow(std::nullopt, "StylusToTracker", "PhantomToTracker");
  play(5, 6);
  EXPECT_FALSE(task_.newest().tip_Phantom);
  EXPECT_TRUE(task_.newest().problem.contains("not calibrated")) << task_.newest().problem.toStdString();
}
