// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyTasks.h"

#include "ComparedBoardMethods.h"
#include "StudyConditions.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace handeye::study
{

namespace
{

constexpr int MostSubsetSamples = 30;
constexpr double TiltsDeg[] = { 5, 10, 15, 20, 30, 45 };
constexpr int TiltSearches = 5;  ///< repetitions of a range that have a branch and bound: it takes thousands of times as long

class TaskRunner
{
public:
  TaskRunner(const StudyOptions& options, const std::vector<StudyCameraResult>& cameras,
    const std::vector<std::unique_ptr<StudyPictures>>& pictures, std::vector<StudyTask>& tasks)
    : options_(options)
    , cameras_(cameras)
    , pictures_(pictures)
    , tasks_(tasks)
  {
  }

  bool run()
  {
    std::vector<std::thread> threads;
    for (int i = 1; i < options_.jobs; ++i)
    {
      threads.emplace_back([this] { this->work(); });
    }
    this->work();
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    if (failure_)
    {
      std::rethrow_exception(failure_);
    }
    return !isStopped_;
  }

private:
  void work()
  {
    for (std::size_t i = next_++; i < tasks_.size() && !isStopped_; i = next_++)
    {
      try
      {
        runTask(tasks_[i]);
        const std::lock_guard<std::mutex> lock(mutex_);
        ++done_;
        const StudyTask& task = tasks_[i];
        const std::string what =
          cameras_[std::size_t(task.camera)].camera.name + ", repetition " + std::to_string(task.repetition + 1);
        if (options_.progress && !options_.progress(what, done_, int(tasks_.size())))
        {
          isStopped_ = true;
        }
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        failure_ = failure_ ? failure_ : std::current_exception();
        isStopped_ = true;
      }
    }
  }

  HandEyeCalibrationOptions ballOptions(const StudyTask& task, const StudyTrial& trial) const
  {
    HandEyeCalibrationOptions options;
    options.tipCovariance_Stylus = trial.tipCovariance_Stylus;
    options.rejectOutliers = task.isRendered;  // projected features are never wrong, and the search for such is most of the time
    if (!options_.isNoiseFree)
    {
      options.segmentationSigmaPx = task.noise.ballSigmaPx;
    }
    return options;
  }

  BoardMethodsOptions boardOptions(bool withBranchAndBound)
  {
    BoardMethodsOptions options;
    options.withBranchAndBound = withBranchAndBound;
    options.options.timeLimitSec = withBranchAndBound ? options_.branchAndBoundSec : 1;
    options.progress = [this](const BranchAndBoundState&) { return !isStopped_.load(); };
    return options;
  }

  std::vector<MethodResult> compare(
    const StudyTask& task, const StudyTrial& trial, bool withBranchAndBound, const ComparisonOptions& options)
  {
    std::vector<ComparedMethod> methods = ballMethods({ trial.ball }, trial.lens, ballOptions(task, trial));
    const std::vector<ComparedMethod> classical = boardMethods({ trial.board }, trial.lens, boardOptions(withBranchAndBound));
    methods.insert(methods.end(), classical.begin(), classical.end());
    return compareMethods(methods, trial.validation, trial.lens, options).methods;
  }

  void runTask(StudyTask& task)
  {
    const StudyCameraResult& camera = cameras_[std::size_t(task.camera)];
    const StudyEye& eye = camera.camera.eyes[std::size_t(task.eye)];
    const StudyPictures* pictures = task.isRendered ? pictures_[std::size_t(task.camera)].get() : nullptr;
    const StudyTrial trial = makeTrial(camera.camera, eye, task.noise, task.size, task.seed, pictures);
    ComparisonOptions comparison;
    comparison.subsetRepetitions = comparison.halvings = 0;
    task.methods = compare(task, trial, task.hasBranchAndBound && options_.branchAndBoundSec > 0, comparison);
    task.trueMethods = task.methods;
    for (MethodResult& method : task.trueMethods)
    {
      ComparedCapture& capture = method.captures.front();
      if (capture.answer.isUsable())
      {
        capture.validation = validateHandEye(trial.trueValidation, trial.lens, *capture.answer.markerToCamera);
      }
    }
    for (const HandEyeValidationSample& sample : validateHandEye(trial.validation, eye.camera, eye.markerToCamera).samples)
    {
      task.floorPx.push_back(sample.errorPx);
    }
    if (task.hasSubsets)
    {
      TrialSize size = task.size;
      size.ballSamples = size.boardViews = MostSubsetSamples;
      comparison.subsetRepetitions = 1;
      comparison.seed = task.seed;
      task.subsets = compare(task, makeTrial(camera.camera, eye, task.noise, size, task.seed + 1U), false, comparison);
    }
    task.isDone = true;
  }

  const StudyOptions& options_;
  const std::vector<StudyCameraResult>& cameras_;
  const std::vector<std::unique_ptr<StudyPictures>>& pictures_;
  std::vector<StudyTask>& tasks_;
  std::atomic<std::size_t> next_{ 0 };
  std::atomic<bool> isStopped_{ false };
  std::mutex mutex_;
  int done_ = 0;
  std::exception_ptr failure_;
};

/// The reason why the methods with a board do well or badly: how far the camera was turned.
void planTilts(const StudyOptions& options, int camera, const StudyNoise& noise, std::vector<StudyTask>& tasks)
{
  for (const double tiltDeg : TiltsDeg)
  {
    for (int repetition = 0; repetition < options.tiltRepetitions && !options.isNoiseFree; ++repetition)
    {
      StudyTask task;
      task.camera = camera;
      task.repetition = repetition;
      task.tiltDeg = tiltDeg;
      task.noise = noise;
      task.size = options.size;
      task.size.boardTiltDeg = tiltDeg;
      task.size.boardRollDeg = tiltDeg * 4 / 3;
      task.hasBranchAndBound = repetition < TiltSearches;
      task.seed = options.seed * 1000003U + unsigned(camera) * 100003U + unsigned(repetition) * 7U + 3U;
      tasks.push_back(task);
    }
  }
}

/// The other reasons, one at a time. The same repetitions for each: what differs is the condition.
void planConditions(const StudyOptions& options, int camera, const StudyNoise& noise, std::vector<StudyTask>& tasks)
{
  for (const StudyCondition& condition : studyConditions(options.size, noise))
  {
    for (int repetition = 0; repetition < options.conditionRepetitions && !options.isNoiseFree; ++repetition)
    {
      StudyTask task;
      task.camera = camera;
      task.repetition = repetition;
      task.condition = condition.words;
      task.noise = condition.noise;
      task.size = condition.size;
      task.hasBranchAndBound = false;
      task.seed = options.seed * 1000003U + unsigned(camera) * 100003U + unsigned(repetition) * 7U + 5U;
      tasks.push_back(task);
    }
  }
}

}  // namespace

std::vector<StudyTask> planTasks(const StudyOptions& options, const std::vector<StudyCameraResult>& cameras)
{
  std::vector<StudyTask> tasks;
  for (std::size_t camera = 0; camera < cameras.size(); ++camera)
  {
    for (int repetition = 0; repetition < options.repetitions; ++repetition)
    {
      for (std::size_t eye = 0; eye < cameras[camera].camera.eyes.size(); ++eye)
      {
        StudyTask task;
        task.camera = int(camera);
        task.eye = int(eye);
        task.repetition = repetition;
        task.noise = cameras[camera].noise;
        task.size = options.size;
        task.hasSubsets = repetition < options.subsetRepetitions && eye == 0;
        task.seed = options.seed * 1000003U + unsigned(camera) * 100003U + unsigned(eye) * 50021U + unsigned(repetition) * 7U;
        tasks.push_back(task);
        // Rendered pictures are those of the first eye.
        if (repetition < options.renderedRepetitions && eye == 0 && !options.isNoiseFree)
        {
          task.isRendered = true;
          task.hasSubsets = false;
          tasks.push_back(task);
        }
      }
    }
    planTilts(options, int(camera), cameras[camera].noise, tasks);
    planConditions(options, int(camera), cameras[camera].noise, tasks);
  }
  return tasks;
}

bool runTasks(const StudyOptions& options, const std::vector<StudyCameraResult>& cameras,
  const std::vector<std::unique_ptr<StudyPictures>>& pictures, std::vector<StudyTask>& tasks)
{
  return TaskRunner(options, cameras, pictures, tasks).run();
}

}  // namespace handeye::study
