// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardHandEyeViews.h"

#include "BoardPose.h"
#include "RigidTransform.h"

#include <map>

namespace handeye
{

namespace
{

/// A few indices of points that are far from each other and from the middle: the furthest from all taken so far.
std::vector<std::size_t> spreadOut(const std::vector<Eigen::Vector3d>& points, int count)
{
  std::vector<std::size_t> taken;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
  {
    center += point / double(points.size());
  }
  const auto distance = [&](std::size_t i)
  {
    double nearest = taken.empty() ? (points[i] - center).norm() : std::numeric_limits<double>::infinity();
    for (const std::size_t other : taken)
    {
      nearest = std::min(nearest, (points[i] - points[other]).norm());
    }
    return nearest;
  };
  while (int(taken.size()) < std::min(count, int(points.size())))
  {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
    {
      best = distance(i) > distance(best) ? i : best;
    }
    taken.push_back(best);
  }
  return taken;
}

[[noreturn]] void failView(std::size_t view, const std::string& what)
{
  throw std::invalid_argument("calibrateBoardHandEye: view " + std::to_string(view) + " " + what);
}

bool isRigid(const Eigen::Isometry3d& transform)
{
  return transform.matrix().allFinite() && toRigid(transform.matrix()).has_value();
}

}  // namespace

void checkViews(const std::vector<BoardHandEyeView>& views)
{
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const BoardHandEyeView& view = views[i];
    if (view.ids.size() != view.points_Board.size() || view.ids.size() != view.points_Image.size())
    {
      failView(i,
        "has " + std::to_string(view.ids.size()) + " ids, but " + std::to_string(view.points_Board.size()) +
          " points of the board and " + std::to_string(view.points_Image.size()) + " of the image");
    }
    for (std::size_t k = 0; k < view.ids.size(); ++k)
    {
      if (!view.points_Board[k].allFinite() || !view.points_Image[k].allFinite())
      {
        failView(i, "has a point (" + std::to_string(k) + ") with a number that is not finite");
      }
    }
    if (!isRigid(view.markerToTracker) || (view.boardToCamera && !isRigid(*view.boardToCamera)) ||
      (view.boardToTracker && !isRigid(*view.boardToTracker)))
    {
      failView(i, "has a transform that is no rigid motion");
    }
  }
}

std::vector<BoardHandEyeResult::View> posesOf(const std::vector<BoardHandEyeView>& views, const CameraModel& camera)
{
  std::vector<BoardHandEyeResult::View> found;
  for (const BoardHandEyeView& view : views)
  {
    BoardHandEyeResult::View pose;
    if (view.boardToCamera)
    {
      pose.used = true;
      pose.boardToCamera = *view.boardToCamera;
    }
    else
    {
      const BoardPose estimated = estimateBoardPose(view.points_Board, view.points_Image, camera);
      pose.used = estimated.isUsable();
      pose.boardToCamera = estimated.boardToCamera;
      pose.message = estimated.isUsable() ? std::string() : estimated.message;
    }
    found.push_back(pose);
  }
  return found;
}

Eigen::Isometry3d averageBoardToTracker(const std::vector<BoardHandEyeView>& views,
  const std::vector<BoardHandEyeResult::View>& found, const Eigen::Isometry3d& markerToCamera)
{
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  Eigen::Vector3d center_Board = Eigen::Vector3d::Zero(), center_Tracker = center_Board;
  const Eigen::Isometry3d cameraToMarker = markerToCamera.inverse();
  std::size_t points = 0;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    for (std::size_t k = 0; found[i].used && k < views[i].points_Board.size(); ++k, ++points)
    {
      center_Board += views[i].points_Board[k];
    }
  }
  center_Board /= double(std::max<std::size_t>(points, 1));
  int count = 0;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    if (found[i].used)
    {
      const Eigen::Isometry3d boardToMarker = cameraToMarker * found[i].boardToCamera;
      const Eigen::Isometry3d boardToTracker = views[i].markerToTracker * boardToMarker;
      rotations += boardToTracker.linear();
      center_Tracker += boardToTracker * center_Board;
      ++count;
    }
  }
  center_Tracker /= double(std::max(count, 1));
  Eigen::Isometry3d average = Eigen::Isometry3d::Identity();
  average.linear() = nearestRotation(rotations);
  average.translation() = center_Tracker - average.linear() * center_Board;
  return average;
}

