// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RoomPicture.h"

#include <opencv2/imgproc.hpp>

#include <optional>

namespace handeye::simulation
{

namespace
{

const Light Wood(0.05F, 0.13F, 0.24F);
const Light Tissue(0.22F, 0.2F, 0.5F);
const Light RingRed(0.03F, 0.03F, 0.42F);
const Light Steel(0.35F, 0.34F, 0.33F);
const Light Bone(0.4F, 0.5F, 0.56F);

std::optional<cv::Point> seenAt(const CameraModel& camera, const Eigen::Vector3d& point_Camera)
{
  const CameraModel::Projection seen = camera.project(point_Camera);
  if (!seen.isUsable() || seen.point_Image.cwiseAbs().maxCoeff() > 1e4)
  {
    return std::nullopt;
  }
  return cv::Point(int(std::lround(seen.point_Image.x() * 16)), int(std::lround(seen.point_Image.y() * 16)));
}

cv::Scalar toScalar(const Light& light)
{
  return { light[0], light[1], light[2] };
}

/// A flat polygon, or the line of it.
void drawPolygon(cv::Mat& light, const CameraModel& camera, const std::vector<Eigen::Vector3d>& corners_Camera, const Light& color,
  int lineWidthPx = 0)
{
  std::vector<cv::Point> corners;
  for (const Eigen::Vector3d& corner_Camera : corners_Camera)
  {
    const std::optional<cv::Point> seen = seenAt(camera, corner_Camera);
    if (!seen)
    {
      return;
    }
    corners.push_back(*seen);
  }
  constexpr int SixteenthPixels = 4;
  if (lineWidthPx > 0)
  {
    cv::polylines(light, corners, true, toScalar(color), lineWidthPx, cv::LINE_8, SixteenthPixels);
  }
  else
  {
    cv::fillPoly(light, std::vector<std::vector<cv::Point>>{ corners }, toScalar(color), cv::LINE_8, SixteenthPixels);
  }
}

std::vector<Eigen::Vector3d> circle(const Eigen::Isometry3d& circleToCamera, double radiusMm)
{
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 48; ++i)
  {
    const double turn = 2 * EIGEN_PI * i / 48;
    points.push_back(circleToCamera * Eigen::Vector3d(radiusMm * std::cos(turn), radiusMm * std::sin(turn), 0));
  }
  return points;
}

/// Behind everything, fixed in the room: a board, tissue, red rings.
void drawClutter(cv::Mat& light, const RoomOptions& options, const RoomView& view)
{
  const double depthMm = options.furthestMm + 110;
  const auto place = [&](double x, double y)
  {
    Eigen::Isometry3d clutterToPhantom = Eigen::Isometry3d::Identity();
    clutterToPhantom.translation() = Eigen::Vector3d(x, y, depthMm);
    return clutterToPhantom;
  };
  // Its own frame: the camera's at rest, taken back into the room by the phantom that lies still in it.
  Eigen::Isometry3d restToPhantom = Eigen::Isometry3d::Identity();
  restToPhantom.linear() = Eigen::AngleAxisd(1.03, Eigen::Vector3d(0.3, -0.4, 0.9).normalized()).toRotationMatrix().transpose();
  const double middleMm = (options.nearestMm + options.furthestMm) / 2;
  restToPhantom.translation() = -(restToPhantom.linear() * Eigen::Vector3d(-45, 60, middleMm + 90));
  const Eigen::Isometry3d restToCamera = view.phantomToCamera * restToPhantom;
  const auto rectangle = [&](double x, double y, double width, double height)
  {
    std::vector<Eigen::Vector3d> corners;
    for (const auto& [dx, dy] : { std::pair{ -1.0, -1.0 }, { 1.0, -1.0 }, { 1.0, 1.0 }, { -1.0, 1.0 } })
    {
      corners.push_back(restToCamera * Eigen::Vector3d(x + dx * width / 2, y + dy * height / 2, depthMm));
    }
    return corners;
  };
  drawPolygon(light, options.camera, rectangle(-0.25 * depthMm, -0.1 * depthMm, 0.3 * depthMm, 0.45 * depthMm), Wood);
  drawPolygon(light, options.camera, circle(restToCamera * place(0.22 * depthMm, -0.16 * depthMm), 0.08 * depthMm), Tissue);
  drawPolygon(light, options.camera, circle(restToCamera * place(0.1 * depthMm, 0.24 * depthMm), 0.05 * depthMm), RingRed, 5);
  drawPolygon(light, options.camera, circle(restToCamera * place(-0.3 * depthMm, 0.22 * depthMm), 0.035 * depthMm), RingRed, 4);
}

/// The mesh, or a vertebra's rough shape: its body and three processes.
void drawPhantom(SphereScene& scene, const RoomOptions& options, const RoomView& view)
{
  if (options.phantomMesh)
  {
    RoomMeshLook look;
    look.color = Bone;
    look.dots_Model = options.landmarks_Model;
    drawMesh(scene.light(), options.camera, *options.phantomMesh, view.phantomToCamera * options.modelToPhantom, look);
    return;
  }
  const std::pair<Eigen::Vector3d, double> parts[] = { { { 0, 0, 0 }, 19 }, { { 26, 22, 4 }, 9 }, { { -26, 22, 4 }, 9 },
    { { 0, 34, -4 }, 10 } };
  for (const auto& [center_Phantom, radiusMm] : parts)
  {
    RenderedBall part;
    part.center_Camera = view.phantomToCamera * center_Phantom;
    part.radiusMm = radiusMm;
    part.color = Bone;
    part.isShaded = true;
    if (part.center_Camera.z() > 2 * radiusMm)
    {
      scene.add(part);
    }
  }
}

void drawShaft(cv::Mat& light, const RoomOptions& options, const RoomView& view)
{
  constexpr double RadiusMm = 2.5;
  const Eigen::Vector3d along = (view.handle_Camera - view.ball_Camera).normalized();
  const Eigen::Vector3d across = RadiusMm * along.cross(view.ball_Camera).normalized();
  const Eigen::Vector3d end = view.ball_Camera + 130 * along;
  drawPolygon(light, options.camera, { view.ball_Camera + across, view.ball_Camera - across, end - across, end + across }, Steel);
}

}  // namespace

cv::Mat drawRoom(const RoomOptions& options, const RayTable& rays, const RoomView& view, unsigned noiseSeed)
{
  SphereScene scene(options.camera, TableGrey, &rays);
  if (options.hasClutter)
  {
    drawClutter(scene.light(), options, view);
    drawPhantom(scene, options, view);
    drawShaft(scene.light(), options, view);
  }
  RenderedBall ball;
  ball.center_Camera = view.ball_Camera;
  ball.radiusMm = options.ballRadiusMm;
  scene.add(ball);
  Photograph how;
  how.blurPx = options.blurPx;
  how.noise = options.imageNoise;
  how.seed = noiseSeed;
  return scene.photograph(how);
}

}  // namespace handeye::simulation
