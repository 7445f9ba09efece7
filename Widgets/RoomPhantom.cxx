// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RoomPhantom.h"

#include "MeshReader.h"
#include "OverlayMesh.h"

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <array>
#include <utility>
#include <vector>

namespace handeye
{

std::shared_ptr<const simulation::RoomMesh> readRoomMesh(const std::filesystem::path& file)
{
  const vtkSmartPointer<vtkPolyData> mesh = triangulatedWithNormals(readMesh(file));
  std::vector<Eigen::Vector3d> points_Model(std::size_t(mesh->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points_Model.size(); ++i)
  {
    mesh->GetPoint(vtkIdType(i), points_Model[i].data());
  }
  std::vector<std::array<int, 3>> triangles;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, corners);
    if (corners->GetNumberOfIds() == 3)
    {
      triangles.push_back({ int(corners->GetId(0)), int(corners->GetId(1)), int(corners->GetId(2)) });
    }
  }
  return std::make_shared<simulation::RoomMesh>(std::move(points_Model), std::move(triangles));
}

}  // namespace handeye
