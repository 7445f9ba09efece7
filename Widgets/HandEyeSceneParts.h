// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EigenVtk.h"
#include "HandEyeSceneGeometry.h"

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <optional>

namespace handeye
{

/// Private to HandEyeSceneProps: one thing of the scene.
struct HandEyeSceneProp
{
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;

  HandEyeSceneProp(double red, double green, double blue)
  {
    mapper->ScalarVisibilityOff();
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(red, green, blue);
    actor->GetProperty()->SetAmbient(0.15);
    actor->GetProperty()->SetDiffuse(0.85);
    actor->GetProperty()->SetSpecular(0.2);
    actor->GetProperty()->SetSpecularPower(20);
    actor->VisibilityOff();
  }

  /// Hidden without a pose.
  void place(const std::optional<Eigen::Isometry3d>& toTracker, bool wanted = true)
  {
    actor->SetVisibility(toTracker.has_value() && wanted);
    if (toTracker)
    {
      vtkNew<vtkMatrix4x4> matrix;
      toVtk(*toTracker, matrix);
      actor->SetUserMatrix(matrix);
    }
  }
};

/// Private to HandEyeSceneProps: many balls of one frame, each with its colour and radius.
struct HandEyeSceneBalls
{
  vtkNew<vtkPolyData> data;
  vtkNew<vtkGlyph3DMapper> mapper;
  vtkNew<vtkActor> actor;

  HandEyeSceneBalls()
  {
    mapper->SetInputData(data);
    mapper->SetSourceData(unitBall());
    mapper->SetScaleArray("radius");
    mapper->SetScaleModeToScaleByMagnitude();
    mapper->SetScalarModeToUsePointFieldData();
    mapper->SelectColorArray("color");
    mapper->SetColorModeToDirectScalars();
    actor->SetMapper(mapper);
    actor->GetProperty()->SetAmbient(0.25);
    actor->VisibilityOff();
  }

  void clear()
  {
    vtkNew<vtkPoints> points;
    vtkNew<vtkDoubleArray> radius;
    radius->SetName("radius");
    vtkNew<vtkUnsignedCharArray> color;
    color->SetName("color");
    color->SetNumberOfComponents(3);
    data->Initialize();
    data->SetPoints(points);
    data->GetPointData()->AddArray(radius);
    data->GetPointData()->AddArray(color);
  }

  void add(const Eigen::Vector3d& center, double radiusMm, const std::array<unsigned char, 3>& rgb)
  {
    data->GetPoints()->InsertNextPoint(center.data());
    vtkDoubleArray::SafeDownCast(data->GetPointData()->GetArray("radius"))->InsertNextValue(radiusMm);
    vtkUnsignedCharArray::SafeDownCast(data->GetPointData()->GetArray("color"))->InsertNextTypedTuple(rgb.data());
  }

  void place(const std::optional<Eigen::Isometry3d>& toTracker)
  {
    const bool any = data->GetNumberOfPoints() > 0;
    actor->SetVisibility(toTracker.has_value() && any);
    if (toTracker)
    {
      vtkNew<vtkMatrix4x4> matrix;
      toVtk(*toTracker, matrix);
      actor->SetUserMatrix(matrix);
    }
  }
};

}  // namespace handeye
