// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The client against servers that are good, gone, slow, wrong and hostile. All on loopback, on ports that are free.
#include "OpenIGTLinkClient.h"
#include "DeviceTestSupport.h"
#include "OpenIGTLinkServer.h"

#include <gtest/gtest.h>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <fstream>
#include <tuple>

namespace
{

using namespace handeye::devices;
using namespace handeye::devices::test;

OpenIGTLinkClientOptions clientOf(int port)
{
  OpenIGTLinkClientOptions options;
  options.port = port;
  return options;
}

/// For the tests that stop in the middle of a message; in the others a sender may be kept from its work for as long as it takes.
OpenIGTLinkClientOptions impatientClientOf(int port)
{
  OpenIGTLinkClientOptions options = clientOf(port);
  options.stallTimeoutSec = 0.3;
  return options;
}

OpenIGTLinkServerOptions anyPort()
{
  OpenIGTLinkServerOptions options;
  options.port = 0;
  return options;
}

Bytes pose(double x)
{
  return packTransform("StylusToTracker", 100 + x, shiftedBy(x));
}

std::size_t residentBytes()
{
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

/// After whatever happened before, a good pose must arrive.
void expectGoodPoseArrives(RawServer& server, OpenIGTLinkClient& client)
{
  ASSERT_TRUE(server.acceptClient()) << client.status().message;
  server.send(pose(42));
  const std::optional<DeviceSample> sample = popNamed(client, "StylusToTracker");
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->pose()->transform.translation().x(), 42);
}

TEST(OpenIGTLinkClient, Server_DeliversToSeveralClientsInOrder)
{
  OpenIGTLinkServer server(anyPort());
  OpenIGTLinkClient first(clientOf(server.port())), second(clientOf(server.port()));
  first.start();
  second.start();
  ASSERT_TRUE(waitUntil([&] { return server.clientCount() == 2; }));
  for (int i = 0; i < 200; ++i)
  {
    server.send(pose(i));
  }
  for (OpenIGTLinkClient* client : { &first, &second })
  {
    for (int i = 0; i < 200; ++i)
    {
      const std::optional<DeviceSample> sample = client->pop(20);
      ASSERT_TRUE(sample);
      ASSERT_EQ(sample->pose()->received(0, 3), i);
      ASSERT_NEAR(sample->timeSec, 100 + i, 1e-6);
    }
  }
  EXPECT_EQ(server.droppedCount(), 0U);
}

TEST(OpenIGTLinkClient, ListsWhatIsStreamed)
{
  OpenIGTLinkServer server(anyPort());
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.waitForClient(20));
  server.send(packString("Phase", 1, "pivot"));
  server.send(packImage("Video", 1, cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(3))));
  server.send(packTransform("StylusToTracker", 1, shiftedBy(1), { { "TransformStatus", "INVALID" } }));
  ASSERT_TRUE(waitUntil([&] { return client.status().streams.size() == 3; }));
  const std::vector<StreamInfo> streams = client.status().streams;
  EXPECT_EQ(streams[0].name, "Phase");
  EXPECT_EQ(streams[1].name, "StylusToTracker");
  EXPECT_FALSE(streams[1].isValid);
  EXPECT_EQ(streams[2].type, "image");
}

TEST(OpenIGTLinkClient, NoServer_SaysSoAndStopsAtOnce)
{
  int freePort = 0;
  {
    freePort = RawServer().port();
  }
  OpenIGTLinkClient client(clientOf(freePort));
  client.start();
  ASSERT_TRUE(waitUntil([&] { return client.status().lastProblem.find("does not answer") != std::string::npos; }));
  EXPECT_EQ(client.status().state, SourceState::Connecting);
  const std::string problem = client.status().lastProblem;
  EXPECT_EQ(problem.rfind(client.name() + ": does not answer (", 0), 0U) << problem << ": its name, once";
  client.stop();
  EXPECT_EQ(client.status().state, SourceState::Stopped);
}

TEST(OpenIGTLinkClient, ServerThatVanishes_IsFoundAgain)
{
  auto server = std::make_unique<OpenIGTLinkServer>(anyPort());
  const int port = server->port();
  OpenIGTLinkClient client(clientOf(port));
  client.start();
  ASSERT_TRUE(server->waitForClient(20));
  server->send(pose(1));
  ASSERT_TRUE(popNamed(client, "StylusToTracker"));
  server.reset();
  ASSERT_TRUE(waitUntil([&] { return client.status().state == SourceState::Connecting; }));
  EXPECT_NE(client.status().lastProblem.find("trying again"), std::string::npos);
  OpenIGTLinkServerOptions same = anyPort();
  same.port = port;
  server = std::make_unique<OpenIGTLinkServer>(same);
  ASSERT_TRUE(server->waitForClient(20));
  server->send(pose(2));
  const std::optional<DeviceSample> sample = popNamed(client, "StylusToTracker");
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->pose()->received(0, 3), 2);
  EXPECT_EQ(client.status().connectionCount, 2U);
}

