// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "JsonEigen.h"
#include "SourceOptions.h"
#include "StopSignal.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct StreamsArguments
{
  LiveSources sources;
  double seconds = 2;
  CommandOutput output;
};

/// Text from a network as JSON can hold it.
std::string cleaned(const std::string& text)
{
  std::string clean;
  for (char c : text)
  {
    clean += c >= 32 && c < 127 ? c : '?';
  }
  return clean;
}

nlohmann::json describe(const devices::DeviceSample& sample)
{
  nlohmann::json object = { { "name", cleaned(sample.name) }, { "timeSec", sample.timeSec } };
  if (const devices::TrackedPose* pose = sample.pose())
  {
    object["type"] = "pose";
    object["isValid"] = pose->isValid;
    object["reason"] = pose->reason;
    if (pose->received.allFinite())
    {
      object["matrix"] = toJson(pose->received);
    }
  }
  else if (const devices::VideoFrame* frame = sample.frame())
  {
    const cv::Mat& image = frame->image;
    object["type"] = "image";
    object["width"] = image.cols;
    object["height"] = image.rows;
    object["channels"] = image.channels();
    object["bits"] = image.depth() == CV_8U ? 8 : 16;
    object["imageToReference"] = toJson(frame->imageToReference);
    const cv::Mat1i first = image(cv::Rect(0, 0, std::min(image.cols, 4), 1)).clone().reshape(1);
    object["firstPixels"] = std::vector<int>(first.begin(), first.end());
  }
  else if (const devices::DeviceText* text = sample.text())
  {
    object["type"] = "text";
    object["text"] = cleaned(text->text);
  }
  else if (const devices::DeviceStatus* status = sample.status())
  {
    object["type"] = "status";
    object["code"] = status->code;
    object["error"] = cleaned(status->error);
    object["text"] = cleaned(status->message);
  }
  for (const auto& [key, value] : sample.metadata)
  {
    object["metadata"][cleaned(key)] = cleaned(value);
  }
  return object;
}

int runStreams(StreamsArguments& arguments)
{
  arguments.sources.start();
  catchStopSignals();
  std::map<std::string, nlohmann::json> newest;
  std::map<std::string, int> counts;
  while (!isStopAsked() && arguments.sources.isAlive() && arguments.sources.streamSec() < arguments.seconds)
  {
    if (const std::optional<devices::DeviceSample> sample = arguments.sources.pop(0.1))
    {
      newest[sample->name] = describe(*sample);
      ++counts[sample->name];
    }
  }
  const std::string missing = arguments.sources.missingAtEnd();
  if (!newest.empty() && !missing.empty())
  {
    arguments.output.warn({ missing });
  }
  arguments.sources.stop();
  nlohmann::json result = { { "schema", "handeye-streams/1" }, { "status", newest.empty() ? "nothing_came" : "ok" },
    { "message", newest.empty() ? "nothing came: " + arguments.sources.message() : std::to_string(newest.size()) + " streams" },
    { "streams", nlohmann::json::array() }, { "sources", arguments.sources.statusJson() } };
  for (auto& [name, object] : newest)
  {
    object["count"] = counts[name];
    object["perSec"] = arguments.sources.streamSec() > 0 ? counts[name] / arguments.sources.streamSec() : 0;
    arguments.output.say(cleaned(name) + std::string(name.size() < 24 ? 24 - name.size() : 1, ' ') +
      object["type"].get<std::string>() + format("  %.1f a second", object["perSec"].get<double>()) +
      (object.value("isValid", true) ? "" : "  not valid"));
    result["streams"].push_back(object);
  }
  return arguments.output.finish(result);
}

}  // namespace

void addStreamsCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<StreamsArguments>();
  CLI::App* command =
    app.add_subcommand("streams", "List what a server, camera or recording streams; --json with the newest values");
  arguments->sources.addTo(*command);
  command->add_option("--seconds", arguments->seconds, "How long to look")->capture_default_str()->type_name("SEC");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runStreams(*arguments); });
}

}  // namespace handeye::cli
