// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace handeye::simulation
{
}

namespace handeye::test
{

using namespace simulation;  // SphereRenderer.h, which the simulated room shares with the tests

inline CameraModel makeCamera(
  int width, int height, double fx, double fy, double cx, double cy, const std::vector<double>& coefficients)
{
  Eigen::Matrix3d cameraMatrix;
  cameraMatrix << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return CameraModel(width, height, cameraMatrix, coefficients);
}

inline CameraModel webcam()
{
  return makeCamera(640, 480, 601.7, 602.9, 316.2, 244.8, { 0.041, -0.112, -0.0007, 0.0011, 0.02 });
}

inline CameraModel laparoscope()
{
  return makeCamera(720, 576, 812.3, 826, 366.9, 281.4, { -0.251, 0.094, 0.0008, -0.001, 0.011 });
}

/// One coefficient that folds back at r = 0.91, outside of the image.
inline CameraModel barrel()
{
  return makeCamera(640, 480, 800, 800, 319.5, 239.5, { -0.4, 0, 0, 0 });
}

/// The pass-through camera of the paper's authors (left_calibration.xml of their app): four coefficients, up to 48 degrees off the
/// axis.
inline CameraModel passThrough()
{
  return makeCamera(960, 950, 443.08778509658629, 440.88255151097923, 491.37630327079307, 477.33731041974312,
    { -0.34217579502885637, 0.15322858206254297, 0.00070265221404534526, -0.0010123352757817517 });
}

/// All fourteen coefficients: rational, thin prism, and a sensor tilted by 1.7 and -2.3 degrees.
inline CameraModel tilted()
{
  return makeCamera(800, 600, 700, 705, 395, 310,
    { -0.21, 0.08, 0.0006, -0.0009, 0.01, 0.05, -0.02, 0.004, 0.0007, -0.0002, -0.0005, 0.0003, 0.03, -0.04 });
}

inline CameraModel pinhole()
{
  return makeCamera(640, 480, 650, 650, 319.5, 239.5, {});
}

struct NamedCamera
{
  std::string name;
  CameraModel camera;
};

inline std::vector<NamedCamera> allCameras()
{
  return { { "webcam", webcam() }, { "laparoscope", laparoscope() }, { "barrel", barrel() }, { "passThrough", passThrough() },
    { "tilted", tilted() }, { "pinhole", pinhole() } };
}

}  // namespace handeye::test
