// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "FileError.h"
#include "LandmarkFiles.h"
#include "LandmarkRegistration.h"
#include "MeshReader.h"
#include "ResultFiles.h"
#include "SurfaceDistance.h"
#include "TextTables.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace handeye::cli
{

namespace
{

constexpr double Degrees = 180 / EIGEN_PI;

struct LandmarksArguments
{
  std::string model, touched;
  std::string recording, stylus, mesh, targets;
  std::vector<double> weights;
  bool fixOrder = false;
  TouchedLandmarksOptions touching;
  double maximumTurnDeg = StillnessOptions().maximumTurn * Degrees;
  CommandOutput output;
};

/// Whether the model's landmarks lie on its surface; if the touched ones do instead, the lists are exchanged.
void checkOnSurface(const LandmarksArguments& arguments, const LandmarkLists& lists)
{
  if (arguments.mesh.empty())
  {
    return;
  }
  const vtkSmartPointer<vtkPolyData> mesh = readMesh(arguments.mesh);
  const double model = largestSurfaceDistance(mesh, lists.points_Model);
  if (model <= LargestSurfaceDistanceMm)
  {
    return;
  }
  const bool areExchanged = largestSurfaceDistance(mesh, lists.points_Phantom) <= LargestSurfaceDistanceMm;
  throw io::FileError(arguments.model,
    format("a landmark is %.1f mm off the surface of the model, expected is at most %.0f mm", model, LargestSurfaceDistanceMm) +
      (areExchanged ? "; the touched ones lie on it: the two lists are exchanged"
                    : ": are they landmarks of " + arguments.mesh + "?"));
}

void sayRegistration(const LandmarksArguments& arguments, const LandmarkRegistrationResult& registration)
{
  const CommandOutput& output = arguments.output;
  output.say("model's landmarks    " + arguments.model);
  output.say("touched landmarks    " + (arguments.recording.empty() ? arguments.touched : arguments.recording));
  output.say("modelToPhantom (mm)");
  output.say(matrixLines(registration.modelToPhantom.matrix(), "  ", 4));
  output.say(
    format("residual             %.3f mm RMS, from touching with %.3f mm", registration.rmsMm, registration.localizationErrorMm));
  for (std::size_t i = 0; i < registration.residualsMm.size(); ++i)
  {
    output.say("  landmark " + std::to_string(i + 1) +
      format("         %.3f mm, expected error there %.3f mm", registration.residualsMm[i], registration.landmarkTreMm[i]) +
      (registration.leftOut.empty() ? std::string() : format(", without it %.3f mm RMS are left", registration.leftOut[i].rmsMm)));
  }
  for (std::size_t i = 0; i < registration.targetTreMm.size(); ++i)
  {
    output.say("  target " + std::to_string(i + 1) + format("           expected error %.3f mm", registration.targetTreMm[i]));
  }
  output.say(registration.message);
}

void sayTouched(const CommandOutput& output, const TouchedLandmarksResult& result)
{
  const auto line = [&](const std::string& name, const TouchedLandmark& landmark)
  {
    const Rest& rest = landmark.rest;
    output.say(name + numbers(landmark.point_Phantom, 2) +
      format("  %.1f to %.1f s, %.2f mm RMS, ", rest.beginSec, rest.endSec, rest.rmsMm) + toString(rest.kind) + ", frames " +
      std::to_string(rest.firstSample) + " to " + std::to_string(rest.lastSample));
  };
  output.say("stylus               " + result.stylusToTracker + ", tip (mm) " + numbers(result.tip_Stylus, 3));
  if (result.tipInRecording_Stylus)
  {
    output.say("  in this recording  it turns about " + numbers(*result.tipInRecording_Stylus, 3));
  }
  output.say("touched object       " + (result.phantomToTracker.empty() ? std::string("no marker") : result.phantomToTracker));
  for (std::size_t i = 0; i < result.landmarks.size(); ++i)
  {
    line("  landmark " + std::to_string(i + 1) + (i < 9 ? " " : "") + "        ", result.landmarks[i]);
  }
  for (const TouchedLandmark& rest : result.setAside)
  {
    line("  set aside          ", rest);
  }
}

int registerLists(const LandmarksArguments& arguments, const LandmarkLists& lists, const nlohmann::json& touchedJson)
{
  checkOnSurface(arguments, lists);
  LandmarkRegistrationOptions options;
  options.weights = arguments.weights;
  if (!arguments.targets.empty())
  {
    options.targets_Model = io::readPoints(arguments.targets);
  }
  LandmarkRegistrationResult registration = registerLandmarks(lists.points_Model, lists.points_Phantom, options);
  nlohmann::json object = phantomJson(registration);
  if (arguments.fixOrder && registration.status == LandmarkRegistrationResult::Status::WrongOrder &&
    registration.suggestionIsUnique)
  {
    const nlohmann::json order = object.at("suggestedOrder");
    registration = registerLandmarks(lists.points_Model, reordered(lists.points_Phantom, registration.suggestedOrder), options);
    object = phantomJson(registration);
    object["touchedOrder"] = order;
    arguments.output.warn({ "the touched landmarks were taken in the order " + order.dump() });
  }
  if (!touchedJson.is_null())
  {
    object["touched"] = touchedJson;
  }
  if (registration.isUsable())
  {
    sayRegistration(arguments, registration);
  }
  return arguments.output.finish(object);
}

int runFromRecording(const LandmarksArguments& arguments)
{
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  const std::vector<Eigen::Vector3d> points_Model =
    arguments.model.empty() ? std::vector<Eigen::Vector3d>() : readModelLandmarks(arguments.model);
  std::optional<Eigen::Vector3d> tip_Stylus;
  if (!arguments.stylus.empty())
  {
    tip_Stylus = readStylusTip(arguments.stylus);
  }
  TouchedLandmarksOptions options = arguments.touching;
  options.stillness.maximumTurn = arguments.maximumTurnDeg / Degrees;
  const TouchedLandmarksResult touched = landmarksFromRecording(recording, tip_Stylus, options);
  arguments.output.warn(touched.warnings);
  nlohmann::json object = touchedLandmarksJson(touched);
  if (touched.isUsable())
  {
    sayTouched(arguments.output, touched);
  }
  if (arguments.model.empty() || !touched.isUsable())
  {
    return arguments.output.finish(
      object, [&](const std::string& path) { writeTouchedLandmarks(path, touched, arguments.recording); });
  }
  if (touched.landmarks.size() != points_Model.size())
  {
    object["status"] = "landmark_count";
    object["message"] = "the model has " + std::to_string(points_Model.size()) + " landmarks, " +
      std::to_string(touched.landmarks.size()) + " were touched in the recording";
    return arguments.output.finish(object);
  }
  return registerLists(arguments, { points_Model, touched.points_Phantom() }, object);
}

int runLandmarks(const LandmarksArguments& arguments)
{
  if (!arguments.recording.empty())
  {
    if (!arguments.touched.empty())
    {
      throw CLI::ValidationError("TOUCHED-POINTS", "the touched points come from --from-recording, another list is not expected");
    }
    return runFromRecording(arguments);
  }
  if (arguments.touched.empty())
  {
    throw CLI::ValidationError(arguments.model.empty() ? "MODEL-POINTS" : "TOUCHED-POINTS",
      "two lists of landmarks are expected, or one and --from-recording");
  }
  return registerLists(arguments, readLandmarkLists(arguments.model, arguments.touched), {});
}

void addRecordingOptions(CLI::App& command, LandmarksArguments& arguments)
{
  command
    .add_option("--from-recording", arguments.recording,
      "Take the touched points from a recording: where the stylus was held still, or pivoted on its resting tip.\n"
      "Without MODEL-POINTS they are printed, and written by -o as a TOUCHED-POINTS file")
    ->type_name("RECORDING");
  command.add_option("--stylus", arguments.stylus, "The stylus' tip; not needed if the stylus is pivoted on the landmarks")
    ->type_name("stylus.json");
  addTransformOption(command, "--stylus-transform", arguments.touching.stylusToTracker, "stylus");
  command
    .add_option("--phantom-transform", arguments.touching.phantomToTracker,
      "Pose of the marker on what is touched; found by itself if it is called Phantom or Reference, or is the only other one")
    ->type_name("NAME");
  command.add_option("--motion-mm", arguments.touching.stillness.maximumMotionMm, "How far the tip of a stylus at rest may move")
    ->type_name("MM")
    ->capture_default_str();
  command.add_option("--turn-deg", arguments.maximumTurnDeg, "How far a stylus that is held still may turn (with --held)")
    ->type_name("DEG")
    ->capture_default_str();
  command.add_option("--rest-sec", arguments.touching.stillness.minimumDurationSec, "How long a rest lasts at least")
    ->type_name("SEC")
    ->capture_default_str();
  command.add_flag_callback(
    "--held", [&arguments] { arguments.touching.stillness.touch = StillnessOptions::Touch::Held; },
    "Only rests in which the stylus does not turn are landmarks");
}

}  // namespace

void addLandmarksCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<LandmarksArguments>();
  CLI::App* command = app.add_subcommand("landmarks", "Register a model to its phantom by touched landmarks");
  command->add_option("model-points", arguments->model, "Landmarks on the model, \"x y z\" a line, mm")->type_name("MODEL-POINTS");
  command->add_option("touched-points", arguments->touched, "The same landmarks as touched, in the phantom marker's frame, mm")
    ->type_name("TOUCHED-POINTS");
  addRecordingOptions(*command, *arguments);
  command->add_flag("--fix-order", arguments->fixOrder, "If they were touched in another order and only one fits, take that one");
  command->add_option("--weights", arguments->weights, "One positive number per landmark, 1 / variance, separated by commas")
    ->delimiter(',')
    ->type_name("W1,W2,...");
  command->add_option("--targets", arguments->targets, "Points of the model where the expected error is said, \"x y z\" a line, mm")
    ->type_name("FILE");
  command
    ->add_option("--mesh", arguments->mesh, "The model: its landmarks must lie on it, which also shows lists that are exchanged")
    ->type_name("MESH");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runLandmarks(*arguments); });
}

}  // namespace handeye::cli
