// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoMesh.h"

#include <Eigen/Core>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double TolerancePx = 0.08;
constexpr double LargestCellPx = 64;
constexpr int MostNodes = 1000;

class MeshOfCells
{
public:
  MeshOfCells()
  {
    this->Places->SetNumberOfComponents(2);
    this->Places->SetName("Places");
  }

  void addNode(double x, double y, const Eigen::Vector2d& place)
  {
    this->Points->InsertNextPoint(x, y, 0);
    this->Places->InsertNextTuple2(place.x(), place.y());
  }

  void addCell(vtkIdType a, vtkIdType b, vtkIdType c, vtkIdType d)
  {
    this->Cells->InsertNextCell({ a, b, c });
    this->Cells->InsertNextCell({ a, c, d });
  }

  vtkSmartPointer<vtkPolyData> mesh() const
  {
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(this->Points);
    mesh->SetPolys(this->Cells);
    mesh->GetPointData()->SetTCoords(this->Places);
    return mesh;
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkFloatArray> Places;
  vtkNew<vtkCellArray> Cells;
};

/// Side of a cell over which the lens' bend stays within the tolerance; its diagonal is what counts.
double cellPx(const CameraModel& camera, const LensWarp& warp)
{
  const double focal = std::min(camera.fx(), camera.fy());
  const double diagonal_Normalized = std::sqrt(8 * TolerancePx / std::max(warp.curvaturePx, 1e-6));
  return std::min(LargestCellPx, focal * diagonal_Normalized / std::sqrt(2.0));
}

int nodeCount(double lengthPx, double cell)
{
  return std::clamp(int(std::ceil(lengthPx / cell)) + 1, 2, MostNodes);
}

}  // namespace

vtkSmartPointer<vtkPolyData> makeRawVideoMesh()
{
  MeshOfCells square;
  square.addNode(-1, -1, { 0, 0 });
  square.addNode(1, -1, { 1, 0 });
  square.addNode(1, 1, { 1, 1 });
  square.addNode(-1, 1, { 0, 1 });
  square.addCell(0, 1, 2, 3);
  return square.mesh();
}

vtkSmartPointer<vtkPolyData> makeUndistortedVideoMesh(const CameraModel& camera, const LensWarp& warp)
{
  const Eigen::Array2d size(camera.width(), camera.height());
  const Eigen::Array2d focal(camera.fx(), camera.fy()), principal(camera.cx(), camera.cy());
  const double cell = cellPx(camera, warp);
  const int columns = nodeCount(size.x(), cell), rows = nodeCount(size.y(), cell);
  MeshOfCells grid;
  std::vector<bool> believed;
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      const Eigen::Array2d share(double(column) / (columns - 1), double(row) / (rows - 1));  // from the upper left corner
      const Eigen::Array2d point_Normalized = (share * size - 0.5 - principal) / focal;
      believed.push_back(point_Normalized.matrix().norm() <= warp.limitRadius);
      const Eigen::Array2d seen_Image = camera.distort(point_Normalized.matrix()).array() * focal + principal;
      const Eigen::Array2d place = (seen_Image + 0.5) / size;
      grid.addNode(2 * share.x() - 1, 1 - 2 * share.y(), { place.x(), 1 - place.y() });
    }
  }
  for (int row = 0; row + 1 < rows; ++row)
  {
    for (int column = 0; column + 1 < columns; ++column)
    {
      const int corner = row * columns + column;
      const int corners[4] = { corner, corner + columns, corner + columns + 1, corner + 1 };
      if (std::all_of(corners, corners + 4, [&](int node) { return believed[std::size_t(node)]; }))
      {
        grid.addCell(corners[0], corners[1], corners[2], corners[3]);
      }
    }
  }
  return grid.mesh();
}

}  // namespace handeye
