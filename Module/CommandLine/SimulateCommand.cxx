// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "JsonEigen.h"
#include "OpenIGTLinkServer.h"
#include "ResultFiles.h"
#include "SimulatedRoom.h"
#include "StopSignal.h"
#include "StreamRecorder.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <thread>

namespace handeye::cli
{

namespace
{

using simulation::RoomMotion;
using simulation::SimulatedRoom;

struct SimulateArguments
{
  int port = -1;  // not asked for
  std::string bind = "127.0.0.1", record, camera, motion = "tour", imageName = "Video";
  double seconds = 0, framesPerSec = 30, posesPerSec = 100, speed = 1, delayMs = 0;
  int protocol = 3;
  bool isNoiseFree = false, noClutter = false, isCompressed = false;
  simulation::RoomOptions room;
  CommandOutput output;
};

nlohmann::json truthJson(const SimulateArguments& arguments, const SimulatedRoom& room)
{
  const simulation::RoomOptions& options = room.options();
  return { { "schema", "handeye-truth/1" }, { "status", "ok" }, { "message", "what is true in the simulated room" },
    { "camera",
      { { "width", options.camera.width() }, { "height", options.camera.height() },
        { "cameraMatrix", toJson(options.camera.cameraMatrix()) },
        { "distortionCoefficients", options.camera.distortionCoefficients() } } },
    { "markerToCamera", toJson(options.markerToCamera) }, { "tip_Stylus_Mm", toJson(options.tip_Stylus) },
    { "modelToPhantom", toJson(options.modelToPhantom) }, { "ballRadiusMm", options.ballRadiusMm },
    { "latencySec", -options.videoDelaySec }, { "motion", arguments.motion }, { "seed", options.seed } };
}

void record(const SimulateArguments& arguments, const SimulatedRoom& room)
{
  io::SequenceMetafileWriterOptions options;
  options.compressed = arguments.isCompressed;
  io::SequenceMetafileWriter writer(arguments.record, options);
  const double seconds = arguments.seconds > 0 ? arguments.seconds : 72;
  const int count = int(std::lround(seconds * arguments.framesPerSec));
  const Progress progress = arguments.output.progress("frame");
  for (int i = 0; i < count && !isStopAsked(); ++i)
  {
    const double timeSec = i / arguments.framesPerSec;
    io::SequenceFrame frame;
    frame.timestampSec = frame.unfilteredTimestampSec = timeSec;
    frame.frameNumber = i;
    for (const simulation::RoomPose& pose : room.track(timeSec))
    {
      frame.transforms[pose.name] = devices::toSequenceTransform(pose.transform, pose.isValid);
    }
    writer.append(frame, room.picture(timeSec));
    if (progress)
    {
      progress(i + 1, count);
    }
  }
  writer.close();
  arguments.output.say("written to " + arguments.record);
}

void sendPoses(const SimulateArguments& arguments, const SimulatedRoom& room, devices::OpenIGTLinkServer& server, double streamSec,
  double timeSec)
{
  const int headerVersion = arguments.protocol >= 3 ? 2 : 1;
  for (const simulation::RoomPose& pose : room.track(streamSec))
  {
    // Protocol 1 has no word for a tool that is not seen: nothing is sent then, as PLUS does.
    if (pose.isValid || headerVersion == 2)
    {
      server.send(devices::packTransform(
        pose.name, timeSec, pose.transform.matrix(), { { "TransformStatus", pose.isValid ? "OK" : "INVALID" } }, headerVersion));
    }
  }
}

/// Poses and pictures at their times. A computer that is too slow for the pictures sends fewer of them, never later ones.
void serve(const SimulateArguments& arguments, const SimulatedRoom& room)
{
  devices::OpenIGTLinkServerOptions options;
  options.address = arguments.bind;
  options.port = arguments.port;
  devices::OpenIGTLinkServer server(options);
  arguments.output.say("serving OpenIGTLink on " + arguments.bind + ":" + std::to_string(server.port()) + "; Ctrl+C ends it");
  std::cout << std::flush;
  const double startSec = devices::systemTimeSec();
  long poseIndex = 0, frameIndex = 0;
  while (!isStopAsked() && (arguments.seconds <= 0 || poseIndex / arguments.posesPerSec < arguments.seconds))
  {
    const double nextPoseSec = poseIndex / arguments.posesPerSec, nextFrameSec = frameIndex / arguments.framesPerSec;
    const double nextSec = std::min(nextPoseSec, nextFrameSec);
    const double waitSec = startSec + nextSec / arguments.speed - devices::systemTimeSec();
    if (waitSec > 0)
    {
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(waitSec, 0.1)));
      continue;
    }
    if (nextPoseSec <= nextFrameSec)
    {
      sendPoses(arguments, room, server, nextPoseSec, startSec + nextPoseSec);
      ++poseIndex;
      continue;
    }
    if (server.clientCount() > 0)
    {
      server.send(devices::packImage(arguments.imageName, startSec + nextFrameSec, room.picture(nextFrameSec),
        Eigen::Matrix4d::Identity(), {}, arguments.protocol >= 3 ? 2 : 1));
    }
    const double behindSec = devices::systemTimeSec() - startSec - nextFrameSec / arguments.speed;
    frameIndex += 1 + std::max(0L, long(behindSec * arguments.speed * arguments.framesPerSec) - 1);
  }
  (void)server.waitUntilSent(2);
}

