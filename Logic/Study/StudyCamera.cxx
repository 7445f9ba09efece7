// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyCamera.h"

#include "RigidTransform.h"

namespace handeye::study
{

namespace
{

CameraModel makeCamera(int width, int height, double fx, double fy, double cx, double cy, const std::vector<double>& lens)
{
  Eigen::Matrix3d matrix;
  matrix << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return CameraModel(width, height, matrix, lens);
}

/// A marker whose axes are turned against the camera's, and from which the camera's centre is `lens_Marker` away.
Eigen::Isometry3d makeMarker(const Eigen::Vector3d& rotationVector, const Eigen::Vector3d& lens_Marker)
{
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();
  markerToCamera.linear() = rotationFromVector(rotationVector);
  markerToCamera.translation() = -(markerToCamera.linear() * lens_Marker);
  return markerToCamera;
}

/// The other eye of a stereo head: to the right by the baseline, turned in by a little.
Eigen::Isometry3d rightEye(const Eigen::Isometry3d& markerToLeft, double baselineMm, double turnRad)
{
  Eigen::Isometry3d leftToRight = Eigen::Isometry3d::Identity();
  leftToRight.linear() = rotationFromVector({ 0.002, turnRad, -0.003 });
  leftToRight.translation() = -(leftToRight.linear() * Eigen::Vector3d(baselineMm, 0, 0));
  return leftToRight * markerToLeft;
}

BoardDescription chessboard(double squareMm)
{
  BoardDescription board;
  board.columns = 9;
  board.rows = 6;
  board.spacingMm = squareMm;
  return board;
}

}  // namespace

double StudyCamera::markerDistanceMm() const
{
  return eyes.front().markerToCamera.translation().norm();
}

std::vector<StudyCamera> studyCameras()
{
  const Eigen::Isometry3d webcam = makeMarker({ 1.9, -1.1, 0.7 }, { -5, -56, -9 });
  const Eigen::Isometry3d headset = makeMarker({ 0.4, 2.2, -0.6 }, { 32, -95, 60 });
  const Eigen::Isometry3d laparoscope = makeMarker({ -1.2, 0.5, 1.6 }, { 20, -70, 310 });
  return {
    { "webcam", "webcam",
      { { makeCamera(640, 480, 601.7, 602.9, 316.2, 244.8, { 0.041, -0.112, -0.0007, 0.0011, 0.02 }), webcam } }, 150, 700, 30,
      chessboard(20) },
    { "headset", "head-mounted pass-through stereo camera",
      { { makeCamera(1280, 960, 702.4, 701.6, 645.1, 476.3, { -0.17, 0.03, 0.0004, -0.0003 }), headset },
        { makeCamera(1280, 960, 699.1, 699.9, 634.8, 483.2, { -0.168, 0.029, -0.0003, 0.0005 }), rightEye(headset, 64, 0.01) } },
      200, 700, 15, chessboard(20) },
    { "laparoscope", "stereo laparoscope",
      { { makeCamera(720, 576, 812.3, 826, 366.9, 281.4, { -0.251, 0.094, 0.0008, -0.001, 0.011 }), laparoscope },
        { makeCamera(720, 576, 815.8, 829.1, 352.7, 290.6, { -0.247, 0.09, -0.0006, 0.0007, 0.012 }),
          rightEye(laparoscope, 5, 0.02) } },
      60, 250, 10, chessboard(4) },
  };
}

}  // namespace handeye::study
