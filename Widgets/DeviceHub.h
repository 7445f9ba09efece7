// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FramePairing.h"
#include "SimulatedRoomServer.h"
#include "StreamList.h"

#include <QElapsedTimer>
#include <QHash>
#include <QObject>
#include <QString>
#include <QStringList>
#include <QTimer>
#include <QVector>

#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace handeye
{

namespace devices
{
class Source;
}
class Acquisition;

/// What the data come from, and which of the streams is what.
struct DeviceSetup
{
  enum class Kind
  {
    SimulatedRoom,  ///< served by this program, and received through the network
    Servers,        ///< OpenIGTLink servers; with `camera` also a camera of this computer
    Recording       ///< played again and again as if it were live
  };

  Kind kind = Kind::SimulatedRoom;
  QStringList servers = { QStringLiteral("127.0.0.1:18944") };  ///< HOST or HOST:PORT
  QString camera;  ///< "0" is the first; a file or URL; empty: the video comes from a server
  QString recording;
  double replaySpeed = 1;
  QString stylusToTracker = QStringLiteral("StylusToTracker");
  QString markerToTracker = QStringLiteral("MarkerToTracker");
  QString phantomToTracker = QStringLiteral("PhantomToTracker");
  QString image;          ///< empty: the first that comes
  QString rightImage;     ///< the video of a stereo rig's right eye; empty: there is none. Takes effect with a named `image` only
  double latencySec = 0;  ///< see devices::FramePairingOptions
};

/// A server's address. @return false with a sentence where it is none
bool parseServerAddress(const QString& text, std::string& host, int& port, QString& problem);

/// The devices as the wizard sees them: connects to sources, tells of their streams, and hands samples and frames on.
///
/// Belongs to the thread of the user interface; what it does with sources happens beside it, and it never waits for them.
class DeviceHub : public QObject
{
  Q_OBJECT

public:
  using SampleHandler = std::function<void(const devices::DeviceSample&)>;
  using FrameHandler = std::function<void(const devices::PairedFrame&)>;

  explicit DeviceHub(QObject* parent = nullptr);
  ~DeviceHub() override;

  /// Who takes samples and frames, in the thread of the sources; to be set before connectDevices(), and good until clearHandlers().
  void setHandlers(SampleHandler onSample, FrameHandler onFrame);
  /// The same for the frames of a stereo rig's right eye.
  void setRightFrameHandler(FrameHandler onRightFrame) { onRightFrame_ = std::move(onRightFrame); }
  void clearHandlers();

  /// The room that kind SimulatedRoom has; the default one until set.
  void setRoomOptions(const simulation::RoomOptions& room) { roomOptions_ = room; }
  const simulation::RoomOptions& roomOptions() const { return roomOptions_; }
  /// The mesh that its phantom looks like; see SimulatedRoomServer.
  void setRoomPhantom(const QString& file) { roomPhantom_ = file; }

  /// Connects to what the setup names, and leaves what was connected before. @return false with problem() where it makes no sense
  bool connectDevices(const DeviceSetup& setup);
  void disconnectDevices();
  bool isConnected() const { return acquisition_ != nullptr; }
  QString problem() const { return problem_; }

  const DeviceSetup& setup() const { return setup_; }
  /// Other names of streams, or another latency, for the sources as they are.
  /// What is to be connected to, as long as nothing is.
  void prepare(const DeviceSetup& setup);
  void setNames(const DeviceSetup& setup);
  void setLatency(double latencySec);

  /// What the simulated room does; no effect with other devices.
  void playRoom(RoomScene scene, int firstPlace = 0);
  /// Null with other devices.
  const simulation::RoomOptions* room() const { return room_ ? &room_->options() : nullptr; }

  QVector<StreamList::Stream> streams() const { return streams_; }
  /// The stream of this name; light Lost where there is none.
  StreamList::Stream stream(const QString& name) const;
  /// The video that is taken.
  QString imageName() const;
  /// What the sources say, a line each.
  QString status() const { return status_; }
  /// Why stylus, marker or video cannot be worked with, a sentence; empty if they arrive.
  QString missing(bool needsVideo) const;

signals:
  void connectionChanged();
  /// Four times a second while something is connected.
  void streamsChanged();

private:
  void poll();
  void release(std::shared_ptr<void> part);
  QString wrongChoice() const;
  devices::FramePairingOptions pairingOptions() const;
  devices::FramePairingOptions rightPairingOptions() const;
  std::vector<std::shared_ptr<devices::Source>> makeSources();

  DeviceSetup setup_;
  simulation::RoomOptions roomOptions_;
  QString roomPhantom_;
  SampleHandler onSample_;
  FrameHandler onFrame_, onRightFrame_;
  std::shared_ptr<SimulatedRoomServer> room_;
  std::shared_ptr<Acquisition> acquisition_;
  std::vector<std::thread> releasing_;
  QString problem_, status_;
  QVector<StreamList::Stream> streams_;
  struct Rate
  {
    quint64 count = 0;
    double sinceSec = 0, hz = 0;
  };
  QHash<QString, Rate> rates_;
  QTimer pollTimer_;
};

}  // namespace handeye
