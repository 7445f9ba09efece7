// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "EigenVtk.h"
#include "OffscreenRendering.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cmath>
#include <initializer_list>
#include <ostream>
#include <string>
#include <vector>

/// What a lens does to points, in plain arithmetic that is independent of the code under test, and meshes of such points.
namespace handeye::test
{

/// A lens, and what it does to a point: OpenCV's documented formulas.
struct Lens
{
  std::string name;
  int width, height;
  double fx, fy, cx, cy;
  std::vector<double> k;

  double at(std::size_t i) const { return i < this->k.size() ? this->k[i] : 0; }

  double radial(double r2) const
  {
    return (1 + at(0) * r2 + at(1) * r2 * r2 + at(4) * r2 * r2 * r2) / (1 + at(5) * r2 + at(6) * r2 * r2 + at(7) * r2 * r2 * r2);
  }

  /// x, y = X/Z, Y/Z to pixels.
  Eigen::Vector2d pixel(double x, double y) const
  {
    const double r2 = x * x + y * y;
    const double bentX = x * radial(r2) + 2 * at(2) * x * y + at(3) * (r2 + 2 * x * x) + at(8) * r2 + at(9) * r2 * r2;
    const double bentY = y * radial(r2) + at(2) * (r2 + 2 * y * y) + 2 * at(3) * x * y + at(10) * r2 + at(11) * r2 * r2;
    // R(tauX, tauY), and the projection of the tilted plane onto the untilted one.
    const double cX = std::cos(at(12)), sX = std::sin(at(12)), cY = std::cos(at(13)), sY = std::sin(at(13));
    const double r[3][3] = { { cY, sY * sX, -sY * cX }, { 0, cX, sX }, { sY, -cY * sX, cY * cX } };
    const double v[3] = { r[0][0] * bentX + r[0][1] * bentY + r[0][2], r[1][0] * bentX + r[1][1] * bentY + r[1][2],
      r[2][0] * bentX + r[2][1] * bentY + r[2][2] };
    const double tiltedX = (r[2][2] * v[0] - r[0][2] * v[2]) / v[2];
    const double tiltedY = (r[2][2] * v[1] - r[1][2] * v[2]) / v[2];
    return { fx * tiltedX + cx, fy * tiltedY + cy };
  }

  /// Undistorted radius beyond which the distorted one falls again.
  double foldRadius() const
  {
    double r = 0;
    while (r < 10 && (r + 0.001) * radial((r + 0.001) * (r + 0.001)) > r * radial(r * r))
    {
      r += 0.001;
    }
    return r;
  }

  /// The x, y seen at a pixel, by walking there; false if the lens never sees that pixel.
  bool seenAt(const Eigen::Vector2d& wanted, Eigen::Vector2d& point_Normalized) const
  {
    const double largestRadius = 0.97 * foldRadius();
    Eigen::Vector2d point(0, 0);
    for (int i = 0; i < 400; ++i)
    {
      const Eigen::Vector2d error = pixel(point.x(), point.y()) - wanted;
      if (error.norm() < 1e-5)
      {
        break;
      }
      point -= 0.7 * Eigen::Vector2d(error.x() / fx, error.y() / fy);
      if (!(point.norm() < 20))
      {
        return false;
      }
    }
    point_Normalized = point;
    return (pixel(point.x(), point.y()) - wanted).norm() < 1e-3 && point.norm() < largestRadius;
  }

