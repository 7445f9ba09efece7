// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OverlayTestScene.h"
#include "TestCameras.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include <cmath>

/// A ring before a camera of full size, for what the pipeline does whatever the look.
namespace handeye::test
{

/// A thick ring with rounded edges: something with a hole, edges, and surfaces behind surfaces.
inline vtkSmartPointer<vtkPolyData> ring()
{
  constexpr int around = 80, across = 48;
  constexpr double ringRadius = 30, sectionRadius = 14;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> faces;
  for (int i = 0; i < around; ++i)
  {
    for (int j = 0; j < across; ++j)
    {
      const double turn = 2 * M_PI * i / around, section = 2 * M_PI * j / across;
      const double c = std::cos(section), s = std::sin(section);
      const double radius = sectionRadius / std::pow(std::pow(c, 4) + std::pow(s, 4), 0.25);
      const double outward = ringRadius + radius * c;
      points->InsertNextPoint(outward * std::cos(turn), outward * std::sin(turn), radius * s);
      const vtkIdType nextI = (i + 1) % around, nextJ = (j + 1) % across;
      faces->InsertNextCell({ i * across + j, nextI * across + j, nextI * across + nextJ, i * across + nextJ });
    }
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(faces);
  return mesh;
}

/// A model tilted against the camera, its origin here.
inline Eigen::Isometry3d tiltedModelToCamera(double x, double y, double z)
{
  return pose({ 1, 0.4, 0.2 }, -0.9, { x, y, z });
}

inline cv::Mat noise(int width, int height)
{
  cv::Mat frame(height, width, CV_8UC3);
  cv::RNG(7).fill(frame, cv::RNG::UNIFORM, 0, 256);
  return frame;
}

/// Something like an operating field: a soft colour gradient with a few shapes.
inline cv::Mat scene(int width, int height)
{
  cv::Mat frame(height, width, CV_8UC3);
  for (int v = 0; v < height; ++v)
  {
    for (int u = 0; u < width; ++u)
    {
      frame.at<cv::Vec3b>(v, u) =
        cv::Vec3b(uchar(90 + 60 * v / height), uchar(70 + 40 * u / width), uchar(30 + 30 * (u + v) / (width + height)));
    }
  }
  cv::circle(frame, { width / 4, height / 4 }, height / 9, { 40, 40, 210 }, cv::FILLED);
  cv::rectangle(frame, cv::Rect(width * 5 / 8, height * 5 / 8, width / 5, height / 5), { 60, 170, 60 }, cv::FILLED);
  cv::ellipse(frame, { width * 3 / 4, height / 3 }, { width / 8, height / 12 }, 30, 0, 360, { 150, 160, 220 }, cv::FILLED);
  return frame;
}

inline Pipeline ringPipeline(const CameraModel& camera, const cv::Mat& frame)
{
  Pipeline pipeline = newPipeline();
  pipeline->SetCameraModel(camera);
  pipeline->SetVideoFrame(frame);
  pipeline->SetModel(ring());
  pipeline->SetModelToCamera(toVtk(tiltedModelToCamera(15, -8, 190)));
  return pipeline;
}

}  // namespace handeye::test
