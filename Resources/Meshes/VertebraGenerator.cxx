// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause

// Makes the vertebra model that the product ships: Vertebra.ply and VertebraLandmarks.txt, in the folder given.
// The shape is in VertebraShape.h; here it is sampled, contoured, smoothed, decimated, checked and written.
// Frame `Model`, mm: x to the patient's right, y anterior, z superior.

#include "VertebraShape.h"

#include <vtkCellArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPLYWriter.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkPolyDataNormals.h>
#include <vtkQuadricDecimation.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace
{
constexpr double SpacingMm = 0.6;
constexpr double TargetTriangles = 24000;
constexpr vtkIdType FewestTriangles = 10000, MostTriangles = 50000;

/// The implicit surface's values on a regular grid, with room all around the bone.
vtkSmartPointer<vtkImageData> sampleShape()
{
  const double low[3] = { -48, -72, -34 }, high[3] = { 48, 23, 28 };
  int size[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    size[axis] = 1 + static_cast<int>(std::ceil((high[axis] - low[axis]) / SpacingMm));
  }
  auto grid = vtkSmartPointer<vtkImageData>::New();
  grid->SetOrigin(low);
  grid->SetSpacing(SpacingMm, SpacingMm, SpacingMm);
  grid->SetDimensions(size);
  grid->AllocateScalars(VTK_FLOAT, 1);
  auto* values = static_cast<float*>(grid->GetScalarPointer());
  vtkSMPTools::For(0, size[2],
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType k = begin; k < end; ++k)
      {
        float* value = values + k * size[0] * size[1];
        for (int j = 0; j < size[1]; ++j)
        {
          for (int i = 0; i < size[0]; ++i)
          {
            const vertebra::Vec point{ low[0] + i * SpacingMm, low[1] + j * SpacingMm, low[2] + k * SpacingMm };
            *value++ = static_cast<float>(vertebra::vertebra(point));
          }
        }
      }
    });
  return grid;
}

/// The final triangles, wound so that normals point out of the bone.
vtkSmartPointer<vtkPolyData> makeMesh()
{
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(sampleShape());
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  // The relief may leave a loose crumb; the bone is the largest piece.
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetInputConnection(contour->GetOutputPort());
  largest->SetExtractionModeToLargestRegion();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(largest->GetOutputPort());
  smooth->SetNumberOfIterations(15);
  smooth->SetPassBand(0.12);
  smooth->NormalizeCoordinatesOn();
  smooth->Update();
  vtkNew<vtkQuadricDecimation> decimate;
  decimate->SetInputConnection(smooth->GetOutputPort());
  decimate->SetTargetReduction(1.0 - TargetTriangles / static_cast<double>(smooth->GetOutput()->GetNumberOfPolys()));
  // Decimation leaves a few needle triangles on the thin edges: a light second pass relaxes them.
  vtkNew<vtkWindowedSincPolyDataFilter> relax;
  relax->SetInputConnection(decimate->GetOutputPort());
  relax->SetNumberOfIterations(10);
  relax->SetPassBand(0.4);
  relax->NormalizeCoordinatesOn();
  vtkNew<vtkPolyDataNormals> orient;
  orient->SetInputConnection(relax->GetOutputPort());
  orient->SplittingOff();
  orient->ConsistencyOn();
  orient->AutoOrientNormalsOn();
  orient->Update();
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(orient->GetOutput()->GetPoints());
  mesh->SetPolys(orient->GetOutput()->GetPolys());
  return mesh;
}

void require(bool condition, const std::string& sentence)
{
  if (!condition)
  {
    throw std::runtime_error(sentence);
  }
}

vtkIdType edgeCount(vtkPolyData* mesh, bool boundary, bool nonManifold)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(mesh);
  edges->SetBoundaryEdges(boundary);
  edges->SetNonManifoldEdges(nonManifold);
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->Update();
  return edges->GetOutput()->GetNumberOfLines();
}

