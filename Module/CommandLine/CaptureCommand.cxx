// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "FileError.h"
#include "LiveCapture.h"
#include "PacedMessages.h"
#include "ResultFiles.h"
#include "SourceOptions.h"
#include "StopSignal.h"
#include "StreamRecorder.h"

#include <algorithm>
#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

struct CaptureArguments
{
  LiveSources sources;
  std::string session, camera, stylus, record, poses;
  int count = 15;
  double seconds = 0;
  devices::LiveCaptureOptions options;
  CommandOutput output;
};

/// A full disk or the like is said once a second and tried again: what was accepted is safe.
class Capturing
{
public:
  Capturing(devices::LiveCapture& capture, const CommandOutput& output)
    : capture_(capture)
    , output_(output)
    , problems_([&output](const std::string& problem) { output.warn({ problem }); })
  {
  }

  void add(const devices::PairedFrame& frame)
  {
    std::string problem;
    try
    {
      const devices::LiveCapture::Step step = capture_.add(frame);
      if (step.status == devices::LiveCapture::Step::Status::Accepted)
      {
        output_.say(step.message);
        std::cout << std::flush;
        return;
      }
      problem = step.status == devices::LiveCapture::Step::Status::Moving ? "" : step.message;
    }
    catch (const std::exception& error)
    {
      problem = error.what();
    }
    problems_.add(problem, frame.image.timeSec);
  }

private:
  devices::LiveCapture& capture_;
  const CommandOutput& output_;
  PacedMessages problems_;
};

/// A recording that fails (full disk) is said once; the capture goes on.
class RecordingBeside
{
public:
  RecordingBeside(const CaptureArguments& arguments, const CommandOutput& output)
    : recorder_(arguments.record, arguments.poses)
    , output_(output)
  {
  }

  template<typename Sample> void add(const Sample& sample) { warnIf(!recorder_.add(sample)); }
  void close()
  {
    warnIf(!recorder_.close());
    if (recorder_.leftOutCount() > 0)
    {
      output_.warn({ std::to_string(recorder_.leftOutCount()) + " were left out, the first: " + recorder_.leftOutReason() });
    }
  }

private:
  void warnIf(bool hasFailed)
  {
    if (hasFailed && !isSaid_)
    {
      output_.warn({ "the recording has ended with what it has so far, the capture goes on: " + recorder_.error() });
      isSaid_ = true;
    }
  }

  devices::StreamRecorder recorder_;
  const CommandOutput& output_;
  bool isSaid_ = false;
};

/// Without those that were set aside.
int usedCount(const io::Session& session)
{
  return int(std::count_if(
    session.samples().begin(), session.samples().end(), [](const auto& sample) { return !sample.second.isExcluded; }));
}

int runCapture(CaptureArguments& arguments)
{
  const io::CameraFile camera = io::readCameraFile(arguments.camera);
  const Eigen::Vector3d tip_Stylus = readStylusTip(arguments.stylus);
  io::Session session = io::Session::openOrCreate(arguments.session);
  const double latencySec = arguments.sources.pairing.latencySec;
  if (!session.fitsLatency(latencySec))
  {
    throw io::FileError(arguments.session,
      format("its samples have a latency of %.1f ms and --latency is %.1f ms; all have the same, or a new session is begun",
        1000 * *session.latencySec(), 1000 * latencySec));
  }
  arguments.output.warn(camera.warnings);
  arguments.output.warn(session.problems());
  devices::LiveCapture capture(camera.camera, tip_Stylus, session, arguments.options);
  Capturing capturing(capture, arguments.output);
  RecordingBeside recording(arguments, arguments.output);
  arguments.sources.pairing.toolNames = { arguments.options.stylusToTracker, arguments.options.markerToTracker };
  arguments.sources.start();
  catchStopSignals();
  devices::FramePairing pairing(arguments.sources.pairing);
  const auto isFull = [&] { return usedCount(session) >= arguments.count; };
  const auto isDone = [&]
  { return isStopAsked() || isFull() || (arguments.seconds > 0 && arguments.sources.streamSec() > arguments.seconds); };
  while (!isDone() && arguments.sources.isAlive())
  {
    if (std::optional<devices::DeviceSample> sample = arguments.sources.pop(0.1))
    {
      recording.add(*sample);
      pairing.add(std::move(*sample));
      arguments.sources.warnOfOtherImages(pairing, arguments.output);
    }
    for (std::optional<devices::PairedFrame> frame; !isDone() && (frame = pairing.take());)
    {
      recording.add(*frame);
      capturing.add(*frame);
    }
  }
  const std::string ofSources = arguments.sources.message();
  arguments.sources.stop();
  recording.close();
  const std::string message = std::to_string(usedCount(session)) + " samples are in " + arguments.session +
    (isFull() ? "" : "; " + std::to_string(arguments.count) + " were asked for. " + ofSources);
  CommandOutput output = arguments.output;
  output.file.clear();
  if (isFull())
  {
    output.say(message);
  }
  return output.finish({ { "schema", "handeye-capture/1" }, { "status", isFull() ? "ok" : "too_few_samples" },
    { "message", message }, { "samples", session.samples().size() }, { "sources", arguments.sources.statusJson() } });
}

}  // namespace

void addCaptureCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<CaptureArguments>();
  CLI::App* command = app.add_subcommand("capture", "Collect placements of the ball in a session, live; a session is a RECORDING");
  arguments->sources.addTo(*command);
  command->add_option("--session", arguments->session, "Folder; an existing session is continued")->required()->type_name("DIR");
  addCameraOption(*command, arguments->camera);
  command->add_option("--stylus", arguments->stylus, "What `handeye pivot` wrote")->required()->type_name("stylus.json");
  addBallRadiusOption(*command, arguments->options.ballRadiusMm);
  addTransformOption(*command, "--stylus-transform", arguments->options.stylusToTracker, "stylus");
  addTransformOption(*command, "--marker-transform", arguments->options.markerToTracker, "camera's marker");
  command->add_option("--record", arguments->record, "Also record all images with the poses of their moments (sequence metafile)")
    ->type_name("FILE");
  command->add_option("--record-poses", arguments->poses, "Also record every pose at its own time")->type_name("FILE");
  command->add_option("--count", arguments->count, "Stop when the session has so many samples")->capture_default_str();
  command->add_option("--seconds", arguments->seconds, "Stop after so much stream time")->type_name("SEC");
  command->add_option("--still", arguments->options.stillSec, "How long the ball must be still, s")->capture_default_str();
  arguments->output.addTo(*command, false);
  command->callback([arguments, &exitCode] { exitCode = runCapture(*arguments); });
}

}  // namespace handeye::cli
