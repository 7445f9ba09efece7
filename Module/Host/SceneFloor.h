// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

class vtkRenderer;

namespace desktop
{

/// A grid under what is in a scene, for a sense of place and size.
class SceneFloor
{
public:
  /// Across which axis of the scene the floor lies. None: no floor.
  enum class Plane
  {
    None,
    AcrossX,
    AcrossY,
    AcrossZ
  };

  explicit SceneFloor(vtkRenderer* renderer);

  void setPlane(Plane plane);
  Plane plane() const { return this->Across; }
  void setColor(double red, double green, double blue);

  /// Whether the grid counts as a part of the scene: for what is near and far of a camera yes, for what there is to be seen no.
  void setCounted(bool on);

  /// Lays the grid below these bounds (mm; VTK's order of six), or about the origin if they are empty.
  void placeUnder(const double bounds[6]);

  /// Between two lines, mm: 1, 10, 100...
  double spacingMm() const { return this->SpacingMm; }

private:
  vtkNew<vtkPolyData> Lines;
  vtkNew<vtkActor> Actor;
  Plane Across = Plane::AcrossY;
  double SpacingMm = 100;
};

}  // namespace desktop