/// The volume (mm^3) that the triangles enclose: positive when they are wound outwards.
double signedVolume(vtkPolyData* mesh)
{
  double sum = 0.0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, ids);
    vertebra::Vec corner[3];
    for (int i = 0; i < 3; ++i)
    {
      const double* point = mesh->GetPoint(ids->GetId(i));
      corner[i] = { point[0], point[1], point[2] };
    }
    sum += vertebra::dot(corner[0], vertebra::cross(corner[1], corner[2]));
  }
  return sum / 6.0;
}

/// Around a manifold point the triangles form one fan: walking over shared edges meets all of them. Needs the mesh's links.
void checkFans(vtkPolyData* mesh)
{
  vtkNew<vtkIdList> ids;
  for (vtkIdType point = 0; point < mesh->GetNumberOfPoints(); ++point)
  {
    vtkNew<vtkIdList> around, neighbours;
    mesh->GetPointCells(point, around);
    require(around->GetNumberOfIds() > 0, "The mesh has a point that no triangle uses.");
    std::set<vtkIdType> fan;
    vtkIdType cell = around->GetId(0);
    while (fan.insert(cell).second)
    {
      mesh->GetCellPoints(cell, ids);
      const vtkIdType next = ids->GetId((ids->IsId(point) + 1) % 3);
      mesh->GetCellEdgeNeighbors(cell, point, next, neighbours);
      cell = neighbours->GetId(0);
    }
    require(
      static_cast<vtkIdType>(fan.size()) == around->GetNumberOfIds(), "The mesh touches itself in a point: it is not manifold.");
  }
}

/// Throws a sentence for the first thing that a vertebra's mesh must be and this one is not.
void checkMesh(vtkPolyData* mesh)
{
  const vtkIdType triangles = mesh->GetNumberOfPolys(), points = mesh->GetNumberOfPoints();
  require(triangles >= FewestTriangles && triangles <= MostTriangles,
    "The mesh has " + std::to_string(triangles) + " triangles, which is outside 10,000 to 50,000.");
  require(edgeCount(mesh, true, false) == 0, "The mesh has boundary edges: it is not closed.");
  require(edgeCount(mesh, false, true) == 0, "The mesh has edges with more than two triangles: it is not manifold.");

  mesh->BuildLinks();
  std::set<std::pair<vtkIdType, vtkIdType>> edges;
  std::set<std::set<vtkIdType>> faces;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < triangles; ++cell)
  {
    mesh->GetCellPoints(cell, ids);
    require(ids->GetNumberOfIds() == 3, "The mesh has a cell that is not a triangle.");
    std::set<vtkIdType> face;
    for (int i = 0; i < 3; ++i)
    {
      const vtkIdType a = ids->GetId(i), b = ids->GetId((i + 1) % 3);
      edges.insert({ std::min(a, b), std::max(a, b) });
      face.insert(a);
    }
    require(face.size() == 3 && faces.insert(face).second, "The mesh has a degenerate or repeated triangle.");
  }
  checkFans(mesh);

  vtkNew<vtkPolyDataConnectivityFilter> pieces;
  pieces->SetInputData(mesh);
  pieces->SetExtractionModeToAllRegions();
  pieces->Update();
  require(pieces->GetNumberOfExtractedRegions() == 1, "The mesh is in more than one piece.");
  const vtkIdType euler = points - static_cast<vtkIdType>(edges.size()) + triangles;
  require(euler == 0, "The Euler characteristic is " + std::to_string(euler) + ", not 0: the canal must be the one hole.");
  require(signedVolume(mesh) > 0.0, "The triangles are wound inwards: normals must point out of the bone.");

  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(mesh);
  locator->BuildLocator();
  double above[3] = { 0, -23, 60 }, below[3] = { 0, -23, -60 }, t = 0, hit[3], parametric[3];
  int subId = 0;
  require(locator->IntersectWithLine(above, below, 1e-6, t, hit, parametric, subId) == 0, "The vertebral canal is not open.");
}

