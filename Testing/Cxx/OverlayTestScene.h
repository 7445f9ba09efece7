// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "EigenVtk.h"
#include "MeshReader.h"
#include "OffscreenRendering.h"
#include "OverlayLook.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>

#include <string>
#include <vector>

/// A small operating field for pictures of looks: 320 x 240, a vertebra, a stylus.
namespace handeye::test
{

using Pipeline = vtkSmartPointer<vtkHandEyeOverlayPipeline>;

constexpr int FieldWidth = 320, FieldHeight = 240;

/// Of a picture against its baseline. Averaged differences of edge pixels: another Mesa moves shading by a grey level or two, a fault
/// moves hundreds of pixels.
constexpr double Threshold = 25;

inline CameraModel fieldCamera(const std::vector<double>& distortion = { 0.041, -0.112, -0.0007, 0.0011, 0.02 })
{
  Eigen::Matrix3d matrix;
  matrix << 300, 0, 158.2, 0, 301, 122.6, 0, 0, 1;
  return CameraModel(FieldWidth, FieldHeight, matrix, distortion);
}

inline CameraModel barrelCamera()
{
  return fieldCamera({ -0.4, 0, 0, 0 });
}

/// Plain colours, a grid of lines that shows the lens, and shapes with sharp edges.
inline cv::Mat fieldVideo()
{
  cv::Mat frame(FieldHeight, FieldWidth, CV_8UC3, cv::Scalar(96, 84, 40));
  for (int line = 0; line <= 10; ++line)
  {
    const int u = line * FieldWidth / 10, v = line * FieldHeight / 10;
    cv::line(frame, { u, 0 }, { u, FieldHeight }, { 120, 110, 60 });
    cv::line(frame, { 0, v }, { FieldWidth, v }, { 120, 110, 60 });
  }
  cv::circle(frame, { 70, 60 }, 24, { 40, 40, 210 }, cv::FILLED);
  cv::rectangle(frame, cv::Rect(150, 130, 90, 16), { 230, 230, 230 }, cv::FILLED);
  cv::ellipse(frame, { 215, 85 }, { 34, 14 }, 30, 0, 360, { 150, 160, 220 }, cv::FILLED);
  return frame;
}

inline Eigen::Isometry3d pose(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  result.translation() = translation;
  return result;
}

/// Of the vertebra's own frame, whose middle is near its origin.
inline Eigen::Isometry3d fieldModelToCamera()
{
  return pose({ 1, 0.35, -0.25 }, 2.1, { 4, -2, 125 });
}

inline Pipeline newPipeline()
{
  registerOffscreenRendering();
  return Pipeline::New();
}

inline Pipeline fieldPipeline(const CameraModel& camera = fieldCamera())
{
  Pipeline pipeline = newPipeline();
  pipeline->SetCameraModel(camera);
  pipeline->SetVideoFrame(fieldVideo());
  pipeline->SetModel(readMesh(std::string(HANDEYE_RESOURCES_DIR) + "/Meshes/Vertebra.ply"));
  pipeline->SetModelToCamera(toVtk(fieldModelToCamera()));
  return pipeline;
}

inline cv::Mat rendered(const Pipeline& pipeline)
{
  cv::Mat picture;
  pipeline->RenderToImage(picture);
  return picture;
}

inline cv::Mat renderedMask(const Pipeline& pipeline)
{
  pipeline->SetMaskMode(true);
  cv::Mat mask;
  cv::cvtColor(rendered(pipeline), mask, cv::COLOR_BGR2GRAY);
  pipeline->SetMaskMode(false);
  return mask;
}

inline cv::Mat pictureOf(const OverlayLook& look, const CameraModel& camera = fieldCamera())
{
  const Pipeline pipeline = fieldPipeline(camera);
  pipeline->SetLook(look);
  return rendered(pipeline);
}

/// A ball in the picture's middle.
inline Pipeline ballPipeline(double radiusMm, double distanceMm)
{
  const Pipeline pipeline = fieldPipeline();
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(radiusMm);
  ball->SetThetaResolution(90);
  ball->SetPhiResolution(90);
  ball->Update();
  pipeline->SetModel(ball->GetOutput());
  pipeline->SetModelToCamera(toVtk(pose({ 0, 0, 1 }, 0, { 0, 0, distanceMm })));
  return pipeline;
}

inline StylusShape smallStylus()
{
  StylusShape shape;
  shape.ballRadiusMm = 5;
  shape.shaftRadiusMm = 2.5;
  shape.shaftLengthMm = 80;
  shape.rayLengthMm = 60;
  return shape;
}

/// The stylus with its tip here, its shaft towards the camera and the upper right.
inline void holdStylus(const Pipeline& pipeline, const Eigen::Vector3d& tip_Camera)
{
  pipeline->SetStylusShape(smallStylus());
  pipeline->SetStylusTipToCamera(toVtk(pose({ 1, 1, 0 }, 0.7, tip_Camera)));
}

/// Of a calibration that is uncertain by a shift along the picture alone.
inline Eigen::Matrix<double, 6, 6> shiftCovariance(double sigmaXMm, double sigmaYMm)
{
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance(3, 3) = sigmaXMm * sigmaXMm;
  covariance(4, 4) = sigmaYMm * sigmaYMm;
  return covariance;
}

/// Of two pictures of the same size, in grey levels.
inline cv::Mat difference(const cv::Mat& a, const cv::Mat& b)
{
  cv::Mat result;
  cv::absdiff(a, b, result);
  cv::cvtColor(result, result, cv::COLOR_BGR2GRAY);
  return result;
}

}  // namespace handeye::test
