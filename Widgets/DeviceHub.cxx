// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DeviceHub.h"

#include "Acquisition.h"
#include "OpenIGTLinkClient.h"
#include "ReplaySource.h"
#include "Socket.h"
#include "VideoSource.h"

#include <QFileInfo>

#include <algorithm>
#include <utility>

namespace handeye
{

namespace
{

constexpr int PollMs = 250;
constexpr double StaleSec = 0.6;

QString firstUpper(QString text)
{
  return text.isEmpty() ? text : text.replace(0, 1, text.at(0).toUpper());
}

}  // namespace

bool parseServerAddress(const QString& text, std::string& host, int& port, QString& problem)
{
  const QString address = text.trimmed();
  const int colon = address.lastIndexOf(QLatin1Char(':'));
  bool isNumber = true;
  host = address.left(colon < 0 ? address.size() : colon).toStdString();
  port = colon < 0 ? 18944 : address.mid(colon + 1).toInt(&isNumber);
  if (host.empty() || !isNumber || port < 1 || port > 65535)
  {
    problem = DeviceHub::tr("'%1' is not HOST or HOST:PORT with a port from 1 to 65535").arg(text);
    return false;
  }
  return true;
}

DeviceHub::DeviceHub(QObject* parent)
  : QObject(parent)
{
  pollTimer_.setInterval(PollMs);
  connect(&pollTimer_, &QTimer::timeout, this, &DeviceHub::poll);
}

DeviceHub::~DeviceHub()
{
  clearHandlers();
  acquisition_.reset();
  room_.reset();
  for (std::thread& thread : releasing_)
  {
    thread.join();
  }
}

void DeviceHub::setHandlers(SampleHandler onSample, FrameHandler onFrame)
{
  onSample_ = std::move(onSample);
  onFrame_ = std::move(onFrame);
}

void DeviceHub::clearHandlers()
{
  if (acquisition_)
  {
    acquisition_->disconnect();
  }
  onSample_ = nullptr;
  onFrame_ = nullptr;
  onRightFrame_ = nullptr;
}

/// Ends a part beside the window: a camera may take seconds to let go.
void DeviceHub::release(std::shared_ptr<void> part)
{
  if (part)
  {
    releasing_.emplace_back([held = std::move(part)]() mutable { held.reset(); });
  }
}

devices::FramePairingOptions DeviceHub::pairingOptions() const
{
  devices::FramePairingOptions options;
  options.imageName = setup_.image.toStdString();
  options.latencySec = setup_.latencySec;
  return options;
}

/// One eye's video is not both eyes', and without a name the left one might be either.
devices::FramePairingOptions DeviceHub::rightPairingOptions() const
{
  devices::FramePairingOptions options = pairingOptions();
  const bool isAnother = !setup_.image.isEmpty() && setup_.rightImage != setup_.image;
  options.imageName = isAnother ? setup_.rightImage.toStdString() : std::string();
  return options;
}

std::vector<std::shared_ptr<devices::Source>> DeviceHub::makeSources()
{
  std::vector<std::shared_ptr<devices::Source>> sources;
  const auto addServer = [&](const std::string& host, int port)
  {
    devices::OpenIGTLinkClientOptions options;
    options.host = host;
    options.port = port;
    sources.push_back(std::make_shared<devices::OpenIGTLinkClient>(options));
  };
  if (setup_.kind == DeviceSetup::Kind::SimulatedRoom)
  {
    room_ = std::make_shared<SimulatedRoomServer>(roomOptions_, roomPhantom_.toStdString());
    addServer("127.0.0.1", room_->port());
    return sources;
  }
  if (setup_.kind == DeviceSetup::Kind::Recording)
  {
    devices::ReplayOptions options;
    options.recording = setup_.recording.toStdString();
    options.speed = setup_.replaySpeed;
    options.isLooping = true;
    sources.push_back(std::make_shared<devices::ReplaySource>(options));
    return sources;
  }
  for (const QString& server : setup_.servers)
  {
    std::string host;
    int port = 0;
    if (parseServerAddress(server, host, port, problem_))
    {
      addServer(host, port);
    }
  }
  if (!setup_.camera.isEmpty())
  {
    devices::VideoSourceOptions options;
    options.device = setup_.camera.toStdString();
    sources.push_back(std::make_shared<devices::VideoSource>(options));
  }
  return sources;
}

bool DeviceHub::connectDevices(const DeviceSetup& setup)
{
  disconnectDevices();
  setup_ = setup;
  problem_.clear();
  if (setup.kind == DeviceSetup::Kind::Recording && !QFileInfo::exists(setup.recording))
  {
    problem_ = setup.recording.isEmpty()
      ? tr("Choose a recording: a sequence metafile (.igs.mha), or a folder with frames and tracking.")
      : tr("There is no recording '%1'.").arg(setup.recording);
  }
  if (setup.kind == DeviceSetup::Kind::Servers && setup.servers.isEmpty() && setup.camera.isEmpty())
  {
    problem_ = tr("Name at least one OpenIGTLink server (HOST:PORT).");
  }
  std::vector<std::shared_ptr<devices::Source>> sources;
  try
  {
    sources = problem_.isEmpty() ? makeSources() : sources;
  }
  catch (const std::exception& error)
  {
    problem_ = firstUpper(QString::fromUtf8(error.what()));
  }
  if (!problem_.isEmpty())
  {
    room_.reset();
    emit connectionChanged();
    return false;
  }
  acquisition_ = std::make_shared<Acquisition>(
    std::move(sources), pairingOptions(), onSample_ ? onSample_ : [](const devices::DeviceSample&) {},
    onFrame_ ? onFrame_ : [](const devices::PairedFrame&) {});
  acquisition_->setRightPairing(rightPairingOptions(), onRightFrame_);
  pollTimer_.start();
  emit connectionChanged();
  poll();
  return true;
}

void DeviceHub::disconnectDevices()
{
  pollTimer_.stop();
  if (acquisition_)
  {
    acquisition_->disconnect();
  }
  release(std::exchange(acquisition_, nullptr));
  release(std::exchange(room_, nullptr));
  streams_.clear();
  rates_.clear();
  status_.clear();
  emit connectionChanged();
  emit streamsChanged();
}

void DeviceHub::prepare(const DeviceSetup& setup)
{
  if (!isConnected())
  {
    setup_ = setup;
    emit streamsChanged();
  }
}

void DeviceHub::setNames(const DeviceSetup& setup)
{
  setup_.stylusToTracker = setup.stylusToTracker;
  setup_.markerToTracker = setup.markerToTracker;
  setup_.phantomToTracker = setup.phantomToTracker;
  const bool isPairingOther =
    setup_.image != setup.image || setup_.rightImage != setup.rightImage || setup_.latencySec != setup.latencySec;
  setup_.image = setup.image;
  setup_.rightImage = setup.rightImage;
  setup_.latencySec = setup.latencySec;
  if (acquisition_ && isPairingOther)
  {
    acquisition_->setPairing(pairingOptions());
    acquisition_->setRightPairing(rightPairingOptions(), onRightFrame_);
  }
  emit streamsChanged();
}

void DeviceHub::setLatency(double latencySec)
{
  DeviceSetup setup = setup_;
  setup.latencySec = latencySec;
  setNames(setup);
}

void DeviceHub::playRoom(RoomScene scene, int firstPlace)
{
  if (room_)
  {
    room_->play(scene, firstPlace);
  }
}

StreamList::Stream DeviceHub::stream(const QString& name) const
{
  const auto found = std::find_if(streams_.begin(), streams_.end(), [&](const auto& stream) { return stream.name == name; });
  StreamList::Stream none;
  none.name = name;
  return found == streams_.end() ? none : *found;
}

QString DeviceHub::imageName() const
{
  if (!setup_.image.isEmpty())
  {
    return setup_.image;
  }
  const auto found =
    std::find_if(streams_.begin(), streams_.end(), [](const auto& stream) { return stream.type == StreamList::Type::Video; });
  return found == streams_.end() ? QString() : found->name;
}

/// Why the names cannot be what they are said to be: two tools are never one stream.
QString DeviceHub::wrongChoice() const
{
  struct Tool
  {
    QString what, name;
  };
  const Tool stylus{ tr("the stylus"), setup_.stylusToTracker }, marker{ tr("the camera's marker"), setup_.markerToTracker },
    phantom{ tr("the phantom"), setup_.phantomToTracker };
  for (const Tool& needed : { stylus, marker })
  {
    if (needed.name.isEmpty())
    {
      return tr("Choose the stream of %1.").arg(needed.what);
    }
  }
  for (const auto& [one, other] : { std::pair(stylus, marker), std::pair(stylus, phantom), std::pair(marker, phantom) })
  {
    if (one.name == other.name)
    {
      return tr("'%1' is chosen for %2 and for %3: choose the stream of each.").arg(one.name, one.what, other.what);
    }
  }
  if (!setup_.rightImage.isEmpty() && setup_.rightImage == imageName())
  {
    return tr("The video '%1' is chosen for both eyes.").arg(setup_.rightImage);
  }
  return {};
}

QString DeviceHub::missing(bool needsVideo) const
{
  if (!acquisition_)
  {
    return problem_.isEmpty() ? tr("Nothing is connected. Choose where the data come from and press Connect.") : problem_;
  }
  if (const QString choice = wrongChoice(); !choice.isEmpty())
  {
    return choice;
  }
  for (const auto& [name, what] :
    { std::pair(setup_.stylusToTracker, tr("stylus")), std::pair(setup_.markerToTracker, tr("camera's marker")) })
  {
    if (stream(name).light == StreamList::Light::Lost)
    {
      return tr("The %1 does not arrive: there is no stream '%2'. Choose its stream in the list, or check the source. %3")
        .arg(what, name, status_)
        .trimmed();
    }
  }
  if (needsVideo && (imageName().isEmpty() || stream(imageName()).light == StreamList::Light::Lost))
  {
    return tr("No video arrives. %1").arg(status_).trimmed();
  }
  return {};
}

void DeviceHub::poll()
{
  const double nowSec = devices::systemTimeSec();
  streams_.clear();
  status_.clear();
  for (const Acquisition::NamedStatus& source : acquisition_->status())
  {
    const QString sourceName = QString::fromStdString(source.source);
    const bool isThere =
      source.status.state == devices::SourceState::Streaming || source.status.state == devices::SourceState::Finished;
    if (!isThere || source.status.state == devices::SourceState::Finished || source.status.streams.empty())
    {
      const QString message = QString::fromStdString(source.status.message);
      const bool isNamed = message.contains(sourceName);  // by the source itself
      status_ += (status_.isEmpty() ? QString() : QStringLiteral(" ")) + (isNamed ? QString() : sourceName + QStringLiteral(": ")) +
        message + QLatin1Char('.');
    }
    for (const devices::StreamInfo& info : source.status.streams)
    {
      StreamList::Stream stream;
      stream.name = QString::fromStdString(info.name);
      stream.source = sourceName;
      stream.type = info.type == "pose" ? StreamList::Type::Transform
        : info.type == "image"          ? StreamList::Type::Video
                                        : StreamList::Type::Other;
      Rate& rate = rates_[stream.name];
      if (nowSec - rate.sinceSec > 1)
      {
        rate.hz = rate.sinceSec > 0 ? double(info.count - rate.count) / (nowSec - rate.sinceSec) : 0;
        rate.count = info.count;
        rate.sinceSec = nowSec;
      }
      stream.rateHz = rate.hz;
      stream.ageSec = std::max(0.0, nowSec - info.lastReceivedSec);
      const bool isLate = stream.ageSec > StaleSec && stream.ageSec > 4 / std::max(rate.hz, 1.0);
      stream.light = !isThere     ? StreamList::Light::Lost
        : isLate || !info.isValid ? StreamList::Light::Stale
                                  : StreamList::Light::Live;
      stream.message = !isThere ? QString::fromStdString(source.status.message)
        : isLate                ? tr("nothing new since %1 s").arg(stream.ageSec, 0, 'f', 1)
        : !info.isValid         ? tr("not seen by the tracker")
                                : QString();
      streams_.push_back(stream);
    }
  }
  emit streamsChanged();
}

}  // namespace handeye
