// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardHandEye.h"

#include "BoardHandEyeViews.h"
#include "NumberWords.h"
#include "PointLineRegistration.h"
#include "RigidTransform.h"

namespace handeye
{

namespace
{

using Method = BoardHandEyeOptions::Method;
using Status = BoardHandEyeResult::Status;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double DegPerRad = 180 / EIGEN_PI;
constexpr int FewestViews = 3;
/// Groups of views that the jackknife leaves out, one at a time.
constexpr int MostGroups = 30;

bool isTrackedBoard(Method method)
{
  return method == Method::TrackedBoard || method == Method::TrackedBoardLines;
}

/// The views that can be used, and their poses.
struct Problem
{
  std::vector<const BoardHandEyeView*> views;
  std::vector<HandEyePoses> poses;
  std::vector<HandEyeMotion> motions;
};

Problem problemOf(const std::vector<BoardHandEyeView>& views, const std::vector<BoardHandEyeResult::View>& found,
  const BoardHandEyeOptions& options)
{
  Problem problem;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    if (found[i].used)
    {
      problem.views.push_back(&views[i]);
      problem.poses.push_back({ views[i].markerToTracker, found[i].boardToCamera });
    }
  }
  problem.motions = isTrackedBoard(options.method) ? problem.motions : motionsOf(problem.poses, options.minimumTurnRad);
  return problem;
}

/// Arun's least squares for paired points (Voruganti and Bartz; Chen et al.).
Eigen::Isometry3d registerPairs(
  const std::vector<Eigen::Vector3d>& points_Marker, const std::vector<Eigen::Vector3d>& points_Camera)
{
  Eigen::Matrix3Xd from(3, Eigen::Index(points_Marker.size())), to(3, from.cols());
  for (Eigen::Index i = 0; i < from.cols(); ++i)
  {
    from.col(i) = points_Marker[std::size_t(i)];
    to.col(i) = points_Camera[std::size_t(i)];
  }
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

struct Solved
{
  Status status = Status::Ok;
  std::string message;
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();
};

Solved solveTrackedBoard(const Problem& problem, const CameraModel& camera, Method method)
{
  std::vector<Eigen::Vector3d> points_Marker, points_Camera;
  std::vector<PointLinePair> pairs;
  for (std::size_t i = 0; i < problem.views.size(); ++i)
  {
    const BoardHandEyeView& view = *problem.views[i];
    const Eigen::Isometry3d boardToMarker = view.markerToTracker.inverse() * *view.boardToTracker;
    for (std::size_t k = 0; k < view.ids.size(); ++k)
    {
      points_Marker.push_back(boardToMarker * view.points_Board[k]);
      points_Camera.push_back(problem.poses[i].boardToCamera * view.points_Board[k]);
      const CameraModel::Unprojection seen = camera.unproject(view.points_Image[k]);
      if (seen.isUsable())
      {
        // Distances across the ray grow with the depth, what the pixels see does not.
        const double depth = points_Camera.back().norm();
        pairs.push_back({ points_Marker.back(), Eigen::Vector3d::Zero(), seen.ray_Camera, 1 / (depth * depth) });
      }
    }
  }
  Solved solved;
  if (method == Method::TrackedBoard)
  {
    solved.markerToCamera = registerPairs(points_Marker, points_Camera);
    return solved;
  }
  PointLineOptions options;
  options.linesAreRays = true;
  const PointLineResult lines = registerPointsToLines(pairs, options);
  solved.status = lines.isUsable() ? Status::Ok : Status::PoorFit;
  solved.message = lines.isUsable() ? std::string() : "point-to-line registration: " + lines.message;
  solved.markerToCamera = lines.pointsToLines;
  return solved;
}

Solved solveMotions(const std::vector<HandEyeMotion>& motions, Method method)
{
  Solved solved;
  switch (method)
  {
    case Method::Tsai:
      solved.markerToCamera = solveTsai(motions);
      break;
    case Method::Horaud:
      solved.markerToCamera = solveHoraud(motions);
      break;
    case Method::Daniilidis:
      solved.markerToCamera = solveDaniilidis(motions);
      break;
    default:
      solved.markerToCamera = solvePark(motions);
      break;
  }
  return solved;
}

std::string describe(const BranchAndBoundState& state)
{
  const std::string error = "largest epipolar error " + fixedDigits(1000 * state.bestErrorRad, 3) + " mrad, ";
  const std::string gap = fixedDigits(1000 * state.gapRad, 3) + " mrad";
  return state.isProven ? error + "proven to be within " + gap + " of the least there is"
                        : error + "not proven to be the least: a gap of " + gap + " is left";
}

Solved solveBranchAndBound(const Problem& problem, const CameraModel& camera, const BoardHandEyeOptions& options,
  const BranchAndBoundProgress& progress, BoardHandEyeResult& result)
{
  const std::vector<HandEyeMotion> selected = selectMotions(problem.motions, options.maximumPairs);
  const std::vector<EpipolarPair> pairs = epipolarPairs(selected, problem.views, camera, options.pointsPerPair);
  result.pairCount = int(pairs.size());
  const std::optional<Eigen::Isometry3d> start =
    options.startFromClosedForm ? std::optional(solvePark(problem.motions)) : std::nullopt;
  const EpipolarSearchResult search = searchEpipolar(pairs, start, options, progress);
  result.branchAndBound = search.state;
  Solved solved;
  if (!search.solution)
  {
    solved.status = Status::NotFound;
    solved.message =
      search.isCancelled ? "the search was cancelled before it had a solution" : "the search had no solution when its time ran out";
    return solved;
  }
  solved.markerToCamera.linear() = search.solution->markerToCamera;
  solved.markerToCamera.translation() = -(search.solution->markerToCamera * search.solution->center_Marker);
  solved.message = describe(search.state);
  return solved;
}

/// (rotation vector, translation) that takes one transform to another from the left.
Vector6 difference(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to)
{
  const Eigen::Isometry3d step = to * from.inverse();
  const Eigen::AngleAxisd turn(step.linear());
  Vector6 vector;
  vector << turn.angle() * turn.axis(), to.translation() - step.linear() * from.translation();
  return vector;
}

/// The problem without the views of one group.
Problem without(const Problem& problem, int group, int groups, const BoardHandEyeOptions& options)
{
  Problem rest;
  std::vector<int> newIndex(problem.views.size(), -1);
  for (std::size_t i = 0; i < problem.views.size(); ++i)
  {
    if (int(i) % groups != group)
    {
      newIndex[i] = int(rest.views.size());
      rest.views.push_back(problem.views[i]);
      rest.poses.push_back(problem.poses[i]);
    }
  }
  for (const HandEyeMotion& motion : problem.motions)
  {
    if (newIndex[std::size_t(motion.from)] >= 0 && newIndex[std::size_t(motion.to)] >= 0)
    {
      rest.motions.push_back(motion);
    }
  }
  const bool isEnough = isTrackedBoard(options.method)
    ? !rest.views.empty()
    : rest.motions.size() >= 2 && axisSpreadRad(rest.motions) > options.minimumAxisSpreadRad / 2;
  return isEnough ? rest : Problem();
}

std::optional<Eigen::Matrix<double, 6, 6>> jackknife(
  const Problem& problem, const CameraModel& camera, const BoardHandEyeOptions& options, const Eigen::Isometry3d& markerToCamera)
{
  const int groups = std::min(int(problem.views.size()), MostGroups);
  std::vector<Vector6> differences;
  Vector6 mean = Vector6::Zero();
  for (int group = 0; group < groups; ++group)
  {
    const Problem rest = without(problem, group, groups, options);
    if (rest.views.empty())
    {
      return std::nullopt;
    }
    const Solved solved =
      isTrackedBoard(options.method) ? solveTrackedBoard(rest, camera, options.method) : solveMotions(rest.motions, options.method);
    if (solved.status != Status::Ok || !solved.markerToCamera.matrix().allFinite())
    {
      return std::nullopt;
    }
    differences.push_back(difference(markerToCamera, solved.markerToCamera));
    mean += differences.back() / groups;
  }
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Vector6& each : differences)
  {
    covariance += double(groups - 1) / groups * (each - mean) * (each - mean).transpose();
  }
  return covariance;
}

/// Whether there is enough to begin with.
bool isEnough(const std::vector<BoardHandEyeView>& views, const Problem& problem, const BoardHandEyeOptions& options,
  BoardHandEyeResult& result)
{
  const int needed = isTrackedBoard(options.method) ? 1 : FewestViews;
  const auto fail = [&](Status status, const std::string& message)
  {
    result.status = status;
    result.message = message;
    return false;
  };
  if (int(views.size()) < needed)
  {
    return fail(Status::TooFewViews,
      std::to_string(views.size()) + " views of the board, at least " + std::to_string(needed) + " are needed");
  }
  if (result.usedCount < needed)
  {
    return fail(Status::NoBoardPose,
      "the board's pose was found in " + std::to_string(result.usedCount) + " of " + std::to_string(views.size()) +
        " views, at least " + std::to_string(needed) + " are needed");
  }
  if (isTrackedBoard(options.method))
  {
    for (const BoardHandEyeView* view : problem.views)
    {
      if (!view->boardToTracker)
      {
        return fail(
          Status::NoTrackedBoard, "the board is not tracked in frame " + std::to_string(view->frame) + ", which this method needs");
      }
    }
    return true;
  }
  const double spread = axisSpreadRad(problem.motions);
  if (problem.motions.size() < 2 || spread < options.minimumAxisSpreadRad)
  {
    return fail(Status::ParallelMotions,
      problem.motions.size() < 2
        ? "the camera hardly turned between the views: turn it about different axes, by 30 degrees and more"
        : "the camera always turned about the same axis (another one by " + fixedDigits(spread * DegPerRad, 1) +
          " degrees at most): turn it about a second one");
  }
  return true;
}

void judgeFit(const BoardHandEyeOptions& options, BoardHandEyeResult& result)
{
  const std::string left = fixedDigits(result.rmsRad * DegPerRad, 2) + " degrees and " + fixedDigits(result.rmsMm, 1) + " mm";
  if (!result.markerToCamera.matrix().allFinite() || !(result.rmsRad <= options.maximumRotationRmsRad) ||
    !(result.rmsMm <= options.maximumRmsMm))
  {
    result.status = Status::PoorFit;
    result.message = "the views do not agree: camera and tracker differ by " + left +
      " RMS. Was the board moved, is a transform the wrong way round, or is this another lens?";
    return;
  }
  result.status = Status::Ok;
  result.message = (result.message.empty() ? std::string() : result.message + "; ") + "camera and tracker differ by " + left +
    ", " + fixedDigits(result.reprojectionRmsPx, 2) + " px RMS over " + std::to_string(result.usedCount) +
    " views that were fitted";
}

}  // namespace