void writeMesh(vtkPolyData* mesh, const std::string& fileName)
{
  // vtkPLYWriter returns success whatever happens, so look at the file before and after.
  require(std::ofstream(fileName, std::ios::trunc).good(), "Cannot write " + fileName + ".");
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileName(fileName.c_str());
  writer->SetFileTypeToBinary();
  writer->Write();
  std::ifstream written(fileName, std::ios::binary | std::ios::ate);
  // Three floats a point; a count and three integers a triangle.
  require(written.tellg() > 12 * mesh->GetNumberOfPoints() + 13 * mesh->GetNumberOfPolys(),
    "Only a part of " + fileName + " was written.");
}

/// The vertex that lies farthest in a direction among those that `inRegion` admits.
vertebra::Vec extremeVertex(
  vtkPolyData* mesh, const vertebra::Vec& direction, const std::function<bool(const vertebra::Vec&)>& inRegion)
{
  vertebra::Vec best;
  double farthest = -std::numeric_limits<double>::infinity();
  for (vtkIdType id = 0; id < mesh->GetNumberOfPoints(); ++id)
  {
    const double* point = mesh->GetPoint(id);
    const vertebra::Vec vertex{ point[0], point[1], point[2] };
    if (inRegion(vertex) && vertebra::dot(vertex, direction) > farthest)
    {
      farthest = vertebra::dot(vertex, direction);
      best = vertex;
    }
  }
  require(std::isfinite(farthest), "No vertex of the mesh lies where a landmark is looked for.");
  return best;
}

/// The points that a surgeon touches to register the bone, each a vertex of the mesh.
void writeLandmarks(vtkPolyData* mesh, const std::string& fileName)
{
  using vertebra::Vec;
  struct Landmark
  {
    const char* name;
    Vec direction;
    std::function<bool(const Vec&)> inRegion;
  };
  const auto anywhere = [](const Vec&) { return true; };
  const Landmark landmarks[] = {
    { "tip of the spinous process", { 0, -1, -0.3 }, anywhere },
    { "tip of the left transverse process", { -1, 0, 0 }, anywhere },
    { "tip of the right transverse process", { 1, 0, 0 }, anywhere },
    { "tip of the left superior articular process", { 0, 0, 1 }, [](const Vec& p) { return p.x < -8 && p.y < -22; } },
    { "tip of the right superior articular process", { 0, 0, 1 }, [](const Vec& p) { return p.x > 8 && p.y < -22; } },
    { "anterior superior rim of the body, midline", { 0, 1, 1 }, [](const Vec& p) { return std::abs(p.x) < 0.8; } },
  };
  std::ofstream file(fileName);
  file << "# Landmarks on Vertebra.ply, in its own frame (mm): x right, y anterior, z superior.\n";
  file.precision(3);
  file << std::fixed;
  for (const Landmark& landmark : landmarks)
  {
    const Vec point = extremeVertex(mesh, landmark.direction, landmark.inRegion);
    file << "# " << landmark.name << "\n" << point.x << ' ' << point.y << ' ' << point.z << "\n";
  }
  require(file.flush().good(), "Cannot write " + fileName + ".");
}
}  // namespace

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "Usage: VertebraGenerator FOLDER\n";
    return EXIT_FAILURE;
  }
  try
  {
    const std::string folder = argv[1];
    const vtkSmartPointer<vtkPolyData> mesh = makeMesh();
    checkMesh(mesh);
    writeMesh(mesh, folder + "/Vertebra.ply");
    writeLandmarks(mesh, folder + "/VertebraLandmarks.txt");
    const double* bounds = mesh->GetBounds();
    std::cout << mesh->GetNumberOfPolys() << " triangles, " << mesh->GetNumberOfPoints() << " points, " << bounds[1] - bounds[0]
              << " x " << bounds[3] - bounds[2] << " x " << bounds[5] - bounds[4] << " mm\n";
  }
  catch (const std::exception& error)
  {
    std::cerr << "VertebraGenerator: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
