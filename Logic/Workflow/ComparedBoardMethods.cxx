// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparedBoardMethods.h"

#include "NumberWords.h"

#include <algorithm>
#include <chrono>
#include <memory>

namespace handeye
{

namespace
{

using Method = BoardHandEyeOptions::Method;
using Views = std::vector<BoardHandEyeView>;

struct Captures
{
  std::vector<Views> captures;
  CameraModel camera;
  BoardMethodsOptions options;
};

/// What the branch and bound has proven, for a person.
std::string describeProof(const BranchAndBoundState& state)
{
  const auto mrad = [](double rad) { return significantDigits(1e3 * rad, 3) + " mrad"; };
  return std::string(state.isProven ? "proven" : "not proven to the gap asked for") + ": largest epipolar error " +
    mrad(state.bestErrorRad) + ", no solution is below " + mrad(state.lowerBoundRad) + " (" + std::to_string(state.cubes) +
    " cubes, " + std::to_string(state.linearPrograms) + " linear programs)";
}

MethodAnswer calibrateTimed(const Views& views, Method method, const Captures& shared)
{
  BoardHandEyeOptions options = shared.options.options;
  options.method = method;
  const auto start = std::chrono::steady_clock::now();
  const BoardHandEyeResult result = calibrateBoardHandEye(views, shared.camera, options, shared.options.progress);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  MethodAnswer answer;
  answer.status = toString(result.status);
  answer.message = result.message;
  answer.sampleCount = int(views.size());
  answer.usedCount = result.usedCount;
  answer.seconds = elapsed.count();
  if (result.isUsable())
  {
    answer.markerToCamera = result.markerToCamera;
  }
  const BranchAndBoundState& proof = result.branchAndBound;
  if (method == Method::BranchAndBound && result.isUsable() && proof.bestErrorRad > 0)
  {
    answer.gap = proof.gapRad / proof.bestErrorRad;
    answer.message = describeProof(proof);
  }
  return answer;
}

ComparedMethod makeMethod(const std::shared_ptr<const Captures>& shared, Method solver, const char* title, const char* reference)
{
  ComparedMethod method;
  method.name = toString(solver);
  method.title = title;
  method.reference = reference;
  method.target = ComparedMethod::Target::Board;
  for (const Views& views : shared->captures)
  {
    method.sampleCounts.push_back(int(views.size()));
  }
  method.calibrate = [shared, solver](int capture)
  { return calibrateTimed(shared->captures.at(std::size_t(capture)), solver, *shared); };
  if (solver == Method::BranchAndBound)
  {
    return method;  // seconds to minutes for each capture
  }
  method.subsetPool = method.sampleCounts.front();
  method.calibrateSome = [shared, solver](const std::vector<int>& samples)
  {
    Views views;
    for (const int sample : samples)
    {
      views.push_back(shared->captures.front().at(std::size_t(sample)));
    }
    return calibrateTimed(views, solver, *shared);
  };
  return method;
}

}  // namespace

std::vector<ComparedMethod> boardMethods(
  const std::vector<std::vector<BoardHandEyeView>>& captures, const CameraModel& camera, const BoardMethodsOptions& options)
{
  if (captures.empty())
  {
    return {};
  }
  const auto shared = std::make_shared<const Captures>(Captures{ captures, camera, options });
  std::vector<ComparedMethod> methods = {
    makeMethod(shared, Method::Tsai, "AX = XB, modified Rodrigues vectors", "Tsai, Lenz 1989"),
    makeMethod(shared, Method::Park, "AX = XB, logarithms (\"Navy\")", "Park, Martin 1994"),
    makeMethod(shared, Method::Horaud, "AX = XB, quaternions (\"Inria\")", "Horaud, Dornaika 1995"),
    makeMethod(shared, Method::Daniilidis, "AX = XB, dual quaternions (\"Dual\")", "Daniilidis 1999"),
  };
  if (options.withBranchAndBound)
  {
    methods.push_back(
      makeMethod(shared, Method::BranchAndBound, "branch and bound on the largest epipolar error", "Heller, Havlena, Pajdla 2012"));
  }
  const bool isTracked = std::any_of(captures.begin(), captures.end(),
    [](const Views& views) {
      return std::any_of(views.begin(), views.end(), [](const BoardHandEyeView& view) { return view.boardToTracker.has_value(); });
    });
  if (isTracked)
  {
    methods.push_back(
      makeMethod(shared, Method::TrackedBoard, "paired points of a tracked board", "Voruganti, Bartz 2008; Chen et al. 2012"));
    methods.push_back(
      makeMethod(shared, Method::TrackedBoardLines, "points of a tracked board on the rays of their pixels", "this program"));
  }
  return methods;
}

}  // namespace handeye
