// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AtomicFile.h"
#include "BoardOptions.h"
#include "BoardPattern.h"
#include "BoardResultFiles.h"
#include "CameraFileWriter.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "CoveragePicture.h"
#include "JsonEigen.h"
#include "LensPictures.h"
#include "LensStereo.h"

#include <memory>
#include <string>
#include <vector>

namespace handeye::cli
{

namespace
{

struct LensArguments
{
  std::vector<const CLI::Option*> liveOptions;  ///< that mean something with a live video only
  std::string recording, right, board, rightFile, leftToRightFile, coverageFile;
  LensCalibrationOptions lens;
  LensViewCollectorOptions collector;
  LiveSources sources;
  LiveLensOptions live;
  int stillFrames = 0;  ///< 0: as it suits the pictures
  double circleDiameterMm = -1;
  int repetitions = 0;
  bool all = false;
  bool keepOutliers = false;
  CommandOutput output;
};

/// What a line is about, as wide as that of every line.
std::string title(std::string text)
{
  constexpr std::size_t width = 21;
  text.resize(std::max(text.size() + 1, width), ' ');
  return text;
}

void sayEye(const LensArguments& arguments, const LensPictures& eye, const LensCalibrationResult& result, const std::string& label)
{
  const CommandOutput& output = arguments.output;
  output.say(title("views" + label) + eye.summary);
  output.say(format("coverage             %.0f %% of the image", 100 * eye.collector->coverageShare()));
  for (const LensCalibrationResult::View& view : result.views)
  {
    if (!view.used)
    {
      output.say("left out             frame " + std::to_string(view.frame) + ": " + view.message);
    }
  }
  if (!result.isUsable())
  {
    output.say("next                 " + eye.collector->hint());
    return;
  }
  const CameraModel& camera = *result.camera;
  const Eigen::Vector4d& sigma = result.cameraMatrixSigmas;
  output.say(format("focal length         %.2f, %.2f px", camera.fx(), camera.fy()) +
    format(" (standard deviations %.2f, %.2f)", sigma(0), sigma(1)));
  output.say(format("principal point      %.2f, %.2f px", camera.cx(), camera.cy()) +
    format(" (standard deviations %.2f, %.2f)", sigma(2), sigma(3)));
  static const char* const names[] = { "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6" };
  for (std::size_t i = 0; i < result.coefficientSigmas.size(); ++i)
  {
    output.say("  " + std::string(names[i]) +
      format("                 %10.5f (%.5f)", camera.distortionCoefficients()[i], result.coefficientSigmas[i]));
  }
  for (const LensModelComparison& model : result.models)
  {
    output.say("model                " + std::to_string(model.coefficients) +
      format(" coefficients: %.4f px RMS, focal length %.2f px", model.rmsPx, model.focalPx));
  }
  if (!result.modelHint.empty())
  {
    output.say("model                " + result.modelHint);
  }
  output.say(title("verdict" + label) + result.message);
}

void writeLens(const std::string& path, const LensCalibrationResult& result, const CommandOutput& output)
{
  std::vector<std::string> warnings;
  io::CameraFileExtras extras;
  extras.reprojectionErrorPx = result.rmsPx;
  io::writeCameraFile(path, { *result.camera, std::nullopt, "OpenCV", {} }, io::CameraFormat::OpenCV, warnings, extras);
  output.warn(warnings);
}

void writeCoverage(const LensArguments& arguments, const LensPictures& eye, const LensCalibrationResult& result)
{
  if (!arguments.coverageFile.empty())
  {
    writeCoveragePicture(arguments.coverageFile, *eye.collector, result, eye.views, eye.width, eye.height);
    arguments.output.say("written to " + arguments.coverageFile);
  }
}

/// How an eye's lens varies where that was asked for.
void addRepetitions(const LensArguments& arguments, const LensPictures& eye, const LensCalibrationResult& result,
  const std::string& label, nlohmann::json& object)
{
  if (!result.isUsable() || arguments.repetitions == 0)
  {
    return;
  }
  LensRepetitionOptions repetition;
  repetition.repetitions = arguments.repetitions;
  const LensRepetition repeated = repeatLensCalibration(
    eye.views, eye.width, eye.height, arguments.lens, repetition, arguments.output.progress("calibrating again,"));
  object["repetitions"] = repetitionJson(repeated);
  arguments.output.say(title("repeated" + label) + std::to_string(repeated.results.size()) +
    format(" times with 60 %% of the views: focal length %.2f px +- %.2f", repeated.fx.mean, repeated.fx.standardDeviation) +
    format("; rays move by %.2f px, %.2f at most", repeated.meanShiftPx, repeated.maximumShiftPx));
}

int runOne(LensArguments& arguments, const BoardDescription& board)
{
  const LensPictures eye = arguments.sources.isAskedFor()
    ? watchLensPictures(arguments.sources, board, arguments.collector, arguments.live, arguments.output)
    : readLensPictures(arguments.recording, board, arguments.collector, arguments.all, "", arguments.output);
  if (!eye.problem.empty())
  {
    arguments.output.warn({ eye.problem });
  }
  if (!eye.collector)
  {
    nlohmann::json object = lensJson({}, board, {}, nullptr);
    object["status"] = "no_pictures";
    object["message"] = eye.problem;
    object["sources"] = arguments.sources.statusJson();
    return arguments.output.finish(object);
  }
  const LensCalibrationResult result = calibrateLens(eye.views, eye.width, eye.height, arguments.lens);
  sayEye(arguments, eye, result, "");
  nlohmann::json object = lensJson(result, board, eye.frames, &*eye.collector);
  if (arguments.sources.isAskedFor())
  {
    object["sources"] = arguments.sources.statusJson();
  }
  addRepetitions(arguments, eye, result, "", object);
  writeCoverage(arguments, eye, result);
  return arguments.output.finish(object, [&](const std::string& path) { writeLens(path, result, arguments.output); });
}

/// Four rows of four numbers, as `handeye calibrate --left-to-right` reads them.
void writeTransform(const std::string& path, const Eigen::Isometry3d& transform)
{
  std::string text;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      text += format("%.12g", transform.matrix()(row, column)) + (column < 3 ? " " : "\n");
    }
  }
  io::writeFileAtomically(path, text);
}

