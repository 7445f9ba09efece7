// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeStudy.h"

#include "StudyPool.h"
#include "StudyTasks.h"

#include <algorithm>
#include <stdexcept>

namespace handeye::study
{

namespace
{

std::vector<StudyCamera> chosenCameras(const std::vector<std::string>& names)
{
  std::vector<StudyCamera> chosen;
  std::string known;
  for (const StudyCamera& camera : studyCameras())
  {
    known += (known.empty() ? "" : ", ") + camera.name;
    if (names.empty() || std::find(names.begin(), names.end(), camera.name) != names.end())
    {
      chosen.push_back(camera);
    }
  }
  for (const std::string& name : names)
  {
    if (std::none_of(chosen.begin(), chosen.end(), [&](const StudyCamera& camera) { return camera.name == name; }))
    {
      throw std::invalid_argument("'" + name + "' is no camera of the study; there are: " + known);
    }
  }
  return chosen;
}

/// Noise of the features: measured, unless there is to be none.
void prepareNoise(const StudyOptions& options, const StudyPictures* pictures, StudyCameraResult& result)
{
  if (options.isNoiseFree)
  {
    return;
  }
  result.measured =
    measureFeatureNoise(result.camera, result.camera.eyes.front(), *pictures, options.noisePictures, options.seed + 4711U);
  if (result.measured.ballsFound < 2 || result.measured.boardsFound < 2)
  {
    throw std::runtime_error("ball or board are not found in the rendered pictures of the " + result.camera.name);
  }
  result.noise = { options.trackingSigmaMm, options.trackingSigmaDeg * double(EIGEN_PI) / 180, result.measured.ballSigmaPx,
    options.cornerSigmaPx < 0 ? result.measured.cornerSigmaPx : options.cornerSigmaPx, options.lensFocalShare, options.lensCenterPx,
    options.boardScaleShare };
}

}  // namespace

void StudyOptions::check() const
{
  if (repetitions < 1 || jobs < 1 || noisePictures < 4 || subsetRepetitions < 0 || renderedRepetitions < 0 || tiltRepetitions < 0 ||
    conditionRepetitions < 0)
  {
    throw std::invalid_argument("a study needs at least one repetition, one job and four pictures for the noise");
  }
  if (size.ballSamples < 6 || size.boardViews < 3 || size.validationSamples < 1 || size.pivotPoses < 50)
  {
    throw std::invalid_argument(
      "a repetition needs 6 balls, 3 views of the board, one validation sample and 50 pivot poses at least");
  }
  if (!(trackingSigmaMm >= 0) || !(trackingSigmaDeg >= 0) || !(branchAndBoundSec >= 0) ||
    !(lensFocalShare >= 0 && lensFocalShare < 0.1) || !(lensCenterPx >= 0) || !(boardScaleShare >= 0 && boardScaleShare < 0.1))
  {
    throw std::invalid_argument(
      "noise and time limit must not be negative, and the errors of the focal length and of the board's size are below a tenth");
  }
  if (!(size.boardTiltDeg >= 1 && size.boardTiltDeg <= 70) || !(size.boardRollDeg >= 0 && size.boardRollDeg <= 180))
  {
    throw std::invalid_argument("the board is tilted by 1 to 70 degrees and turned by 0 to 180");
  }
  (void)chosenCameras(cameras);
}

StudyResult runStudy(const StudyOptions& options)
{
  options.check();
  StudyResult result;
  result.options = options;
  std::vector<std::unique_ptr<StudyPictures>> pictures;
  for (const StudyCamera& camera : chosenCameras(options.cameras))
  {
    pictures.push_back(options.isNoiseFree ? nullptr : std::make_unique<StudyPictures>(camera, camera.eyes.front()));
    result.cameras.push_back({});
    result.cameras.back().camera = camera;
    prepareNoise(options, pictures.back().get(), result.cameras.back());
  }
  std::vector<StudyTask> tasks = planTasks(options, result.cameras);
  result.wasStopped = !runTasks(options, result.cameras, pictures, tasks);
  for (std::size_t i = 0; i < result.cameras.size(); ++i)
  {
    poolTasks(tasks, int(i), result.cameras[i]);
    result.claims.push_back(judgeClaim(result.cameras[i]));
  }
  result.status = result.wasStopped ? "stopped" : "ok";
  result.message = result.wasStopped ? "stopped before all repetitions were done" : "";
  for (const StudyClaim& claim : result.claims)
  {
    result.message += (result.message.empty() ? "" : " ") + claim.message;
  }
  return result;
}

}  // namespace handeye::study
