// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Session.h"
#include "IoTestSupport.h"
#include "Recording.h"
#include "Simulation.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <limits>

namespace
{

using namespace handeye::io;
using handeye::io::test::expectFileError;
using handeye::io::test::hasWarning;
using handeye::io::test::TemporaryFolder;
using handeye::test::Random;

cv::Mat pictureOf(int i)
{
  cv::Mat picture(60, 80, CV_8UC3);
  cv::RNG random(std::uint64_t(i) + 1);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

SessionSample sampleOf(int i)
{
  Random random(unsigned(i) + 7);
  SessionSample sample;
  sample.timeSec = 1000.125 + i;
  sample.transforms["StylusToTracker"] = { random.rigid(300).matrix(), "OK" };
  sample.transforms["MarkerToTracker"] = { random.rigid(300).matrix(), i % 4 == 3 ? "INVALID" : "OK" };
  sample.detection = { { "status", "ok" }, { "ball_Image_Px", { 10.5 + i, 20.25 } } };
  sample.pairing = { { "gapSec", 0.01 } };
  return sample;
}

/// @param content which of the example samples it is
void expectSample(const Session& session, int id, int content)
{
  ASSERT_EQ(session.samples().count(id), 1U) << id;
  const SessionSample& sample = session.samples().at(id);
  const SessionSample expected = sampleOf(content);
  EXPECT_EQ(sample.timeSec, expected.timeSec);
  EXPECT_EQ(sample.detection, expected.detection);
  EXPECT_EQ(sample.pairing, expected.pairing);
  for (const auto& [name, transform] : expected.transforms)
  {
    EXPECT_EQ(*sample.transforms.at(name).matrix, *transform.matrix);
    EXPECT_EQ(sample.transforms.at(name).status, transform.status);
  }
  EXPECT_EQ(cv::norm(session.image(id), pictureOf(content), cv::NORM_INF), 0) << id;
}

void addSamples(Session& session, int count)
{
  for (int i = 0; i < count; ++i)
  {
    EXPECT_EQ(session.addSample(pictureOf(i), sampleOf(i)), i);
  }
}

TEST(Session, ReopeningBringsEverythingBack)
{
  const TemporaryFolder folder;
  {
    Session session = Session::create(folder.path() / "s");
    addSamples(session, 5);
    session.setExcluded(2, true);
    session.setDocument("calibration", { { "status", "ok" } });
  }
  const Session session = Session::open(folder.path() / "s");
  EXPECT_TRUE(session.problems().empty());
  EXPECT_EQ(session.samples().size(), 5U);
  for (int id = 0; id < 5; ++id)
  {
    expectSample(session, id, id);
    EXPECT_EQ(session.samples().at(id).isExcluded, id == 2);
  }
  EXPECT_EQ(session.document("calibration")->at("status"), "ok");
  EXPECT_FALSE(session.document("stylus"));
}

TEST(Session, IsARecording_WithoutTheExcluded)
{
  const TemporaryFolder folder;
  Session session = Session::create(folder.path() / "s");
  addSamples(session, 5);
  session.setExcluded(1, true);
  const Recording recording = Recording::open(folder.path() / "s");
  ASSERT_EQ(recording.frameCount(), 5);
  EXPECT_EQ(cv::norm(recording.image(4), pictureOf(4), cv::NORM_INF), 0);
  EXPECT_LT(
    (recording.transform(0, "StylusToTracker").transform.matrix() - *sampleOf(0).transforms["StylusToTracker"].matrix).norm(),
    1e-9);
  EXPECT_EQ(recording.transform(1, "StylusToTracker").status, TransformSample::Status::Missing);
  EXPECT_EQ(recording.transform(3, "MarkerToTracker").status, TransformSample::Status::Invalid);
  session.setExcluded(1, false);
  EXPECT_TRUE(Recording::open(folder.path() / "s").transform(1, "StylusToTracker").isUsable());
}

TEST(Session, LatencyOfItsSamples_IsOneAndThatOfTheRecording)
{
  const TemporaryFolder folder;
  SessionSample sample = sampleOf(0), other = sampleOf(1);
  sample.pairing["latencySec"] = -0.04;
  {
    Session session = Session::create(folder.path() / "s");
    EXPECT_FALSE(session.latencySec());
    session.addSample(pictureOf(0), sample);
    EXPECT_THROW(session.addSample(pictureOf(1), other), std::invalid_argument);
    EXPECT_EQ(session.samples().size(), 1U);
  }
  EXPECT_EQ(Session::open(folder.path() / "s").latencySec(), -0.04);
  EXPECT_EQ(Recording::open(folder.path() / "s").appliedLatencySec(), -0.04);
}

TEST(Session, DamagedParts_AreReportedAndTheRestOpened)
{
  const TemporaryFolder folder;
  {
    Session session = Session::create(folder.path() / "s");
    addSamples(session, 6);
    session.setDocument("stylus", { { "status", "ok" } });
  }
  folder.write("s/samples/0001.json", "{ cut sho");
  std::string image = test::readBytes(folder.path() / "s/frames/0002.png");
  image[image.size() / 2] = char(image[image.size() / 2] ^ 1);
  folder.write("s/frames/0002.png", image);
  std::filesystem::remove(folder.path() / "s/frames/0003.png");
  folder.write("s/documents/stylus.json", "");
  folder.write("s/tracking.igs.mha", "rubbish");
  folder.write("s/frames/.handeye-1-1.tmp", "half a picture");
  Session session = Session::open(folder.path() / "s");
  EXPECT_EQ(session.samples().size(), 3U);
  for (int id : { 0, 4, 5 })
  {
    expectSample(session, id, id);
  }
  for (const char* word : { "0001.json", "0002.png", "0003.png", "stylus.json" })
  {
    EXPECT_TRUE(hasWarning(session.problems(), word)) << word;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "s/frames/.handeye-1-1.tmp"));
  EXPECT_EQ(session.addSample(pictureOf(6), sampleOf(6)), 6);  // no number is used twice
  EXPECT_TRUE(Recording::open(folder.path() / "s").transform(6, "StylusToTracker").isUsable());
}

TEST(Session, NewerVersion_SecondProgramAndStrangeFolder_AreRefused)
{
  const TemporaryFolder folder;
  {
    const Session session = Session::create(folder.path() / "s");
    expectFileError([&] { (void)Session::open(folder.path() / "s"); }, { "another program" });
  }
  folder.write("s/session.json", "{\"schema\": \"handeye-session/9\"}");
  expectFileError([&] { (void)Session::open(folder.path() / "s"); }, { "handeye-session/9", "newer" });
  folder.write("other/photo.jpg", "x");
  expectFileError([&] { (void)Session::create(folder.path() / "other"); }, { "not empty" });
  expectFileError([&] { (void)Session::open(folder.path() / "other"); }, { "session.json" });
}

TEST(Session, KilledWhileItIsMade_IsMadeTheNextTime)
{
  const TemporaryFolder folder;
  for (const char* file : { "a/.lock", "b/.lock", "b/.handeye-1-1.tmp", "c/.lock", "c/tracking.igs.mha", "foreign/tracking.igs.mha",
         "used/.lock", "used/frames/0000.png" })
  {
    folder.write(file, "x");
  }
  std::filesystem::create_directories(folder.path() / "c/frames");
  for (const char* name : { "a", "b", "c" })
  {
    Session session = Session::openOrCreate(folder.path() / name);
    addSamples(session, 1);
  }
  expectFileError([&] { (void)Session::openOrCreate(folder.path() / "foreign"); }, { "not empty" });
  expectFileError([&] { (void)Session::openOrCreate(folder.path() / "used"); }, { "not empty" });
}

TEST(Session, FullDisk_RefusesTheSampleAndKeepsTheRest)
{
  const TemporaryFolder folder;
  Session session = Session::create(folder.path() / "s");
  addSamples(session, 2);
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, SIG_IGN);
  for (rlim_t bytes : { rlim_t(500), rlim_t(0) })  // no room for the picture; no room at all
  {
    const rlimit full = { bytes, before.rlim_max };
    setrlimit(RLIMIT_FSIZE, &full);
    EXPECT_THROW(session.addSample(pictureOf(2), sampleOf(2)), FileError);
    setrlimit(RLIMIT_FSIZE, &before);
  }
  EXPECT_EQ(session.samples().size(), 2U);
  EXPECT_EQ(session.addSample(pictureOf(2), sampleOf(2)), 2);  // work goes on
  session = Session::create(folder.path() / "t");
  const Session again = Session::open(folder.path() / "s");
  EXPECT_TRUE(again.problems().empty());
  for (int id = 0; id < 3; ++id)
  {
    expectSample(again, id, id);
  }
}

