// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SceneFloor.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

namespace desktop
{

SceneFloor::SceneFloor(vtkRenderer* renderer)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(this->Lines);
  this->Actor->SetMapper(mapper);
  this->Actor->GetProperty()->SetLighting(false);
  this->Actor->GetProperty()->SetOpacity(0.55);
  this->Actor->SetPickable(false);
  renderer->AddViewProp(this->Actor);
  const double nothing[6] = { 1, -1, 1, -1, 1, -1 };
  this->placeUnder(nothing);
}

void SceneFloor::setPlane(Plane plane)
{
  this->Across = plane;
  this->Actor->SetVisibility(plane != Plane::None);
}

void SceneFloor::setCounted(bool on)
{
  this->Actor->SetUseBounds(on);
}

void SceneFloor::setColor(double red, double green, double blue)
{
  this->Actor->GetProperty()->SetColor(red, green, blue);
}

void SceneFloor::placeUnder(const double bounds[6])
{
  if (this->Across == Plane::None)
  {
    return;
  }
  const bool isEmpty = bounds[0] > bounds[1];
  const int up = int(this->Across) - int(Plane::AcrossX);
  const int axes[2] = { (up + 1) % 3, (up + 2) % 3 };
  double reach = 500;
  double centre[3] = {};
  double height = 0;
  if (!isEmpty)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      centre[axis] = (bounds[2 * axis] + bounds[2 * axis + 1]) / 2;
    }
    reach = std::max({ bounds[2 * axes[0] + 1] - bounds[2 * axes[0]], bounds[2 * axes[1] + 1] - bounds[2 * axes[1]], 10.0 });
    height = bounds[2 * up];
  }
  this->SpacingMm = std::pow(10, std::floor(std::log10(reach / 4)));
  const int half = int(std::ceil(reach / this->SpacingMm));
  // On multiples of the spacing, so that the grid stays where it is when the scene grows a little.
  const double first = std::round(centre[axes[0]] / this->SpacingMm);
  const double second = std::round(centre[axes[1]] / this->SpacingMm);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  const auto addPoint = [&](double a, double b)
  {
    double point[3];
    point[up] = height;
    point[axes[0]] = a * this->SpacingMm;
    point[axes[1]] = b * this->SpacingMm;
    return points->InsertNextPoint(point);
  };
  for (int i = -half; i <= half; ++i)
  {
    const vtkIdType along[2] = { addPoint(first + i, second - half), addPoint(first + i, second + half) };
    const vtkIdType across[2] = { addPoint(first - half, second + i), addPoint(first + half, second + i) };
    lines->InsertNextCell(2, along);
    lines->InsertNextCell(2, across);
  }
  this->Lines->SetPoints(points);
  this->Lines->SetLines(lines);
  this->Lines->Modified();
}

}  // namespace desktop
