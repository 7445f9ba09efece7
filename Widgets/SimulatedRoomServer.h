// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SimulatedRoom.h"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

namespace handeye
{

namespace devices
{
class OpenIGTLinkServer;
}

/// What the people in the simulated room do; they follow the page of the wizard.
enum class RoomScene
{
  Pivot,            ///< the stylus turns about its resting tip
  Spin,             ///< the stylus is spun about its shaft
  Placements,       ///< the ball is held at one place after another
  OtherPlacements,  ///< the same at other places: what a calibration is validated on
  Free,             ///< the ball moves through the view
  Rest,             ///< the ball is held still in the view
  Landmarks         ///< the landmarks of the phantom are touched one after another
};

/// A simulated operating room (see simulation::SimulatedRoom) that is served over OpenIGTLink on 127.0.0.1 by a thread of its own,
/// on a port that is free; who listens comes through the network like for any other tracker.
///
/// All functions may be called from any thread.
class SimulatedRoomServer
{
public:
  /// @param room what is there; its motion is that of the scenes
  /// @param phantomFile the mesh that the phantom looks like; read in the server's thread. Where there is none, or it cannot be read,
  /// the phantom is a few balls
  /// @throws devices::ConnectionError where no port can be had; std::invalid_argument for options that make no sense
  explicit SimulatedRoomServer(const simulation::RoomOptions& room = {}, const std::filesystem::path& phantomFile = {});
  ~SimulatedRoomServer();
  SimulatedRoomServer(const SimulatedRoomServer&) = delete;
  SimulatedRoomServer& operator=(const SimulatedRoomServer&) = delete;

  int port() const;
  const simulation::RoomOptions& options() const { return room_; }

  /// Begins the scene anew, also if it is the one that is played.
  /// @param firstPlace of the scenes with places or landmarks: where it begins
  void play(RoomScene scene, int firstPlace = 0);

private:
  void run();
  void readPhantom();
  simulation::RoomOptions optionsOf(RoomScene scene) const;

  const simulation::RoomOptions room_;
  const std::filesystem::path phantomFile_;
  std::shared_ptr<const simulation::RoomMesh> phantomMesh_;  ///< of the server's thread
  std::unique_ptr<devices::OpenIGTLinkServer> server_;
  std::mutex mutex_;
  std::condition_variable changed_;
  RoomScene scene_ = RoomScene::Free;
  int firstPlace_ = 0;
  int sceneCount_ = 0;  ///< how often play() was called
  bool isEnding_ = false;
  std::thread thread_;
};

}  // namespace handeye
