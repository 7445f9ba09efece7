// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyPool.h"

#include "ComparisonSpread.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace handeye::study
{

namespace
{

MethodResult& methodOf(const MethodResult& like, std::vector<MethodResult>& methods)
{
  const auto found =
    std::find_if(methods.begin(), methods.end(), [&](const MethodResult& method) { return method.name == like.name; });
  if (found != methods.end())
  {
    return *found;
  }
  MethodResult method = like;
  method.captures.clear();
  method.subsets.clear();
  method.repeatability = {};
  methods.push_back(method);
  return methods.back();
}

void addCaptures(const std::vector<MethodResult>& from, std::vector<MethodResult>& to)
{
  for (const MethodResult& method : from)
  {
    MethodResult& pooled = methodOf(method, to);
    pooled.captures.insert(pooled.captures.end(), method.captures.begin(), method.captures.end());
  }
}

void finish(ComparisonResult& comparison)
{
  for (MethodResult& method : comparison.methods)
  {
    summarizeMethod(method);
    comparison.validationCount = std::max(comparison.validationCount, method.errorPx.count);
  }
  comparison.hasPairedCaptures = true;
  judgeComparison(comparison);
}

/// Medians over the repetitions, by method and size.
void poolSubsets(const std::vector<const StudyTask*>& tasks, std::vector<MethodResult>& methods)
{
  for (MethodResult& method : methods)
  {
    std::map<int, std::vector<double>> means;
    std::map<int, int> attempts;
    for (const StudyTask* task : tasks)
    {
      for (const MethodResult& one : task->subsets)
      {
        for (const SubsetErrors& subset : one.subsets)
        {
          if (one.name == method.name)
          {
            ++attempts[subset.sampleCount];
            if (std::isfinite(subset.medianPx))
            {
              means[subset.sampleCount].push_back(subset.medianPx);
            }
          }
        }
      }
    }
    for (const auto& [size, count] : attempts)
    {
      SubsetErrors pooled;
      pooled.sampleCount = size;
      pooled.repetitions = count;
      pooled.summarize(means[size]);
      method.subsets.push_back(pooled);
    }
  }
}

/// Spread of the first eye's calibrations over the repetitions, at the balls of the first repetition.
void poolSpread(const std::vector<const StudyTask*>& tasks, const StudyCameraResult& camera, std::vector<MethodResult>& methods)
{
  const StudyEye& eye = camera.camera.eyes.front();
  const TrialSize size;
  const std::vector<HandEyeSample> balls = makeTrial(camera.camera, eye, StudyNoise(), size, 1).trueValidation;
  for (MethodResult& method : methods)
  {
    std::vector<Eigen::Isometry3d> calibrations;
    for (const StudyTask* task : tasks)
    {
      for (const MethodResult& one : task->methods)
      {
        if (one.name == method.name && task->eye == 0)
        {
          ++method.repeatability.attempts;
          if (one.captures.front().answer.isUsable())
          {
            calibrations.push_back(*one.captures.front().answer.markerToCamera);
          }
        }
      }
    }
    measureSpread(calibrations, balls, eye.camera, method.repeatability);
  }
}

void addTilt(const StudyTask& task, std::vector<StudyTiltResult>& tilts)
{
  if (tilts.empty() || tilts.back().tiltDeg != task.tiltDeg)
  {
    tilts.push_back({ task.tiltDeg, {}, {} });
  }
  addCaptures(task.methods, tilts.back().comparison.methods);
  addCaptures(task.trueMethods, tilts.back().truth.methods);
}

void addCondition(const StudyTask& task, std::vector<StudyConditionResult>& conditions)
{
  if (conditions.empty() || conditions.back().words != task.condition)
  {
    conditions.push_back({ task.condition, {}, {} });
  }
  addCaptures(task.methods, conditions.back().comparison.methods);
  addCaptures(task.trueMethods, conditions.back().truth.methods);
}

}  // namespace

void poolTasks(const std::vector<StudyTask>& tasks, int camera, StudyCameraResult& result)
{
  std::vector<const StudyTask*> featureTasks;
  std::vector<double> floorPx;
  for (const StudyTask& task : tasks)
  {
    if (task.camera != camera || !task.isDone)
    {
      continue;
    }
    if (task.tiltDeg > 0)
    {
      addTilt(task, result.byTilt);
      continue;
    }
    if (!task.condition.empty())
    {
      addCondition(task, result.byCondition);
      continue;
    }
    if (task.isRendered)
    {
      addCaptures(task.methods, result.rendered.methods);
      ++result.renderedEyes;
      continue;
    }
    featureTasks.push_back(&task);
    addCaptures(task.methods, result.comparison.methods);
    addCaptures(task.trueMethods, result.truth.methods);
    floorPx.insert(floorPx.end(), task.floorPx.begin(), task.floorPx.end());
  }
  result.floorPx = summarize(floorPx);
  poolSubsets(featureTasks, result.comparison.methods);
  poolSpread(featureTasks, result, result.comparison.methods);
  finish(result.comparison);
  finish(result.truth);
  finish(result.rendered);
  for (StudyTiltResult& tilt : result.byTilt)
  {
    finish(tilt.comparison);
    finish(tilt.truth);
  }
  for (StudyConditionResult& condition : result.byCondition)
  {
    finish(condition.comparison);
    finish(condition.truth);
  }
}

}  // namespace handeye::study