int runStereo(const LensArguments& arguments, const BoardDescription& board)
{
  // The eyes have to see the same moments: no picking of views of one of them.
  const LensPictures left = readLensPictures(arguments.recording, board, arguments.collector, true, " (left)", arguments.output);
  const LensPictures right = readLensPictures(arguments.right, board, arguments.collector, true, " (right)", arguments.output);
  const StereoLensResult result =
    calibrateStereoLens(left.views, left.width, left.height, right.views, right.width, right.height, arguments.lens);
  sayEye(arguments, left, result.left, ", left");
  sayEye(arguments, right, result.right, ", right");
  nlohmann::json object = { { "schema", "handeye-stereo-lens/1" }, { "status", toString(result.status) },
    { "message", result.message }, { "left", lensJson(result.left, board, left.frames, &*left.collector) },
    { "right", lensJson(result.right, board, right.frames, &*right.collector) } };
  addRepetitions(arguments, left, result.left, ", left", object["left"]);
  addRepetitions(arguments, right, result.right, ", right", object["right"]);
  if (result.isUsable())
  {
    object["leftToRight"] = toJson(result.leftToRight);
    object["covariance"] = toJson(result.covariance);
    object["rmsPx"] = result.rmsPx;
    object["pairFrames"] = result.frames;
    arguments.output.say("leftToRight (mm)\n" + matrixLines(result.leftToRight.matrix(), "  ", 4));
    arguments.output.say("verdict, pair        " + result.message);
  }
  writeCoverage(arguments, left, result.left);
  return arguments.output.finish(object,
    [&](const std::string& path)
    {
      writeLens(path, result.left, arguments.output);
      if (!arguments.rightFile.empty())
      {
        writeLens(arguments.rightFile, result.right, arguments.output);
        arguments.output.say("written to " + arguments.rightFile);
      }
      if (!arguments.leftToRightFile.empty())
      {
        writeTransform(arguments.leftToRightFile, result.leftToRight);
        arguments.output.say("written to " + arguments.leftToRightFile);
      }
    });
}

