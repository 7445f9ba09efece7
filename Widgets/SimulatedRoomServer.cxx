// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimulatedRoomServer.h"

#include "OpenIGTLinkMessage.h"
#include "OpenIGTLinkServer.h"
#include "RoomPhantom.h"

#include <chrono>
#include <map>

namespace handeye
{

namespace
{

constexpr double PosesPerSec = 60, FramesPerSec = 25;
constexpr const char* ImageName = "Video";

void sendPoses(devices::OpenIGTLinkServer& server, const simulation::SimulatedRoom& room, double roomSec, double timeSec)
{
  for (const simulation::RoomPose& pose : room.track(roomSec))
  {
    server.send(devices::packTransform(
      pose.name, timeSec, pose.transform.matrix(), { { "TransformStatus", pose.isValid ? "OK" : "INVALID" } }));
  }
}

}  // namespace

SimulatedRoomServer::SimulatedRoomServer(const simulation::RoomOptions& room, const std::filesystem::path& phantomFile)
  : room_(room)
  , phantomFile_(phantomFile)
{
  room_.check();
  devices::OpenIGTLinkServerOptions options;
  options.port = 0;
  server_ = std::make_unique<devices::OpenIGTLinkServer>(options);
  thread_ = std::thread([this] { run(); });
}

SimulatedRoomServer::~SimulatedRoomServer()
{
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

int SimulatedRoomServer::port() const
{
  return server_->port();
}

void SimulatedRoomServer::play(RoomScene scene, int firstPlace)
{
  {
    const std::lock_guard lock(mutex_);
    scene_ = scene;
    firstPlace_ = firstPlace;
    ++sceneCount_;
  }
  changed_.notify_all();
}

simulation::RoomOptions SimulatedRoomServer::optionsOf(RoomScene scene) const
{
  simulation::RoomOptions options = room_;
  options.phantomMesh = phantomMesh_ ? phantomMesh_ : options.phantomMesh;
  switch (scene)
  {
    case RoomScene::Pivot:
      options.motion = simulation::RoomMotion::Pivot;
      break;
    case RoomScene::Spin:
      options.motion = simulation::RoomMotion::Spin;
      break;
    case RoomScene::OtherPlacements:
      options.seed += 17;
      options.placeCount = 10;
      options.motion = simulation::RoomMotion::Placements;
      break;
    case RoomScene::Placements:
      options.motion = simulation::RoomMotion::Placements;
      break;
    case RoomScene::Landmarks:
      options.motion = room_.landmarks_Model.empty() ? simulation::RoomMotion::Free : simulation::RoomMotion::Landmarks;
      options.holdSec = 3600;  // until it is taken: the next landmark is begun with then
      break;
    case RoomScene::Rest:
      options.motion = simulation::RoomMotion::Rest;
      break;
    case RoomScene::Free:
      options.motion = simulation::RoomMotion::Free;
      break;
  }
  return options;
}

void SimulatedRoomServer::readPhantom()
{
  if (phantomFile_.empty())
  {
    return;
  }
  try
  {
    phantomMesh_ = readRoomMesh(phantomFile_);
  }
  catch (const std::exception&)
  {
    // The page Overlay, which needs the file, says what is wrong with it.
  }
}

/// Poses and pictures at their times. A computer that is too slow for the pictures sends fewer of them, never later ones.
void SimulatedRoomServer::run()
{
  readPhantom();
  std::map<RoomScene, std::unique_ptr<simulation::SimulatedRoom>> rooms;
  RoomScene scene = RoomScene::Free;
  int sceneCount = -1;
  double sceneBeginSec = 0, skippedSec = 0;
  long poseIndex = 0, frameIndex = 0;
  std::unique_lock lock(mutex_);
  while (!isEnding_)
  {
    if (sceneCount != sceneCount_)
    {
      scene = scene_;
      sceneCount = sceneCount_;
      const simulation::RoomOptions options = optionsOf(scene);
      skippedSec = firstPlace_ * (options.holdSec + options.moveSec);
      lock.unlock();
      std::unique_ptr<simulation::SimulatedRoom>& room = rooms[scene];
      room = room ? std::move(room) : std::make_unique<simulation::SimulatedRoom>(options);
      sceneBeginSec = devices::systemTimeSec();
      poseIndex = frameIndex = 0;
      lock.lock();
      continue;
    }
    const double nextPoseSec = double(poseIndex) / PosesPerSec, nextFrameSec = double(frameIndex) / FramesPerSec;
    const double waitSec = sceneBeginSec + std::min(nextPoseSec, nextFrameSec) - devices::systemTimeSec();
    if (waitSec > 0)
    {
      changed_.wait_for(lock, std::chrono::duration<double>(std::min(waitSec, 0.1)));
      continue;
    }
    lock.unlock();
    if (nextPoseSec <= nextFrameSec)
    {
      sendPoses(*server_, *rooms[scene], nextPoseSec + skippedSec, sceneBeginSec + nextPoseSec);
      ++poseIndex;
    }
    else
    {
      if (server_->clientCount() > 0)
      {
        server_->send(
          devices::packImage(ImageName, sceneBeginSec + nextFrameSec, rooms[scene]->picture(nextFrameSec + skippedSec)));
      }
      const double behindSec = devices::systemTimeSec() - sceneBeginSec - nextFrameSec;
      frameIndex += 1 + std::max(0L, long(behindSec * FramesPerSec) - 1);
    }
    lock.lock();
  }
}

}  // namespace handeye
