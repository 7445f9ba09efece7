// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeVideoMapper.h"

#include <vtkObjectFactory.h>
#include <vtkOpenGLHelper.h>
#include <vtkOpenGLRenderUtilities.h>  // OpenGL's names, by GLEW or (VTK 9.4) GLAD
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkShader.h>
#include <vtkShaderProgram.h>

#include <string>

vtkStandardNewMacro(vtkHandEyeVideoMapper);

namespace
{

constexpr const char* Declaration = R"glsl(
uniform float lensRowOffset;
//VTK::TCoord::Dec
)glsl";

constexpr const char* Implementation = R"glsl(
  //VTK::TCoord::Impl
  vec3 videoColor = gl_FragData[0].rgb;
  vec2 videoBeyond = abs(tcoordVCVSOutput.xy - 0.5);
  videoColor *= max(videoBeyond.x, videoBeyond.y) > 0.5 ? 0.0 : 1.0;
)glsl";

}  // namespace

void vtkHandEyeVideoMapper::SetEye(const handeye::EyeChannel& eye)
{
  if (!(this->Eye == eye))
  {
    this->Eye = eye;
    this->Modified();
  }
}

void vtkHandEyeVideoMapper::RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor)
{
  vtkOpenGLState* state = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow())->GetState();
  vtkOpenGLState::ScopedglColorMask colorMask(state);
  vtkOpenGLState::ScopedglEnableDisable blending(state, GL_BLEND);
  vtkOpenGLState::ScopedglEnableDisable depth(state, GL_DEPTH_TEST);
  state->vtkglColorMask(this->Eye.colors[0], this->Eye.colors[1], this->Eye.colors[2], 1);
  state->vtkglDisable(GL_BLEND);
  state->vtkglDisable(GL_DEPTH_TEST);
  this->Superclass::RenderPieceDraw(renderer, actor);
}

void vtkHandEyeVideoMapper::ReplaceShaderTCoord(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor)
{
  std::string implementation = Implementation;
  if (this->Eye.alternateRows)
  {
    implementation = "  if (mod(floor(gl_FragCoord.y) + lensRowOffset, 2.0) > 0.5) { discard; }\n" + implementation;
  }
  if (this->Eye.luma)
  {
    implementation += "  videoColor = vec3(dot(videoColor, vec3(0.299, 0.587, 0.114)));\n";
  }
  implementation += "  gl_FragData[0] = vec4(videoColor, 1.0);\n";
  vtkShader* fragment = shaders[vtkShader::Fragment];
  std::string source = fragment->GetSource();
  vtkShaderProgram::Substitute(source, "//VTK::TCoord::Dec", Declaration);
  vtkShaderProgram::Substitute(source, "//VTK::TCoord::Impl", implementation);
  fragment->SetSource(source);
  this->Superclass::ReplaceShaderTCoord(shaders, renderer, actor);
}

void vtkHandEyeVideoMapper::SetCameraShaderParameters(vtkOpenGLHelper& cellBO, vtkRenderer* renderer, vtkActor* actor)
{
  this->Superclass::SetCameraShaderParameters(cellBO, renderer, actor);
  cellBO.Program->SetUniformf("lensRowOffset", float(this->Eye.rowOffset));
}
