// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SourceOptions.h"

#include "CommonOptions.h"
#include "OpenIGTLinkClient.h"
#include "Recording.h"
#include "ReplaySource.h"
#include "VideoSource.h"

#include <algorithm>

namespace handeye::cli
{

namespace
{

devices::OpenIGTLinkClientOptions parseServer(const std::string& text)
{
  devices::OpenIGTLinkClientOptions options;
  const std::size_t colon = text.rfind(':');
  options.host = text.substr(0, colon);
  if (colon != std::string::npos && !CLI::detail::lexical_cast(text.substr(colon + 1), options.port))
  {
    options.port = 0;
  }
  try
  {
    options.check();
  }
  catch (const std::invalid_argument&)
  {
    throw CLI::ValidationError("--server", "'" + text + "' is not HOST or HOST:PORT with a port from 1 to 65535");
  }
  return options;
}

}  // namespace

void LiveSources::addTo(CLI::App& command)
{
  addSourcesTo(command, true);
  addLatencyOption(command, pairing.latencySec);
}

void LiveSources::addPicturesTo(CLI::App& command)
{
  needsTracking_ = false;
  addSourcesTo(command, false);
}

void LiveSources::addSourcesTo(CLI::App& command, bool isRequired)
{
  CLI::Option_group* from = command.add_option_group("sources");
  from->add_option("--server", servers_, "OpenIGTLink server (PLUS, 3D Slicer, `handeye simulate`); may be given several times")
    ->type_name("HOST[:PORT]")
    ->expected(1)
    ->take_all();
  from->add_option("--video", video_, "Camera (0 is the first), file, image sequence (frames/%04d.jpg) or URL")
    ->type_name("DEVICE");
  from->add_option("--replay", replay_, "Recording that is played as if it were live")->type_name("RECORDING");
  from->require_option(isRequired ? 1 : 0, 0);
  command.add_option("--speed", speed_, "Of the replay; 0 for as fast as possible")->check(CLI::NonNegativeNumber);
  command.add_option("--image", pairing.imageName, "Which video, where there are several; the first that comes otherwise")
    ->type_name("NAME");
  command.add_option("--wait", waitSec_, "How long a server or camera may be silent before this ends, s")
    ->capture_default_str()
    ->type_name("SEC");
}

void LiveSources::add(std::unique_ptr<devices::Source> source, bool isLive)
{
  Entry entry;
  entry.source = std::move(source);
  entry.isLive = isLive;
  entries_.push_back(std::move(entry));
}

void LiveSources::start()
{
  for (const std::string& server : servers_)
  {
    add(std::make_unique<devices::OpenIGTLinkClient>(parseServer(server)), true);
  }
  if (!video_.empty())
  {
    devices::VideoSourceOptions options;
    options.device = video_;
    devices::requireReadable(options);
    // Who names a camera wants its pictures, also beside a server that has some.
    pairing.imageName = pairing.imageName.empty() ? options.name : pairing.imageName;
    add(std::make_unique<devices::VideoSource>(options), !devices::isVideoFile(options.device));
  }
  if (!replay_.empty())
  {
    devices::ReplayOptions options;
    options.recording = replay_;
    options.speed = speed_;
    options.needsTracking = needsTracking_;
    // One that cannot be read is said now.
    static_cast<void>(needsTracking_ ? io::Recording::open(options.recording) : io::Recording::openImages(options.recording));
    add(std::make_unique<devices::ReplaySource>(options), false);
  }
  for (Entry& entry : entries_)
  {
    entry.newestSec = devices::systemTimeSec();
    entry.source->start();
  }
}

void LiveSources::stop()
{
  for (const Entry& entry : entries_)
  {
    entry.source->stop();
  }
}

std::optional<devices::DeviceSample> LiveSources::pop(double timeoutSec)
{
  const double each = entries_.size() > 1 ? 0.002 : timeoutSec;
  const double endSec = devices::systemTimeSec() + timeoutSec;
  do
  {
    for (std::size_t i = 0; i < entries_.size(); ++i)
    {
      next_ = (next_ + 1) % entries_.size();
      Entry& entry = entries_[next_];
      std::optional<devices::DeviceSample> sample = entry.source->pop(each);
      if (!sample)
      {
        continue;
      }
      entry.hasSample = true;
      entry.newestSec = devices::systemTimeSec();
      if (entries_.size() > 1)
      {
        sample->timeSec = entry.offset.toLocalSec(sample->timeSec, sample->receivedSec);
      }
      firstSec_ = hasSample_ ? firstSec_ : sample->timeSec;
      newestSec_ = std::max(newestSec_, sample->timeSec);
      hasSample_ = true;
      return sample;
    }
  } while (devices::systemTimeSec() < endSec);
  return std::nullopt;
}

void LiveSources::warnOfOtherImages(const devices::FramePairing& pairs, const CommandOutput& output)
{
  for (const std::string& name : pairs.otherImages())
  {
    if (saidImages_.insert(name).second)
    {
      output.warn({ "images of '" + name + "' are left out: '" + pairs.imageName() + "' is taken; --image NAME chooses" });
    }
  }
}

bool LiveSources::isAlive() const
{
  const bool isAnyOpen = std::any_of(entries_.begin(), entries_.end(),
    [](const Entry& entry)
    { return entry.source->status().state != devices::SourceState::Finished || entry.source->buffer().size() > 0; });
  return isAnyOpen && missing().empty();
}

std::string LiveSources::problemOf(const Entry& entry)
{
  const devices::SourceStatus status = entry.source->status();
  const std::string named = entry.source->name() + ": ";  // as many problems begin
  const std::string problem =
    status.lastProblem.rfind(named, 0) == 0 ? status.lastProblem.substr(named.size()) : status.lastProblem;
  const std::string reason = problem.empty() ? "" : ": " + problem;
  return entry.source->name() +
    (entry.hasSample                 ? " gives nothing any more"
        : status.connectionCount > 0 ? " is there and gives nothing"
                                     : " was not there") +
    reason;
}

std::string LiveSources::missing() const
{
  for (const Entry& entry : entries_)
  {
    const bool isFinished = entry.source->status().state == devices::SourceState::Finished;
    const bool isSilent = entry.isLive && devices::systemTimeSec() > entry.newestSec + waitSec_;
    const bool isEmpty = isFinished && !entry.hasSample && entry.source->buffer().size() == 0;
    if (isEmpty || (isSilent && !isFinished))
    {
      return problemOf(entry);
    }
  }
  return {};
}

std::string LiveSources::missingAtEnd() const
{
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [](const Entry& each) { return !each.hasSample; });
  return !missing().empty() ? missing() : entry != entries_.end() ? problemOf(*entry) : "";
}

std::string LiveSources::message() const
{
  std::string text;
  for (const Entry& entry : entries_)
  {
    const devices::SourceStatus status = entry.source->status();
    text += (text.empty() ? "" : "; ") + (entry.hasSample && missing().empty() ? status.message : problemOf(entry));
  }
  return text;
}

nlohmann::json LiveSources::statusJson() const
{
  nlohmann::json list = nlohmann::json::array();
  for (const Entry& entry : entries_)
  {
    const devices::SourceStatus status = entry.source->status();
    nlohmann::json streams = nlohmann::json::array();
    for (const devices::StreamInfo& stream : status.streams)
    {
      // What comes from a network need not be text.
      const std::string name = nlohmann::json(stream.name).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
      streams.push_back({ { "name", nlohmann::json::parse(name) }, { "type", stream.type }, { "count", stream.count } });
    }
    list.push_back({ { "name", entry.source->name() }, { "state", toString(status.state) },
      { "connections", status.connectionCount }, { "refused", status.refusedCount }, { "dropped", status.droppedCount },
      { "lastProblem", status.lastProblem }, { "streams", streams } });
  }
  return list;
}

}  // namespace handeye::cli
