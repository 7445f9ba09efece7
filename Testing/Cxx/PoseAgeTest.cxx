// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseAge.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

using namespace handeye;

TEST(PoseAge, AllSeen_IsCurrentAndSilent)
{
  const PoseAge age = judgePoseAge({ { "phantom", 9.95 }, { "camera marker", 10.0 } }, 10.0);
  EXPECT_EQ(age.status, PoseAge::Status::Current);
  EXPECT_EQ(age.opacity, 1);
  EXPECT_EQ(age.message, "");
  EXPECT_NEAR(*age.ageSec, 0.05, 1e-12);
}

TEST(PoseAge, HiddenTool_FadesEvenlyAndIsNamed)
{
  PoseAgeOptions options;
  options.currentSec = 0.2;
  options.goneSec = 1.2;
  double before = 1.01;
  for (const double ageSec : { 0.3, 0.7, 1.1 })
  {
    const PoseAge age = judgePoseAge({ { "phantom", 10 - ageSec }, { "camera marker", 10.0 } }, 10.0, options);
    EXPECT_EQ(age.status, PoseAge::Status::Fading);
    EXPECT_NEAR(age.opacity, 1.2 - ageSec, 1e-9);
    EXPECT_LT(age.opacity, before);
    EXPECT_NE(age.message.find("phantom"), std::string::npos);
    EXPECT_EQ(age.message.find("camera marker"), std::string::npos);
    before = age.opacity;
  }
  EXPECT_EQ(judgePoseAge({ { "phantom", 9.3 } }, 10.0, options).message, "the phantom is not seen, for 0.7 s");
}

TEST(PoseAge, LongHidden_IsGone)
{
  const PoseAge age = judgePoseAge({ { "phantom", 8.0 } }, 10.0);
  EXPECT_EQ(age.status, PoseAge::Status::Gone);
  EXPECT_EQ(age.opacity, 0);
  EXPECT_FALSE(age.isUsable());
  EXPECT_EQ(age.message, "the phantom is not seen, for 2.0 s");
}

TEST(PoseAge, NeverSeen_ShowsNothingWhateverTheOthersDo)
{
  const PoseAge age = judgePoseAge({ { "phantom", {} }, { "camera marker", 10.0 } }, 10.0);
  EXPECT_EQ(age.status, PoseAge::Status::NeverSeen);
  EXPECT_EQ(age.opacity, 0);
  EXPECT_FALSE(age.ageSec);
  EXPECT_EQ(age.message, "the phantom has not been seen yet");
}

TEST(PoseAge, TheOldestDecides_AndAllAreNamed)
{
  const PoseAge age = judgePoseAge({ { "phantom", 9.8 }, { "camera marker", 9.6 } }, 10.0);
  EXPECT_NEAR(*age.ageSec, 0.4, 1e-12);
  EXPECT_EQ(age.message, "the phantom is not seen, for 0.2 s; the camera marker is not seen, for 0.4 s");
}

TEST(PoseAge, PoseFromTheFuture_IsCurrent)
{
  EXPECT_EQ(judgePoseAge({ { "phantom", 10.5 } }, 10.0).status, PoseAge::Status::Current);
}

TEST(PoseAge, HiddenInTurn_IsAsOldAsTheLastTimeTogether)
{
  // Each was seen a moment ago, but they were last seen at once 0.4 s ago: the model's place is that old.
  const std::vector<ToolSight> tools = { { "phantom", 9.95 }, { "camera marker", 10.0 } };
  const PoseAge age = judgePoseAge(tools, 9.6, 10.0);
  EXPECT_EQ(age.status, PoseAge::Status::Fading);
  EXPECT_NEAR(*age.ageSec, 0.4, 1e-12);
  EXPECT_NE(age.message.find("phantom and camera marker at once"), std::string::npos) << age.message;
  EXPECT_EQ(judgePoseAge(tools, 9.9, 10.0).status, PoseAge::Status::Current);
  EXPECT_EQ(judgePoseAge(tools, 9.0, 10.0).status, PoseAge::Status::Gone);
}

TEST(PoseAge, NeverTogetherYet_EachToolDecides)
{
  const std::vector<ToolSight> seen = { { "phantom", 9.7 }, { "camera marker", 10.0 } };
  const PoseAge age = judgePoseAge(seen, std::nullopt, 10.0), each = judgePoseAge(seen, 10.0);
  EXPECT_EQ(age.status, PoseAge::Status::Fading);
  EXPECT_EQ(age.opacity, each.opacity);
  EXPECT_EQ(age.message, each.message);
  const PoseAge never = judgePoseAge({ { "phantom", {} }, { "camera marker", 10.0 } }, std::nullopt, 10.0);
  EXPECT_EQ(never.status, PoseAge::Status::NeverSeen);
  EXPECT_EQ(never.message, "the phantom has not been seen yet");
}

TEST(PoseAge, Nonsense_IsRefused)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(judgePoseAge({}, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(judgePoseAge({ { "phantom", nan } }, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(judgePoseAge({ { "phantom", 1.0 } }, nan)), std::invalid_argument);
  PoseAgeOptions options;
  options.goneSec = options.currentSec;
  EXPECT_THROW(static_cast<void>(judgePoseAge({ { "phantom", 1.0 } }, 1, options)), std::invalid_argument);
}
