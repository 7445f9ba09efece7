// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "FramePairing.h"
#include "SourceOptions.h"
#include "StopSignal.h"
#include "StreamRecorder.h"

#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

struct RecordArguments
{
  LiveSources sources;
  std::string poses;
  double seconds = 0;
  int frames = 0;
  CommandOutput output;
};

/// What is in the files now.
std::string wrote(const RecordArguments& arguments, const devices::StreamRecorder& recorder)
{
  std::string text;
  if (!arguments.output.file.empty())
  {
    text =
      std::to_string(recorder.frameCount()) + " frames, each with the poses of its moment, written to " + arguments.output.file;
  }
  if (!arguments.poses.empty())
  {
    text += (text.empty() ? "" : "; ") + std::to_string(recorder.poseCount()) + " poses at their own times, written to " +
      arguments.poses;
  }
  return text;
}

int runRecord(RecordArguments& arguments)
{
  if (arguments.output.file.empty() && arguments.poses.empty())
  {
    throw CLI::ValidationError("record", "-o FILE or --poses FILE is expected");
  }
  devices::StreamRecorder recorder(arguments.output.file, arguments.poses);
  arguments.sources.start();
  catchStopSignals();
  devices::FramePairing pairing(arguments.sources.pairing);
  const auto record = [&](const std::optional<devices::PairedFrame>& frame) { return frame && recorder.add(*frame); };
  const auto isDone = [&]
  {
    return isStopAsked() || recorder.hasFailed() || (arguments.frames > 0 && recorder.frameCount() >= arguments.frames) ||
      (arguments.seconds > 0 && arguments.sources.streamSec() > arguments.seconds);
  };
  while (!isDone() && arguments.sources.isAlive())
  {
    if (std::optional<devices::DeviceSample> sample = arguments.sources.pop(0.1))
    {
      recorder.add(*sample);
      pairing.add(std::move(*sample));
      arguments.sources.warnOfOtherImages(pairing, arguments.output);
    }
    while (!isDone() && record(pairing.take()))
    {
    }
  }
  while (!isDone() && record(pairing.takeRest()))
  {
  }
  const std::string missing = arguments.sources.missingAtEnd();
  arguments.sources.stop();
  const bool isWhole = recorder.close();
  if (recorder.leftOutCount() > 0)
  {
    arguments.output.warn({ std::to_string(recorder.leftOutCount()) + " were left out, the first: " + recorder.leftOutReason() });
  }
  const bool isAnything = recorder.frameCount() + recorder.poseCount() > 0;
  const bool isGood = isWhole && isAnything && missing.empty();
  nlohmann::json result = { { "schema", "handeye-record/1" },
    { "status",
      isGood                    ? "ok"
        : isWhole && isAnything ? "source_missing"
                                : "not_recorded" },
    { "frames", recorder.frameCount() }, { "poses", recorder.poseCount() }, { "sources", arguments.sources.statusJson() } };
  result["message"] = recorder.hasFailed() ? recorder.error()
    : !isAnything                          ? "nothing came: " + arguments.sources.message()
    : missing.empty()                      ? wrote(arguments, recorder)
                                           : missing + "; what came is kept: " + wrote(arguments, recorder);
  if (isGood)
  {
    arguments.output.say(result["message"].get<std::string>());
  }
  CommandOutput output = arguments.output;
  output.file.clear();
  return output.finish(result);
}

}  // namespace

void addRecordCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* command = app.add_subcommand("record", "Record what a tracker's server and a camera stream");
  arguments->sources.addTo(*command);
  command->add_option("--poses", arguments->poses, "Also every pose at its own time, as a sequence metafile")->type_name("FILE");
  command->add_option("--seconds", arguments->seconds, "How much; until Ctrl+C otherwise")->type_name("SEC");
  command->add_option("--frames", arguments->frames, "How many images at most")->type_name("N");
  arguments->output.addTo(*command);
  command->get_option("--output")->description("Images with the poses of their moments, as a sequence metafile");
  command->callback([arguments, &exitCode] { exitCode = runRecord(*arguments); });
}

}  // namespace handeye::cli