int runSimulate(SimulateArguments& arguments)
{
  static const std::map<std::string, RoomMotion> motions = { { "pivot", RoomMotion::Pivot }, { "spin", RoomMotion::Spin },
    { "placements", RoomMotion::Placements }, { "free", RoomMotion::Free }, { "rest", RoomMotion::Rest },
    { "tour", RoomMotion::Tour } };
  simulation::RoomOptions& room = arguments.room;
  room.motion = motions.at(arguments.motion);
  room.videoDelaySec = arguments.delayMs / 1000;
  room.hasClutter = !arguments.noClutter;
  if (!arguments.camera.empty())
  {
    room.camera = io::readCameraFile(arguments.camera).camera;
  }
  if (arguments.isNoiseFree)
  {
    room.trackingSigmaMm = room.trackingSigmaDeg = room.dropOutShare = room.imageNoise = 0;
  }
  const SimulatedRoom simulated(room);
  const nlohmann::json truth = truthJson(arguments, simulated);
  if (!arguments.output.file.empty())
  {
    writeJson(arguments.output.file, truth);  // before the stream begins, for who wants to compare with it
  }
  catchStopSignals();
  if (!arguments.record.empty())
  {
    record(arguments, simulated);
  }
  if (arguments.port >= 0)
  {
    serve(arguments, simulated);
  }
  CommandOutput output = arguments.output;
  output.file.clear();
  return output.finish(truth);
}

void addRoomOptions(CLI::App& command, SimulateArguments& arguments)
{
  simulation::RoomOptions& room = arguments.room;
  command.add_option("--camera", arguments.camera, "Lens of the simulated camera; a webcam of 640 x 480 otherwise")
    ->type_name("CAMERA");
  command.add_option("--ball-radius", room.ballRadiusMm, "Radius of the ball, mm")->capture_default_str()->type_name("MM");
  command.add_option("--nearest", room.nearestMm, "Least depth of the ball, mm")->capture_default_str()->type_name("MM");
  command.add_option("--furthest", room.furthestMm, "Greatest depth of the ball, mm")->capture_default_str()->type_name("MM");
  command.add_option("--places", room.placeCount, "How many placements there are")->capture_default_str();
  command.add_option("--hold", room.holdSec, "How long the ball is held at each, s")->capture_default_str()->type_name("SEC");
  command.add_option("--tracking-noise", room.trackingSigmaMm, "Noise of a pose per axis, mm")
    ->capture_default_str()
    ->type_name("MM");
  command.add_option("--drop-outs", room.dropOutShare, "Share of the time that a tool is not seen")->capture_default_str();
  command.add_option("--image-noise", room.imageNoise, "Noise of a pixel, in steps of 8 bits")->capture_default_str();
  command.add_flag("--no-noise", arguments.isNoiseFree, "Neither noise nor drop-outs");
  command.add_flag("--no-clutter", arguments.noClutter, "Nothing but the ball");
  command.add_option("--delay", arguments.delayMs, "How much later than its exposure a frame is stamped, ms")->type_name("MS");
  command.add_option("--seed", room.seed, "Of everything random")->capture_default_str();
}

}  // namespace

void addSimulateCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand("simulate",
    "An operating room that is not there: a tracked camera, a ball on a stylus, a phantom. Served over OpenIGTLink or written to a "
    "file");
  CLI::Option_group* what = command->add_option_group("where to");
  what->add_option("--port", arguments->port, "Serve OpenIGTLink on this port (18944 is usual; 0 for any that is free)")
    ->check(CLI::Range(0, 65535))
    ->type_name("N");
  what->add_option("--record", arguments->record, "Write a sequence metafile; about 28 MB a second of 640 x 480 at 30 frames")
    ->type_name("FILE");
  what->require_option(1, 2);
  command->add_option("--bind", arguments->bind, "Address to serve on: 127.0.0.1 is this computer alone, 0.0.0.0 the network")
    ->capture_default_str()
    ->type_name("ADDRESS");
  command->add_option("--motion", arguments->motion, "What happens")
    ->check(CLI::IsMember({ "pivot", "spin", "placements", "free", "rest", "tour" }))
    ->capture_default_str()
    ->type_name("pivot|spin|placements|free|rest|tour");
  command->add_option("--seconds", arguments->seconds, "How long; a server runs until Ctrl+C otherwise, a file has 72")
    ->type_name("SEC");
  const CLI::Range rate(0.1, 1000.0);
  command->add_option("--frames-per-sec", arguments->framesPerSec, "Pictures")->check(rate)->capture_default_str();
  command->add_option("--poses-per-sec", arguments->posesPerSec, "Poses of each tool (server)")->check(rate)->capture_default_str();
  command->add_option("--speed", arguments->speed, "Of the server's time: 2 is twice as fast as real")
    ->check(CLI::Range(0.01, 100.0))
    ->capture_default_str();
  command->add_option("--protocol", arguments->protocol, "OpenIGTLink's version: 3 says of a pose whether it is valid")
    ->check(CLI::Range(1, 3))
    ->capture_default_str();
  command->add_flag("--compress", arguments->isCompressed, "The file's pixels as one zlib stream");
  addRoomOptions(*command, *arguments);
  arguments->output.addTo(*command);
  command->get_option("--output")->description("Write the truth (markerToCamera, tip_Stylus_Mm, ...) to this file");
  command->callback([arguments, &exitCode] { exitCode = runSimulate(*arguments); });
}

}  // namespace handeye::cli
