// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceDistance.h"

#include <vtkCellLocator.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>

namespace handeye
{

double largestSurfaceDistance(vtkPolyData* mesh, const std::vector<Eigen::Vector3d>& points_Model)
{
  if (mesh->GetNumberOfCells() == 0)
  {
    return 0;
  }
  vtkNew<vtkCellLocator> surface;
  surface->SetDataSet(mesh);
  surface->BuildLocator();
  double largest = 0;
  for (const Eigen::Vector3d& point : points_Model)
  {
    double closest[3], square = 0;
    vtkIdType cell = 0;
    int subCell = 0;
    surface->FindClosestPoint(point.data(), closest, cell, subCell, square);
    largest = std::max(largest, std::sqrt(square));
  }
  return largest;
}

}  // namespace handeye