void addResiduals(
  const std::vector<BoardHandEyeView>& views, const CameraModel& camera, bool isBoardTracked, BoardHandEyeResult& result)
{
  double squaresPx = 0, squaresMm = 0, squaresRad = 0;
  std::size_t points = 0, pixels = 0;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    BoardHandEyeResult::View& row = result.views[i];
    if (!row.used)
    {
      continue;
    }
    const Eigen::Isometry3d& boardToTracker = isBoardTracked ? *views[i].boardToTracker : result.boardToTracker;
    const Eigen::Isometry3d boardToMarker = views[i].markerToTracker.inverse() * boardToTracker;
    const Eigen::Isometry3d expected = result.markerToCamera * boardToMarker;
    row.residualRad = rotationAngle(expected.linear().transpose() * row.boardToCamera.linear());
    double viewPx = 0, viewMm = 0;
    std::size_t seen = 0;
    for (std::size_t k = 0; k < views[i].ids.size(); ++k)
    {
      const Eigen::Vector3d point_Camera = expected * views[i].points_Board[k];
      viewMm += (point_Camera - row.boardToCamera * views[i].points_Board[k]).squaredNorm();
      const CameraModel::Projection projected = camera.project(point_Camera);
      if (projected.isUsable())
      {
        viewPx += (projected.point_Image - views[i].points_Image[k]).squaredNorm();
        ++seen;
      }
    }
    row.residualMm = std::sqrt(viewMm / double(std::max<std::size_t>(views[i].ids.size(), 1)));
    row.residualPx = std::sqrt(viewPx / double(std::max<std::size_t>(seen, 1)));
    squaresMm += viewMm;
    squaresPx += viewPx;
    squaresRad += row.residualRad * row.residualRad;
    points += views[i].ids.size();
    pixels += seen;
  }
  result.rmsMm = std::sqrt(squaresMm / double(std::max<std::size_t>(points, 1)));
  result.reprojectionRmsPx = std::sqrt(squaresPx / double(std::max<std::size_t>(pixels, 1)));
  result.rmsRad = std::sqrt(squaresRad / double(std::max(result.usedCount, 1)));
}

std::vector<EpipolarPair> epipolarPairs(const std::vector<HandEyeMotion>& motions, const std::vector<const BoardHandEyeView*>& used,
  const CameraModel& camera, int pointsPerPair)
{
  std::vector<EpipolarPair> pairs;
  for (const HandEyeMotion& motion : motions)
  {
    const BoardHandEyeView &first = *used[std::size_t(motion.from)], &second = *used[std::size_t(motion.to)];
    std::map<int, std::size_t> places;
    for (std::size_t k = 0; k < second.ids.size(); ++k)
    {
      places[second.ids[k]] = k;
    }
    std::vector<Eigen::Vector3d> points_Board;
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rays;
    for (std::size_t k = 0; k < first.ids.size(); ++k)
    {
      const auto other = places.find(first.ids[k]);
      const CameraModel::Unprojection from = camera.unproject(first.points_Image[k]);
      if (other == places.end() || !from.isUsable())
      {
        continue;
      }
      const CameraModel::Unprojection to = camera.unproject(second.points_Image[other->second]);
      if (to.isUsable())
      {
        points_Board.push_back(first.points_Board[k]);
        rays.emplace_back(from.ray_Camera, to.ray_Camera);
      }
    }
    EpipolarPair pair;
    pair.marker = motion.marker;
    for (const std::size_t k : spreadOut(points_Board, pointsPerPair))
    {
      pair.rays_Cameras.push_back(rays[k]);
    }
    if (!pair.rays_Cameras.empty())
    {
      pairs.push_back(pair);
    }
  }
  return pairs;
}

}  // namespace handeye