TEST(Session, DocumentNames_AreNoPaths)
{
  const TemporaryFolder folder;
  Session session = Session::create(folder.path() / "s");
  EXPECT_THROW(session.setDocument("../stylus", {}), std::invalid_argument);
  EXPECT_THROW(session.setDocument("", {}), std::invalid_argument);
  EXPECT_THROW(session.addSample(cv::Mat(), {}), std::invalid_argument);
}

TEST(Session, SampleThatCouldNotBeReadAgain_IsRefusedBeforeAnythingIsWritten)
{
  const TemporaryFolder folder;
  Session session = Session::create(folder.path() / "s");
  addSamples(session, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<SessionSample> bad(6, sampleOf(1));
  bad[0].timeSec = nan;
  (*bad[1].transforms["StylusToTracker"].matrix)(1, 3) = nan;
  bad[2].transforms["My NeedleToTracker"] = bad[2].transforms["StylusToTracker"];
  bad[3].transforms["Stylus\xff"] = bad[3].transforms["StylusToTracker"];
  bad[4].transforms["StylusToTrackerTransform"] = bad[4].transforms["StylusToTracker"];
  bad[5].detection["message"] = "\xff";
  for (std::size_t i = 0; i < bad.size(); ++i)
  {
    EXPECT_THROW(session.addSample(pictureOf(1), bad[i]), std::invalid_argument) << i;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "s/frames/0001.png")) << i;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "s/samples/0001.json")) << i;
  }
  EXPECT_EQ(session.addSample(pictureOf(1), sampleOf(1)), 1);
  session = Session::create(folder.path() / "t");
  const Session again = Session::open(folder.path() / "s");
  EXPECT_TRUE(again.problems().empty());
  EXPECT_EQ(again.samples().size(), 2U);
}

