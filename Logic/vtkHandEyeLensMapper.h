// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensAppearance.h"
#include "LensWarp.h"
#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <vtkOpenGLPolyDataMapper.h>
#include <vtkSmartPointer.h>

class vtkTexture;

/// Draws a mesh as a distorted (raw) video shows it: bends its vertices on the graphics card as the lens bends light (see
/// LensWarp).
///
/// The mapper expects view coordinates that are those of the `Camera` frame with y and z turned: the virtual camera in the origin,
/// looking along +z, y down. What is nearer than the near plane, behind the camera, or further off the axis than the lens model can
/// be believed is not drawn; the last is decided for every pixel, so that a large triangle cannot fold back into the picture
/// either. Lighting uses the true positions and normals.
///
/// A vertex shader bends no edges: triangles must be small enough (longestEdgeMm()).
///
/// With SetAppearance(), the mapper mixes the colour of the video in by itself instead of being blended: whatever the opacity, the
/// depth test leaves the foremost surface alone, in one pass over the mesh.
class VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkHandEyeLensMapper : public vtkOpenGLPolyDataMapper
{
public:
  static vtkHandEyeLensMapper* New();
  vtkTypeMacro(vtkHandEyeLensMapper, vtkOpenGLPolyDataMapper)
  void PrintSelf(std::ostream& os, vtkIndent indent) override;

  void SetLensWarp(const handeye::LensWarp& warp);

  /// Write depth, no colour, a hundredth of the depth range further away: hides lines, but not those that lie on it. Off by
  /// default.
  vtkSetMacro(DepthOnly, bool);
  vtkGetMacro(DepthOnly, bool);

  /// Drawn whatever lies in front of it. Off by default.
  vtkSetMacro(AlwaysInFront, bool);
  vtkGetMacro(AlwaysInFront, bool);

  /// How much a surface seen edge-on is darkened and made opaque, 0 (not at all, the default) to 1: draws the outlines of anatomy.
  vtkSetClampMacro(RimStrength, double, 0.0, 1.0);
  vtkGetMacro(RimStrength, double);

  /// What the pixels of the mesh become; plainly shaded and blended until set. A change of features builds the shader anew.
  void SetAppearance(const handeye::LensAppearance& appearance);

  /// The video that the appearance mixes in; it must have been rendered in the same window before. Null: black.
  void SetVideoTexture(vtkTexture* texture);

  void RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor) override;

protected:
  vtkHandEyeLensMapper();
  ~vtkHandEyeLensMapper() override;

  using ShaderMap = std::map<vtkShader::Type, vtkShader*>;
  bool GetNeedToRebuildShaders(vtkOpenGLHelper& cellBO, vtkRenderer* renderer, vtkActor* actor) override;
  void ReplaceShaderPositionVC(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor) override;
  void ReplaceShaderClip(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor) override;
  void ReplaceShaderTCoord(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor) override;
  void SetCameraShaderParameters(vtkOpenGLHelper& cellBO, vtkRenderer* renderer, vtkActor* actor) override;

private:
  vtkHandEyeLensMapper(const vtkHandEyeLensMapper&) = delete;
  void operator=(const vtkHandEyeLensMapper&) = delete;

  void SetLookParameters(vtkShaderProgram* program);

  handeye::LensWarp Warp;
  handeye::LensAppearance Appearance;
  vtkSmartPointer<vtkTexture> VideoTexture;
  vtkTimeStamp ShaderTime;  ///< of the last change that needs another shader, but not another mesh
  int VideoUnit = -1;       ///< while drawing
  bool DepthOnly = false;
  bool AlwaysInFront = false;
  double RimStrength = 0;
};