TEST(OpenIGTLinkClient, Garbage_EndsTheConnectionAndTheNextIsGood)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  server.send(Bytes(4000, 0xA7));
  ASSERT_TRUE(waitUntil([&] { return client.status().refusedCount > 0; }));
  expectGoodPoseArrives(server, client);
}

TEST(OpenIGTLinkClient, HalfAHeader_EndsTheConnectionAndTheNextIsGood)
{
  RawServer server;
  OpenIGTLinkClient client(impatientClientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  const Bytes message = pose(1);
  server.send(Bytes(message.begin(), message.begin() + 29));
  ASSERT_TRUE(waitUntil([&] { return client.status().lastProblem.find("middle of a message's header") != std::string::npos; }));
  expectGoodPoseArrives(server, client);
}

TEST(OpenIGTLinkClient, HalfABody_EndsTheConnectionAndTheNextIsGood)
{
  RawServer server;
  OpenIGTLinkClient client(impatientClientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  const Bytes message = pose(1);
  server.send(Bytes(message.begin(), message.end() - 5));
  ASSERT_TRUE(waitUntil([&] { return client.status().lastProblem.find("middle of a message") != std::string::npos; }));
  expectGoodPoseArrives(server, client);
}

TEST(OpenIGTLinkClient, SixteenGigabytes_AreNotTaken)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  Bytes message = pose(1);
  for (int i = 0; i < 8; ++i)
  {
    message[std::size_t(42 + i)] = i == 3 ? 4 : 0;  // the body's size: 4 << 32
  }
  const std::size_t before = residentBytes();
  server.send(message);
  ASSERT_TRUE(waitUntil([&] { return client.status().refusedCount == 1; }));
  EXPECT_LT(residentBytes(), before + (std::size_t(32) << 20));
  expectGoodPoseArrives(server, client);
}

TEST(OpenIGTLinkClient, AnnouncedBodyThatNeverComes_TakesLittleMemory)
{
  RawServer server;
  OpenIGTLinkClient client(impatientClientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  Bytes message = pose(1);
  message[46] = 7;  // 7 << 24 bytes: allowed, but only 60 follow
  const std::size_t before = residentBytes();
  server.send(message);
  ASSERT_TRUE(waitUntil([&] { return client.status().lastProblem.find("middle of a message") != std::string::npos; }));
  EXPECT_LT(residentBytes(), before + (std::size_t(32) << 20));
  expectGoodPoseArrives(server, client);
}

TEST(OpenIGTLinkClient, DamagedMessage_IsLeftOutAndTheNextTaken)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  Bytes damaged = pose(1);
  damaged.back() ^= 1;
  server.send(damaged);
  server.send(pose(2));
  const std::optional<DeviceSample> sample = popNamed(client, "StylusToTracker");
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->pose()->received(0, 3), 2);
  EXPECT_EQ(client.status().refusedCount, 1U);
  EXPECT_EQ(client.status().connectionCount, 1U);
}

TEST(OpenIGTLinkClient, SenderWithoutTimes_HasThoseOfArrivalAndAWarning)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  const double beginSec = systemTimeSec();
  client.start();
  ASSERT_TRUE(server.acceptClient());
  server.send(packTransform("StylusToTracker", 0, shiftedBy(1)));
  server.send(packTransform("StylusToTracker", 0, shiftedBy(2)));
  const std::optional<DeviceSample> first = popNamed(client, "StylusToTracker");
  const std::optional<DeviceSample> second = popNamed(client, "StylusToTracker");
  ASSERT_TRUE(first && second);
  EXPECT_GE(first->timeSec, beginSec);
  EXPECT_LE(first->timeSec, second->timeSec);
  EXPECT_LE(second->timeSec, second->receivedSec);
  EXPECT_NE(client.status().message.find("'StylusToTracker' has no time"), std::string::npos) << client.status().message;
}

/// Without them, a machine that lost its power is noticed after two hours.
TEST(OpenIGTLinkClient, Connections_AskWhetherTheOtherSideIsThere)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  int connections = 0;
  for (int descriptor = 0; descriptor < 256; ++descriptor)
  {
    sockaddr_in peer = {};
    socklen_t size = sizeof(peer);
    if (getpeername(descriptor, reinterpret_cast<sockaddr*>(&peer), &size) != 0 || peer.sin_family != AF_INET)
    {
      continue;
    }
    ++connections;
    int isAlive = 0, idleSec = 0, intervalSec = 0, probes = 0;
    for (const auto& [level, option, value] :
      { std::make_tuple(SOL_SOCKET, SO_KEEPALIVE, &isAlive), std::make_tuple(int(IPPROTO_TCP), TCP_KEEPIDLE, &idleSec),
        std::make_tuple(int(IPPROTO_TCP), TCP_KEEPINTVL, &intervalSec), std::make_tuple(int(IPPROTO_TCP), TCP_KEEPCNT, &probes) })
    {
      socklen_t bytes = sizeof(*value);
      ASSERT_EQ(getsockopt(descriptor, level, option, value, &bytes), 0);
    }
    EXPECT_NE(isAlive, 0);
    EXPECT_LE(idleSec + intervalSec * probes, 10);
  }
  EXPECT_EQ(connections, 2) << "the client's end and the server's";
}