void BoardHandEyeOptions::check() const
{
  const auto require = [](bool isGood, const char* what)
  {
    if (!isGood)
    {
      throw std::invalid_argument(std::string("BoardHandEyeOptions: ") + what);
    }
  };
  require(minimumTurnRad > 0 && minimumTurnRad < 1.5, "minimumTurnRad is between 0 and 1.5");
  require(minimumAxisSpreadRad > 0 && minimumAxisSpreadRad < EIGEN_PI / 4, "minimumAxisSpreadRad is between 0 and pi / 4");
  require(maximumRotationRmsRad > 0 && maximumRmsMm > 0, "maximumRotationRmsRad and maximumRmsMm are positive");
  require(gapRad > 0 && relativeGap >= 0 && relativeGap < 1, "gapRad is positive and relativeGap between 0 and 1");
  require(timeLimitSec > 0, "timeLimitSec is positive");
  require(maximumOffsetMm > 0 && std::isfinite(maximumOffsetMm), "maximumOffsetMm is positive");
  require(maximumPairs >= 2 && pointsPerPair >= 1, "maximumPairs is at least 2 and pointsPerPair at least 1");
}

BoardHandEyeResult calibrateBoardHandEye(const std::vector<BoardHandEyeView>& views, const CameraModel& camera,
  const BoardHandEyeOptions& options, const BranchAndBoundProgress& progress)
{
  options.check();
  checkViews(views);
  BoardHandEyeResult result;
  result.views = posesOf(views, camera);
  const Problem problem = problemOf(views, result.views, options);
  result.usedCount = int(problem.views.size());
  result.pairCount = int(problem.motions.size());
  if (!isEnough(views, problem, options, result))
  {
    return result;
  }
  const bool isSearch = options.method == Method::BranchAndBound;
  const Solved solved = isTrackedBoard(options.method) ? solveTrackedBoard(problem, camera, options.method)
    : isSearch                                         ? solveBranchAndBound(problem, camera, options, progress, result)
                                                       : solveMotions(problem.motions, options.method);
  result.status = solved.status;
  result.message = solved.message;
  if (solved.status != Status::Ok)
  {
    return result;
  }
  result.markerToCamera = solved.markerToCamera;
  result.boardToTracker = isTrackedBoard(options.method) ? *problem.views.front()->boardToTracker
                                                         : averageBoardToTracker(views, result.views, result.markerToCamera);
  addResiduals(views, camera, isTrackedBoard(options.method), result);
  judgeFit(options, result);
  if (result.isUsable() && !isSearch)
  {
    result.covariance = jackknife(problem, camera, options, result.markerToCamera);
  }
  return result;
}

std::string toString(BoardHandEyeResult::Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewViews:
      return "too_few_views";
    case Status::ParallelMotions:
      return "parallel_motions";
    case Status::NoBoardPose:
      return "no_board_pose";
    case Status::NoTrackedBoard:
      return "no_tracked_board";
    case Status::PoorFit:
      return "poor_fit";
    case Status::NotFound:
      return "not_found";
  }
  return "unknown";
}

std::string toString(BoardHandEyeOptions::Method method)
{
  switch (method)
  {
    case Method::Tsai:
      return "tsai";
    case Method::Park:
      return "park";
    case Method::Horaud:
      return "horaud";
    case Method::Daniilidis:
      return "daniilidis";
    case Method::BranchAndBound:
      return "branch-and-bound";
    case Method::TrackedBoard:
      return "tracked-board";
    case Method::TrackedBoardLines:
      return "tracked-board-lines";
  }
  return "unknown";
}

}  // namespace handeye