  CameraModel camera() const
  {
    Eigen::Matrix3d matrix;
    matrix << fx, 0, cx, 0, fy, cy, 0, 0, 1;
    return CameraModel(width, height, matrix, k);
  }
};

inline std::ostream& operator<<(std::ostream& stream, const Lens& lens)
{
  return stream << lens.name;
}

inline const Lens webcamLens{ "Webcam", 640, 480, 601.7, 602.9, 316.2, 244.8, { 0.041, -0.112, -0.0007, 0.0011, 0.02 } };
inline const Lens laparoscopeLens{ "Laparoscope", 720, 576, 812.3, 826, 366.9, 281.4, { -0.251, 0.094, 0.0008, -0.001, 0.011 } };
inline const Lens barrelLens{ "StrongBarrel", 640, 480, 600, 600, 319.5, 239.5, { -0.4, 0, 0, 0 } };
inline const Lens wideLens{ "Wide", 960, 720, 571, 571, 479.5, 359.5, { -0.19, 0, 0, 0 } };
inline const std::vector<Lens> allLenses = { webcamLens, laparoscopeLens, barrelLens, wideLens,
  { "OffCentre", 640, 480, 560, 640, 359.5, 199.5, { -0.15, 0.05, 0.002, -0.003 } },
  { "Rational", 1280, 720, 900, 905, 650, 350, { 0.3, -0.1, 0.0005, -0.0004, 0.01, 0.45, -0.05, 0.005 } },
  { "Tilted", 800, 600, 700, 690, 410, 290,
    { -0.2, 0.05, 0.001, -0.002, 0.01, 0.02, 0.01, 0.001, 0.002, -0.001, -0.0015, 0.0005, 0.03, -0.02 } },
  { "NoDistortion", 640, 480, 600, 610, 300, 250, {} } };

/// What the straightened picture of this lens is: the same camera without its distortion.
inline Lens straightened(const Lens& lens)
{
  Lens plain = lens;
  plain.k.clear();
  return plain;
}

inline Eigen::Isometry3d somePose()
{
  Eigen::Isometry3d modelToCamera = Eigen::Isometry3d::Identity();
  modelToCamera.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  modelToCamera.translation() << 40, -70, 210;
  return modelToCamera;
}

/// Of each disc of MeshInCamera.
constexpr int DiscCorners = 24;

/// A mesh put together from points in the Camera frame, stored in the Model frame of somePose().
class MeshInCamera
{
public:
  MeshInCamera() { this->Points->SetDataTypeToDouble(); }
  vtkIdType add(const Eigen::Vector3d& point_Camera)
  {
    const Eigen::Vector3d point_Model = somePose().inverse() * point_Camera;
    return this->Points->InsertNextPoint(point_Model.data());
  }
  void face(std::initializer_list<vtkIdType> ids) { this->Faces->InsertNextCell(ids); }

  /// A flat disc facing along the axis: its outline's centroid is the image of its centre, but for the lens' curvature.
  void disc(const Eigen::Vector3d& centre_Camera, double radiusMm)
  {
    constexpr int corners = DiscCorners;
    const vtkIdType first = this->Points->GetNumberOfPoints();
    for (int i = 0; i < corners; ++i)
    {
      const double angle = 2 * M_PI * i / corners;
      this->add(centre_Camera + radiusMm * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    }
    for (int i = 1; i + 1 < corners; ++i)
    {
      this->face({ first, first + i, first + i + 1 });
    }
  }

  vtkSmartPointer<vtkPolyData> mesh()
  {
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(this->Points);
    mesh->SetPolys(this->Faces);
    return mesh;
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Faces;
};

inline vtkSmartPointer<vtkHandEyeOverlayPipeline> maskPipeline(const Lens& lens, vtkPolyData* mesh)
{
  registerOffscreenRendering();
  auto pipeline = vtkSmartPointer<vtkHandEyeOverlayPipeline>::New();
  pipeline->SetCameraModel(lens.camera());
  pipeline->SetModel(mesh);
  pipeline->SetModelToCamera(toVtk(somePose()));
  pipeline->SetMaskMode(true);
  return pipeline;
}

inline cv::Mat grey(const cv::Mat& bgr)
{
  cv::Mat single;
  cv::cvtColor(bgr, single, cv::COLOR_BGR2GRAY);
  return single;
}

}  // namespace handeye::test
