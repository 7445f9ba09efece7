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

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
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

/// For each point the first one at the same place.
std::vector<std::uint32_t> distinctPlaces(vtkPolyData* mesh)
{
  const auto count = std::size_t(mesh->GetNumberOfPoints());
  std::vector<std::array<double, 3>> points(count);
  std::vector<std::uint32_t> order(count), places(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    mesh->GetPoint(vtkIdType(i), points[i].data());
    order[i] = std::uint32_t(i);
  }
  std::sort(order.begin(), order.end(),
    [&points](std::uint32_t a, std::uint32_t b) { return points[a] < points[b] || (points[a] == points[b] && a < b); });
  for (std::size_t i = 0; i < count; ++i)
  {
    const bool isNew = i == 0 || points[order[i]] != points[order[i - 1]];
    places[order[i]] = isNew ? order[i] : places[order[i - 1]];
  }
  return places;
}

}  // namespace

bool isClosedSurface(vtkPolyData* triangles)
{
  const std::vector<std::uint32_t> places = distinctPlaces(triangles);
  std::vector<std::uint32_t> parts(places.size());
  std::iota(parts.begin(), parts.end(), 0);
  const auto partOf = [&parts](std::uint32_t place)
  {
    while (parts[place] != place)
    {
      place = parts[place] = parts[parts[place]];
    }
    return place;
  };
  std::vector<std::uint64_t> edges, reversed;
  vtkCellArray* cells = triangles->GetPolys();
  std::vector<Triangle> corners;
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    vtkIdType count;
    const vtkIdType* ids;
    cells->GetCellAtId(cell, count, ids);
    const Triangle ids3{ places[std::size_t(ids[0])], places[std::size_t(ids[1])], places[std::size_t(ids[2])] };
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::uint32_t from = ids3[i], to = ids3[(i + 1) % 3];
      edges.push_back(std::uint64_t(from) << 32 | to);
      reversed.push_back(std::uint64_t(to) << 32 | from);
      parts[partOf(from)] = partOf(to);
    }
    corners.push_back(ids3);
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  if (edges.empty() || edges != reversed || std::adjacent_find(edges.begin(), edges.end()) != edges.end())
  {
    return false;
  }
  std::unordered_map<std::uint32_t, double> volumes;
  const auto point = [triangles](std::uint32_t id)
  { return Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(triangles->GetPoint(vtkIdType(id)))); };
  const Eigen::Vector3d origin = point(corners.front()[0]);
  for (const Triangle& triangle : corners)
  {
    const Eigen::Vector3d a = point(triangle[0]) - origin, b = point(triangle[1]) - origin, c = point(triangle[2]) - origin;
    volumes[partOf(triangle[0])] += a.dot(b.cross(c));
  }
  return std::all_of(volumes.begin(), volumes.end(), [](const auto& part) { return part.second > 0; });
}

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

OverlayMesh prepareOverlayMesh(vtkPolyData* model)
{
  OverlayMesh result;
  result.mesh = triangulatedWithNormals(model);
  if (result.mesh->GetNumberOfPolys() > 0)
  {
    result.longestEdgeMm = EdgeDivider(result.mesh, std::numeric_limits<double>::infinity()).longestEdgeMm();
    result.isClosed = isClosedSurface(result.mesh);
  }
  return result;
}

OverlayMesh dividedOverlayMesh(const OverlayMesh& mesh, double longestEdgeMm)
{
  if (mesh.longestEdgeMm <= longestEdgeMm)
  {
    return mesh;
  }
  EdgeDivider divider(mesh.mesh, longestEdgeMm);
  while (divider.divide())
  {
  }
  return { divider.mesh(), divider.longestEdgeMm(), mesh.isClosed };
}

}  // namespace handeye