/// A program that adds samples, each with the next content, and announces each number on a pipe, until it is killed.
void addUntilKilled(const std::filesystem::path& folder, int pipeEnd)
{
  Session session = Session::openOrCreate(folder);
  for (;;)
  {
    const int next = int(session.samples().size());
    const int id = session.addSample(pictureOf(next), sampleOf(next));
    if (write(pipeEnd, &id, sizeof(id)) != sizeof(id))
    {
      _exit(1);
    }
  }
}

/// What the program announced before it was killed at some moment.
std::vector<int> announcedUntilKilled(const std::filesystem::path& folder, unsigned microseconds)
{
  int ends[2];
  std::vector<int> announced;
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    addUntilKilled(folder, ends[1]);
  }
  close(ends[1]);
  usleep(microseconds);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (int id = 0; read(ends[0], &id, sizeof(id)) == sizeof(id);)
  {
    announced.push_back(id);
  }
  close(ends[0]);
  return announced;
}

TEST(Session, KilledAtAnyMoment_HasAllThatWasAnnounced)
{
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "s";
  Random random(11);
  std::vector<int> announced;
  constexpr int LeastRounds = 40, MostRounds = 400, Enough = 10;
  int rounds = 0;
  for (; rounds < LeastRounds || (announced.size() <= Enough && rounds < MostRounds); ++rounds)
  {
    const std::vector<int> now = announcedUntilKilled(path, unsigned(random.uniform(1000, 150000)));
    announced.insert(announced.end(), now.begin(), now.end());
    ASSERT_TRUE(announced.empty() || std::filesystem::exists(path / "session.json"));
    const Session session = Session::openOrCreate(path);  // also one that was killed while it was being made
    for (const std::string& problem : session.problems())
    {
      EXPECT_NE(problem.find("not accepted"), std::string::npos) << problem;  // the picture of one that was not announced
    }
    for (int id : announced)
    {
      ASSERT_EQ(session.samples().count(id), 1U) << id;
    }
  }
  ASSERT_GT(announced.size(), std::size_t(Enough));  // some hundreds; few on a machine that has other work
  const Session session = Session::open(path);
  EXPECT_LE(
    session.samples().size(), announced.size() + std::size_t(rounds));  // at most one a round was stored and not announced any more
  int content = 0;
  for (const auto& sample : session.samples())
  {
    expectSample(session, sample.first, content++);
  }
}

}  // namespace
