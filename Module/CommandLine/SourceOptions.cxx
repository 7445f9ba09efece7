// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SourceOptions.h"

#include "CommonOptions.h"
#include "OpenIGTLinkClient.h"
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
  CLI::Option_group* from = command.add_option_group("sources");
  from->add_option("--server", servers_, "OpenIGTLink server (PLUS, 3D Slicer, `handeye simulate`); may be given several times")
    ->type_name("HOST[:PORT]")
    ->expected(1)
    ->take_all();
  from->add_option("--video", video_, "Camera (0 is the first), file, image sequence (frames/%04d.jpg) or URL")
    ->type_name("DEVICE");
  from->add_option("--replay", replay_, "Recording that is played as if it were live")->type_name("RECORDING");
  from->require_option(1, 0);
  command.add_option("--speed", speed_, "Of the replay; 0 for as fast as possible")->check(CLI::NonNegativeNumber);
  addLatencyOption(command, pairing.latencySec);
  command.add_option("--image", pairing.imageName, "Which video, where there are several; the first that comes otherwise")
    ->type_name("NAME");
  command.add_option("--wait", waitSec_, "How long to wait for the sources to come up, s")->capture_default_str()->type_name("SEC");
}

void LiveSources::start()
{
  for (const std::string& server : servers_)
  {
    sources_.push_back(std::make_unique<devices::OpenIGTLinkClient>(parseServer(server)));
  }
  if (!video_.empty())
  {
    devices::VideoSourceOptions options;
    options.device = video_;
    sources_.push_back(std::make_unique<devices::VideoSource>(options));
  }
  if (!replay_.empty())
  {
    devices::ReplayOptions options;
    options.recording = replay_;
    options.speed = speed_;
    sources_.push_back(std::make_unique<devices::ReplaySource>(options));
  }
  startSec_ = devices::systemTimeSec();
  for (const auto& source : sources_)
  {
    source->start();
  }
}

void LiveSources::stop()
{
  for (const auto& source : sources_)
  {
    source->stop();
  }
}

std::optional<devices::DeviceSample> LiveSources::pop(double timeoutSec)
{
  const double each = sources_.size() > 1 ? 0.002 : timeoutSec;
  const double endSec = devices::systemTimeSec() + timeoutSec;
  do
  {
    for (std::size_t i = 0; i < sources_.size(); ++i)
    {
      next_ = (next_ + 1) % sources_.size();
      std::optional<devices::DeviceSample> sample = sources_[next_]->pop(each);
      if (!sample)
      {
        continue;
      }
      if (sources_.size() > 1)
      {
        sample->timeSec = offsets_[next_].toLocalSec(sample->timeSec, sample->receivedSec);
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
  const bool isLate = !hasSample_ && devices::systemTimeSec() > startSec_ + waitSec_;
  return !isLate &&
    std::any_of(sources_.begin(), sources_.end(),
      [](const auto& source) { return source->status().state != devices::SourceState::Finished || source->buffer().size() > 0; });
}

std::string LiveSources::message() const
{
  std::string text;
  for (const auto& source : sources_)
  {
    const devices::SourceStatus status = source->status();
    text += (text.empty() ? "" : "; ") + (status.connectionCount == 0 ? source->name() + " was not there" : status.message);
  }
  return text;
}

nlohmann::json LiveSources::statusJson() const
{
  nlohmann::json list = nlohmann::json::array();
  for (const auto& source : sources_)
  {
    const devices::SourceStatus status = source->status();
    nlohmann::json streams = nlohmann::json::array();
    for (const devices::StreamInfo& stream : status.streams)
    {
      // What comes from a network need not be text.
      const std::string name = nlohmann::json(stream.name).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
      streams.push_back({ { "name", nlohmann::json::parse(name) }, { "type", stream.type }, { "count", stream.count } });
    }
    list.push_back({ { "name", source->name() }, { "state", toString(status.state) }, { "connections", status.connectionCount },
      { "refused", status.refusedCount }, { "dropped", status.droppedCount }, { "streams", streams } });
  }
  return list;
}

}  // namespace handeye::cli
