// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayStylus.h"

#include "OverlayMesh.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>

#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

constexpr double LongestEdgeMm = 3;
constexpr double TipRadiusMm = 1.2;
constexpr double RayRadiusMm = 0.6;

vtkSmartPointer<vtkPolyData> ball(double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(radius);
  source->SetThetaResolution(48);
  source->SetPhiResolution(32);
  source->Update();
  return source->GetOutput();
}

/// A closed rod around the Z axis.
vtkSmartPointer<vtkPolyData> rod(double radius, double fromZ, double toZ)
{
  constexpr int sides = 20;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> faces;
  for (int i = 0; i < sides; ++i)
  {
    const double angle = 2 * M_PI * i / sides;
    points->InsertNextPoint(radius * std::cos(angle), radius * std::sin(angle), fromZ);
    points->InsertNextPoint(radius * std::cos(angle), radius * std::sin(angle), toZ);
  }
  const vtkIdType from = points->InsertNextPoint(0, 0, fromZ), to = points->InsertNextPoint(0, 0, toZ);
  for (vtkIdType i = 0; i < sides; ++i)
  {
    const vtkIdType here = 2 * i, next = 2 * ((i + 1) % sides);
    faces->InsertNextCell({ here, next, next + 1, here + 1 });
    faces->InsertNextCell({ from, next, here });
    faces->InsertNextCell({ to, here + 1, next + 1 });
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(faces);
  return mesh;
}

void require(bool good, const char* sentence)
{
  if (!good)
  {
    throw std::invalid_argument(sentence);
  }
}

bool isLength(double value)
{
  return std::isfinite(value) && value >= 0;
}

}  // namespace

void StylusShape::check() const
{
  require(isLength(this->ballRadiusMm), "the radius of the stylus' ball must be 0 or more mm");
  require(isLength(this->shaftRadiusMm), "the radius of the stylus' shaft must be 0 or more mm");
  require(isLength(this->shaftLengthMm), "the length of the stylus' shaft must be 0 or more mm");
  require(isLength(this->rayLengthMm), "the length of the stylus' ray must be 0 or more mm");
}

vtkSmartPointer<vtkPolyData> makeStylusBody(const StylusShape& shape)
{
  shape.check();
  vtkNew<vtkAppendPolyData> parts;
  parts->AddInputData(vtkNew<vtkPolyData>());
  if (shape.ballRadiusMm > 0)
  {
    parts->AddInputData(ball(shape.ballRadiusMm));
  }
  if (shape.hasShaft && shape.shaftRadiusMm > 0 && shape.shaftLengthMm > 0)
  {
    parts->AddInputData(rod(shape.shaftRadiusMm, -shape.shaftLengthMm, 0));
  }
  parts->Update();
  return dividedOverlayMesh(prepareOverlayMesh(parts->GetOutput()), LongestEdgeMm).mesh;
}

vtkSmartPointer<vtkPolyData> makeStylusRay(const StylusShape& shape)
{
  shape.check();
  if (!shape.hasShaft || shape.rayLengthMm <= shape.ballRadiusMm)
  {
    return vtkSmartPointer<vtkPolyData>::New();
  }
  return dividedOverlayMesh(prepareOverlayMesh(rod(RayRadiusMm, shape.ballRadiusMm, shape.rayLengthMm)), LongestEdgeMm).mesh;
}

vtkSmartPointer<vtkPolyData> makeStylusTip(const StylusShape& shape)
{
  shape.check();
  return dividedOverlayMesh(prepareOverlayMesh(ball(TipRadiusMm)), LongestEdgeMm).mesh;
}

}  // namespace handeye