TEST(OpenIGTLinkClient, OnlyDamagedMessages_EndTheConnection)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  Bytes damaged = pose(1);
  damaged.back() ^= 1;
  for (int i = 0; i < 10; ++i)
  {
    server.send(damaged);
  }
  ASSERT_TRUE(waitUntil([&] { return client.status().lastProblem.find("in a row") != std::string::npos; }));
  expectGoodPoseArrives(server, client);
}

TEST(OpenIGTLinkClient, UnknownTypesAndNotANumber_DoNotDisturb)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  server.send(packMessage("POLYDATA", "Mesh", 1, Bytes(1000, 1)));
  Eigen::Matrix4d bad = shiftedBy(1);
  bad(0, 3) = std::numeric_limits<double>::quiet_NaN();
  server.send(packTransform("StylusToTracker", 1, bad));
  server.send(pose(3));
  const std::optional<DeviceSample> first = popNamed(client, "StylusToTracker");
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->pose()->isValid);
  const std::optional<DeviceSample> second = popNamed(client, "StylusToTracker");
  ASSERT_TRUE(second);
  EXPECT_TRUE(second->pose()->isValid);
  EXPECT_EQ(client.status().refusedCount, 0U);
}

TEST(OpenIGTLinkClient, Flood_IsBoundedAndCounted)
{
  RawServer server;
  OpenIGTLinkClientOptions options = clientOf(server.port());
  options.buffer.maximumCount = 100;
  OpenIGTLinkClient client(options);
  client.start();
  ASSERT_TRUE(server.acceptClient());
  constexpr int Count = 20000;
  Bytes many;
  for (int i = 0; i < Count; ++i)
  {
    const Bytes one = pose(i);
    many.insert(many.end(), one.begin(), one.end());
  }
  server.send(many);
  ASSERT_TRUE(waitUntil([&] { return client.buffer().pushedCount() == Count; }));
  EXPECT_EQ(client.buffer().size(), 100U);
  EXPECT_EQ(client.status().droppedCount, std::uint64_t(Count - 100));
  const std::optional<DeviceSample> oldest = client.pop(1);
  ASSERT_TRUE(oldest);
  EXPECT_EQ(oldest->pose()->received(0, 3), Count - 100);  // the newest stay
}

TEST(OpenIGTLinkClient, NamesWithoutEnd_AreBounded)
{
  RawServer server;
  OpenIGTLinkClient client(clientOf(server.port()));
  client.start();
  ASSERT_TRUE(server.acceptClient());
  for (int i = 0; i < 1500; ++i)
  {
    server.send(packTransform("T" + std::to_string(i), 1, shiftedBy(i)));
  }
  ASSERT_TRUE(waitUntil([&] { return client.buffer().pushedCount() == 1500; }));
  EXPECT_EQ(client.status().streams.size(), 1000U);
}

TEST(OpenIGTLinkServer, IsOnLoopbackUnlessAsked)
{
  EXPECT_EQ(OpenIGTLinkServerOptions().address, "127.0.0.1");
  const OpenIGTLinkServer server(anyPort());
  std::ifstream table("/proc/net/tcp");
  char needle[32];
  std::snprintf(needle, sizeof(needle), ":%04X", unsigned(server.port()));
  int found = 0;
  for (std::string line; std::getline(table, line);)
  {
    const std::size_t at = line.find(needle);
    const bool isListening = line.find(" 0A ") != std::string::npos;
    if (at != std::string::npos && at < 20 && isListening)
    {
      ++found;
      EXPECT_NE(line.find("0100007F" + std::string(needle)), std::string::npos) << line;
    }
  }
  EXPECT_EQ(found, 1);
}

TEST(OpenIGTLinkServer, PortThatIsTaken_IsRefusedWithASentence)
{
  const RawServer taken;
  OpenIGTLinkServerOptions options;
  options.port = taken.port();
  try
  {
    const OpenIGTLinkServer server(options);
    FAIL();
  }
  catch (const ConnectionError& error)
  {
    EXPECT_NE(std::string(error.what()).find(std::to_string(taken.port())), std::string::npos);
  }
}

TEST(OpenIGTLinkServer, ClientThatTakesNothing_LosesTheOldestOfItsQueue)
{
  OpenIGTLinkServerOptions options = anyPort();
  options.maximumQueueBytes = std::size_t(4) << 20;
  OpenIGTLinkServer server(options);
  const WakeUp wakeUp;
  const Socket silent = Socket::connectTo("127.0.0.1", server.port(), 20, wakeUp);
  ASSERT_TRUE(server.waitForClient(20));
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar::all(1));
  for (int i = 0; i < 100; ++i)
  {
    server.send(packImage("Video", i, image));
  }
  EXPECT_GT(server.droppedCount(), 0U);
}

}  // namespace
