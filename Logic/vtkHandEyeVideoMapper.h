// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensAppearance.h"

#include <vtkOpenGLPolyDataMapper.h>

/// Private to the overlay: draws a textured mesh as a frame of video. Nothing is repeated beyond its border (black there), and
/// the picture may be for one of two eyes that share the window's pixels.
class vtkHandEyeVideoMapper : public vtkOpenGLPolyDataMapper
{
public:
  static vtkHandEyeVideoMapper* New();
  vtkTypeMacro(vtkHandEyeVideoMapper, vtkOpenGLPolyDataMapper)

  void SetEye(const handeye::EyeChannel& eye);

  void RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor) override;

protected:
  vtkHandEyeVideoMapper() = default;
  ~vtkHandEyeVideoMapper() override = default;

  using ShaderMap = std::map<vtkShader::Type, vtkShader*>;
  void ReplaceShaderTCoord(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor) override;
  void SetCameraShaderParameters(vtkOpenGLHelper& cellBO, vtkRenderer* renderer, vtkActor* actor) override;

private:
  vtkHandEyeVideoMapper(const vtkHandEyeVideoMapper&) = delete;
  void operator=(const vtkHandEyeVideoMapper&) = delete;

  handeye::EyeChannel Eye;
};