int runLens(LensArguments& arguments)
{
  const bool isLive = arguments.sources.isAskedFor();
  if (isLive == !arguments.recording.empty())
  {
    throw CLI::ValidationError("handeye camera calibrate",
      isLive ? "takes a RECORDING or a live video (--server, --video, --replay), not both"
             : "needs the pictures of the board: a RECORDING, or a live video (--server, --video, --replay)");
  }
  for (const CLI::Option* const option : arguments.liveOptions)
  {
    if (!isLive && option->count() > 0)
    {
      throw CLI::ValidationError(option->get_name(), "goes with a live video only (--server, --video, --replay)");
    }
  }
  if (isLive && (!arguments.right.empty() || arguments.all))
  {
    throw CLI::ValidationError(arguments.right.empty() ? "--all" : "--right",
      "goes with a RECORDING only: of a live video still, sharp and new views of one eye are taken");
  }
  arguments.collector.stillFrames = arguments.stillFrames > 0 ? arguments.stillFrames
    : isLive                                                  ? LensViewCollectorOptions().stillFrames
                                                              : 1;
  const BoardDescription board = parseBoard(arguments.board);
  arguments.lens.rejectOutlierViews = !arguments.keepOutliers;
  arguments.lens.circleDiameterMm = arguments.circleDiameterMm >= 0 ? arguments.circleDiameterMm : printedCircleDiameterMm(board);
  return arguments.right.empty() ? runOne(arguments, board) : runStereo(arguments, board);
}

}  // namespace

void addCameraCalibrateCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<LensArguments>();
  CLI::App* command = cameraGroup(app)->add_subcommand("calibrate", "Find a lens from pictures of a board");
  command
    ->add_option("recording", arguments->recording,
      "Pictures of the board: a folder with frames/, or a sequence metafile; or a live video, see below")
    ->type_name("RECORDING");
  arguments->sources.addPicturesTo(*command);
  command->add_option("--seconds", arguments->live.seconds, "Of a live video: at most so much stream time")
    ->check(CLI::PositiveNumber)
    ->type_name("SEC");
  command
    ->add_option("--store-pictures", arguments->live.storeFolder,
      "Of a live video: store the pictures of the views in this folder, to be used again as a RECORDING")
    ->type_name("DIR");
  for (const char* const name : { "--seconds", "--store-pictures", "--speed", "--image", "--wait" })
  {
    arguments->liveOptions.push_back(command->get_option(name));
  }
  addBoardOption(*command, arguments->board);
  command->add_option("--model", arguments->lens.coefficients, "Distortion coefficients: k1 k2 p1 p2, and k3, and k4 k5 k6")
    ->check(CLI::IsMember({ 4, 5, 8 }))
    ->type_name("4|5|8")
    ->capture_default_str();
  command->add_flag("--all", arguments->all, "Use every picture that shows the board, not only those that are sharp and new");
  command
    ->add_option("--still-frames", arguments->stillFrames,
      "The board has stood still for so many pictures; otherwise 3 of a live video, 1 of a recording")
    ->check(CLI::Range(1, 1000));
  command->add_flag("--keep-all", arguments->keepOutliers, "Use all views, also those that disagree with the rest");
  command
    ->add_option("--circle-diameter", arguments->circleDiameterMm,
      "Of a circle grid's circles, mm; otherwise that of the boards printed by `handeye camera board`; 0: do not correct for it")
    ->check(CLI::Range(0.0, 1000.0))
    ->type_name("MM");
  command
    ->add_option(
      "--repeat", arguments->repetitions, "Calibrate so many times from random parts of the views, and say how it varies")
    ->check(CLI::Range(2, 1000))
    ->type_name("N");
  command->add_option("--coverage", arguments->coverageFile, "Draw where the image has points, and their errors, to this picture")
    ->type_name("PNG");
  CLI::Option* right = command->add_option("--right", arguments->right, "The same moments seen by the right eye of a stereo pair");
  right->type_name("RECORDING");
  command->add_option("--right-output", arguments->rightFile, "Write the right lens to this file")->needs(right)->type_name("FILE");
  command->add_option("--left-to-right", arguments->leftToRightFile, "Write the eyes' relation, p_Right = M * p_Left, to this file")
    ->needs(right)
    ->type_name("4x4-FILE");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runLens(*arguments); });
}

}  // namespace handeye::cli
