// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeSceneGeometry.h"

#include "CameraModel.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCubeSource.h>
#include <vtkCylinderSource.h>
#include <vtkLineSource.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>
#include <vtkTubeFilter.h>

namespace handeye
{

namespace
{

void addSphere(vtkAppendPolyData* all, const Eigen::Vector3d& center, double radius)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(center.x(), center.y(), center.z());
  sphere->SetRadius(radius);
  sphere->SetThetaResolution(20);
  sphere->SetPhiResolution(20);
  sphere->Update();
  all->AddInputData(sphere->GetOutput());
}

void addTube(vtkAppendPolyData* all, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius)
{
  vtkNew<vtkLineSource> line;
  line->SetPoint1(from.x(), from.y(), from.z());
  line->SetPoint2(to.x(), to.y(), to.z());
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputConnection(line->GetOutputPort());
  tube->SetRadius(radius);
  tube->SetNumberOfSides(14);
  tube->CappingOn();
  tube->Update();
  all->AddInputData(tube->GetOutput());
}

void addBox(vtkAppendPolyData* all, const Eigen::Vector3d& center, const Eigen::Vector3d& size)
{
  vtkNew<vtkCubeSource> box;
  box->SetCenter(center.x(), center.y(), center.z());
  box->SetXLength(size.x());
  box->SetYLength(size.y());
  box->SetZLength(size.z());
  box->Update();
  all->AddInputData(box->GetOutput());
}

vtkSmartPointer<vtkPolyData> ballOf(int resolution)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(1);
  sphere->SetThetaResolution(resolution);
  sphere->SetPhiResolution(resolution);
  sphere->Update();
  return sphere->GetOutput();
}

vtkSmartPointer<vtkPolyData> output(vtkAppendPolyData* all)
{
  all->Update();
  return all->GetOutput();
}

}  // namespace

vtkSmartPointer<vtkPolyData> trackerShape()
{
  vtkNew<vtkAppendPolyData> all;
  addBox(all, { 0, 0, 0 }, { 560, 80, 70 });
  addTube(all, { -220, 0, -50 }, { -220, 0, 50 }, 36);
  addTube(all, { 220, 0, -50 }, { 220, 0, 50 }, 36);
  return output(all);
}

vtkSmartPointer<vtkPolyData> markerShape()
{
  vtkNew<vtkAppendPolyData> all;
  // No two arms are alike, as on a real one.
  const Eigen::Vector3d ends[] = { { 32, 0, 0 }, { -24, 0, 0 }, { 0, 40, 0 }, { 0, -28, 0 } };
  for (const Eigen::Vector3d& end : ends)
  {
    addTube(all, Eigen::Vector3d::Zero(), end, 2);
    addSphere(all, end, 6);
  }
  return output(all);
}

vtkSmartPointer<vtkPolyData> cameraShape()
{
  vtkNew<vtkAppendPolyData> all;
  addBox(all, { 0, 0, -26 }, { 54, 40, 36 });
  addTube(all, { 0, 0, -10 }, { 0, 0, 0 }, 14);
  return output(all);
}

vtkSmartPointer<vtkPolyData> frustumShape(const CameraModel& camera, double depthMm)
{
  auto shape = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  const auto add = [&](const Eigen::Vector2d& point_Image) -> vtkIdType
  {
    const CameraModel::Unprojection seen = camera.unproject(point_Image);
    if (!seen.isUsable() || seen.ray_Camera.z() <= 1e-6)
    {
      return -1;
    }
    const Eigen::Vector3d point_Camera = seen.ray_Camera * (depthMm / seen.ray_Camera.z());
    return points->InsertNextPoint(point_Camera.data());
  };
  const auto connect = [&](vtkIdType first, vtkIdType second)
  {
    if (first >= 0 && second >= 0)
    {
      const vtkIdType ends[2] = { first, second };
      lines->InsertNextCell(2, ends);
    }
  };
  const vtkIdType center = points->InsertNextPoint(0, 0, 0);
  const double right = camera.width() - 0.5, bottom = camera.height() - 0.5;
  const Eigen::Vector2d corners[] = { { -0.5, -0.5 }, { right, -0.5 }, { right, bottom }, { -0.5, bottom } };
  constexpr int perSide = 16;
  for (int side = 0; side < 4; ++side)
  {
    vtkIdType before = add(corners[side]);
    connect(center, before);
    for (int step = 1; step <= perSide; ++step)
    {
      const double share = step / double(perSide);
      const vtkIdType next = add((1 - share) * corners[side] + share * corners[(side + 1) % 4]);
      connect(before, next);
      before = next;
    }
  }
  // Which side is up: a small triangle on the upper border.
  const double middle = camera.width() / 2.0;
  const vtkIdType left = add({ 0.45 * camera.width(), 0 });
  const vtkIdType tip = add({ middle, -0.08 * camera.height() });
  const vtkIdType other = add({ 0.55 * camera.width(), 0 });
  connect(left, tip);
  connect(tip, other);
  shape->SetPoints(points);
  shape->SetLines(lines);
  return shape;
}

vtkSmartPointer<vtkPolyData> shaftShape(const Eigen::Vector3d& tip_Stylus)
{
  vtkNew<vtkAppendPolyData> all;
  addTube(all, Eigen::Vector3d::Zero(), tip_Stylus.norm() > 1e-6 ? tip_Stylus : Eigen::Vector3d(0, 0, 1e-3), 3);
  return output(all);
}

vtkSmartPointer<vtkPolyData> unitBall()
{
  return ballOf(32);
}

vtkSmartPointer<vtkPolyData> coarseBall()
{
  return ballOf(10);
}

}  // namespace handeye
