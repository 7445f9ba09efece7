// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayMesh.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkTriangleFilter.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace handeye
{

namespace
{

constexpr std::size_t MostTriangles = 1000000;
constexpr double SharpEdgeDeg = 60;  // beyond this angle between two faces their common edge is meant to be sharp

using Triangle = std::array<std::uint32_t, 3>;

/// Divides every edge that is too long in its middle, the same way for both triangles at it, so that no cracks appear.
class EdgeDivider
{
public:
  EdgeDivider(vtkPolyData* mesh, double limitMm);

  /// One pass. @return false if no edge is too long, or more triangles would be too many
  bool divide();
  double longestEdgeMm() const;
  vtkSmartPointer<vtkPolyData> mesh() const;

private:
  static constexpr std::uint32_t None = 0xffffffff;

  double edgeMm(std::uint32_t a, std::uint32_t b) const { return (Points[a] - Points[b]).norm(); }
  std::uint32_t middle(std::uint32_t a, std::uint32_t b);
  void divideTriangle(const Triangle& corners, const Triangle& middles);

  double LimitMm;
  std::vector<Eigen::Vector3d> Points;
  std::vector<Eigen::Vector3d> Normals;
  std::vector<Triangle> Triangles;
  std::vector<Triangle> Divided;
  std::unordered_map<std::uint64_t, std::uint32_t> Middles;  ///< by the two ends
};

EdgeDivider::EdgeDivider(vtkPolyData* mesh, double limitMm)
  : LimitMm(limitMm)
  , Points(std::size_t(mesh->GetNumberOfPoints()))
  , Normals(Points.size())
{
  vtkDataArray* normals = mesh->GetPointData()->GetNormals();
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    mesh->GetPoint(vtkIdType(i), this->Points[i].data());
    normals->GetTuple(vtkIdType(i), this->Normals[i].data());
  }
  vtkCellArray* cells = mesh->GetPolys();
  this->Triangles.reserve(std::size_t(cells->GetNumberOfCells()));
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    vtkIdType count;
    const vtkIdType* ids;
    cells->GetCellAtId(cell, count, ids);
    this->Triangles.push_back({ std::uint32_t(ids[0]), std::uint32_t(ids[1]), std::uint32_t(ids[2]) });
  }
}

std::uint32_t EdgeDivider::middle(std::uint32_t a, std::uint32_t b)
{
  if (this->edgeMm(a, b) <= this->LimitMm)
  {
    return None;
  }
  const std::uint64_t key = std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
  const auto [place, isNew] = this->Middles.try_emplace(key, std::uint32_t(this->Points.size()));
  if (isNew)
  {
    this->Points.emplace_back((this->Points[a] + this->Points[b]) / 2);
    this->Normals.emplace_back((this->Normals[a] + this->Normals[b]).normalized());
  }
  return place->second;
}

void EdgeDivider::divideTriangle(const Triangle& corners, const Triangle& middles)
{
  // middles[i] lies between corners i and i + 1.
  const auto divided = std::count_if(middles.begin(), middles.end(), [](std::uint32_t id) { return id != None; });
  if (divided == 0)
  {
    this->Divided.push_back(corners);
    return;
  }
  if (divided == 3)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      this->Divided.push_back({ corners[i], middles[i], middles[(i + 2) % 3] });
    }
    this->Divided.push_back(middles);
    return;
  }
  // Turned so that edge 0 is divided, and edge 2 is not.
  std::size_t turn = 0;
  while (middles[turn] == None || middles[(turn + 2) % 3] != None)
  {
    ++turn;
  }
  const std::uint32_t a = corners[turn], b = corners[(turn + 1) % 3], c = corners[(turn + 2) % 3];
  const std::uint32_t ab = middles[turn], bc = middles[(turn + 1) % 3];
  if (divided == 1)
  {
    this->Divided.insert(this->Divided.end(), { { a, ab, c }, { ab, b, c } });
    return;
  }
  this->Divided.push_back({ ab, b, bc });
  if (this->edgeMm(a, bc) < this->edgeMm(ab, c))
  {
    this->Divided.insert(this->Divided.end(), { { a, ab, bc }, { a, bc, c } });
  }
  else
  {
    this->Divided.insert(this->Divided.end(), { { a, ab, c }, { ab, bc, c } });
  }
}

bool EdgeDivider::divide()
{
  const std::size_t pointsBefore = this->Points.size();
  this->Divided.clear();
  this->Middles.clear();
  for (const Triangle& corners : this->Triangles)
  {
    Triangle middles;
    for (std::size_t i = 0; i < 3; ++i)
    {
      middles[i] = this->middle(corners[i], corners[(i + 1) % 3]);
    }
    this->divideTriangle(corners, middles);
    if (this->Divided.size() > MostTriangles)
    {
      this->Points.resize(pointsBefore);
      this->Normals.resize(pointsBefore);
      return false;
    }
  }
  std::swap(this->Triangles, this->Divided);
  return this->Points.size() > pointsBefore;
}

double EdgeDivider::longestEdgeMm() const
{
  double longest = 0;
  for (const Triangle& corners : this->Triangles)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      longest = std::max(longest, this->edgeMm(corners[i], corners[(i + 1) % 3]));
    }
  }
  return longest;
}

vtkSmartPointer<vtkPolyData> EdgeDivider::mesh() const
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    points->InsertNextPoint(this->Points[i].data());
    normals->InsertNextTuple(this->Normals[i].data());
  }
  vtkNew<vtkCellArray> cells;
  for (const Triangle& corners : this->Triangles)
  {
    cells->InsertNextCell({ vtkIdType(corners[0]), vtkIdType(corners[1]), vtkIdType(corners[2]) });
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  mesh->GetPointData()->SetNormals(normals);
  return mesh;
}

}  // namespace

vtkSmartPointer<vtkPolyData> triangulatedWithNormals(vtkPolyData* model)
{
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(model);
  triangles->PassLinesOff();
  triangles->PassVertsOff();
  triangles->Update();
  if (triangles->GetOutput()->GetPointData()->GetNormals())
  {
    return triangles->GetOutput();
  }
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputConnection(triangles->GetOutputPort());
  normals->SetFeatureAngle(SharpEdgeDeg);
  normals->Update();
  return normals->GetOutput();
}

OverlayMesh prepareOverlayMesh(vtkPolyData* model, double longestEdgeMm)
{
  OverlayMesh result;
  result.mesh = triangulatedWithNormals(model);
  if (result.mesh->GetNumberOfPolys() == 0)
  {
    return result;
  }
  EdgeDivider divider(result.mesh, longestEdgeMm);
  bool divided = false;
  while (divider.divide())
  {
    divided = true;
  }
  result.longestEdgeMm = divider.longestEdgeMm();
  if (divided)
  {
    result.mesh = divider.mesh();
  }
  return result;
}

}  // namespace handeye
