// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeLensMapper.h"

#include "LensShaders.h"

#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLCamera.h>
#include <vtkOpenGLHelper.h>
#include <vtkOpenGLRenderUtilities.h>  // OpenGL's names, by GLEW or (VTK 9.4) GLAD
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkOpenGLTexture.h>
#include <vtkRenderer.h>
#include <vtkShader.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>

#include <string>

vtkStandardNewMacro(vtkHandEyeLensMapper);

namespace
{

void substitute(vtkShader* shader, const std::string& tag, const std::string& replacement)
{
  std::string source = shader->GetSource();
  vtkShaderProgram::Substitute(source, tag, replacement);
  shader->SetSource(source);
}

void set2(vtkShaderProgram* program, const char* name, double a, double b)
{
  const float values[2] = { float(a), float(b) };
  program->SetUniform2f(name, values);
}

void set3(vtkShaderProgram* program, const char* name, double a, double b, double c)
{
  const float values[3] = { float(a), float(b), float(c) };
  program->SetUniform3f(name, values);
}

void set4(vtkShaderProgram* program, const char* name, double a, double b, double c, double d)
{
  const float values[4] = { float(a), float(b), float(c), float(d) };
  program->SetUniform4f(name, values);
}

/// A lens that bends nothing needs no shader that does.
bool bends(const handeye::LensWarp& warp)
{
  return warp.curvaturePx > 0;
}

}  // namespace

vtkHandEyeLensMapper::vtkHandEyeLensMapper() = default;

vtkHandEyeLensMapper::~vtkHandEyeLensMapper() = default;

void vtkHandEyeLensMapper::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LimitRadius: " << this->Warp.limitRadius << "\n";
  os << indent << "DepthOnly: " << this->DepthOnly << "\n";
  os << indent << "AlwaysInFront: " << this->AlwaysInFront << "\n";
  os << indent << "RimStrength: " << this->RimStrength << "\n";
}

void vtkHandEyeLensMapper::SetLensWarp(const handeye::LensWarp& warp)
{
  // Only uniforms change, which are set at every rendering: no Modified(), which would send the mesh to the graphics card again.
  const bool sameShader = bends(warp) == bends(this->Warp);
  this->Warp = warp;
  if (!sameShader)
  {
    this->ShaderTime.Modified();
  }
}

void vtkHandEyeLensMapper::SetAppearance(const handeye::LensAppearance& appearance)
{
  const handeye::LensAppearance& old = this->Appearance;
  const bool sameShader = old.features == appearance.features && old.eye.luma == appearance.eye.luma &&
    old.eye.alternateRows == appearance.eye.alternateRows && old.undistortedVideo == appearance.undistortedVideo;
  this->Appearance = appearance;
  if (!sameShader)
  {
    this->ShaderTime.Modified();
  }
}

void vtkHandEyeLensMapper::SetVideoTexture(vtkTexture* texture)
{
  if (bool(texture) != bool(this->VideoTexture))
  {
    this->ShaderTime.Modified();
  }
  this->VideoTexture = texture;
}

void vtkHandEyeLensMapper::RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor)
{
  vtkOpenGLState* state = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow())->GetState();
  vtkOpenGLState::ScopedglColorMask colorMask(state);
  vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
  vtkOpenGLState::ScopedglEnableDisable blending(state, GL_BLEND);
  const auto& colors = this->Appearance.eye.colors;
  if (this->DepthOnly)
  {
    state->vtkglColorMask(0, 0, 0, 0);
  }
  else
  {
    state->vtkglColorMask(colors[0], colors[1], colors[2], 1);
  }
  if (this->Appearance.features.compose)
  {
    state->vtkglDisable(GL_BLEND);
  }
  // A second pass over the same mesh finds its own depth already there. (A window may come with GL_LESS.)
  state->vtkglDepthFunc(this->AlwaysInFront ? GL_ALWAYS : GL_LEQUAL);

  auto* video = vtkOpenGLTexture::SafeDownCast(this->VideoTexture);
  vtkTextureObject* texture = video && this->Appearance.features.mix ? video->GetTextureObject() : nullptr;
  if (texture)
  {
    texture->Activate();
    this->VideoUnit = texture->GetTextureUnit();
  }
  this->Superclass::RenderPieceDraw(renderer, actor);
  if (texture)
  {
    texture->Deactivate();
    this->VideoUnit = -1;
  }
}

bool vtkHandEyeLensMapper::GetNeedToRebuildShaders(vtkOpenGLHelper& cellBO, vtkRenderer* renderer, vtkActor* actor)
{
  const bool needed = this->Superclass::GetNeedToRebuildShaders(cellBO, renderer, actor);
  return needed || cellBO.ShaderSourceTime < this->ShaderTime;
}

void vtkHandEyeLensMapper::ReplaceShaderPositionVC(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor)
{
  const handeye::LensAppearance::Features& features = this->Appearance.features;
  std::string defines = "\n";
  const auto define = [&defines](bool wanted, const char* name)
  {
    if (wanted)
    {
      defines += std::string("#define ") + name + "\n";
    }
  };
  define(bends(this->Warp), "LENS_BENT");
  define(features.limit, "LENS_LIMIT");
  define(this->DepthOnly, "LENS_BEHIND");
  define(features.compose, "LENS_COMPOSE");
  define(features.mix, "LENS_MIX");
  define(features.mix && this->VideoTexture, "LENS_VIDEO");
  define(features.mix && this->VideoTexture && this->Appearance.undistortedVideo, "LENS_LOOKUP");
  define(features.keyhole, "LENS_KEYHOLE");
  define(features.ghosting, "LENS_GHOSTING");
  define(features.clip, "LENS_CLIP");
  define(features.depthColors, "LENS_DEPTHCOLORS");
  define(this->Appearance.eye.luma, "LENS_LUMA");
  define(this->Appearance.eye.alternateRows, "LENS_ROWS");
  defines += handeye::shaders::Distort;

  substitute(shaders[vtkShader::Vertex], "//VTK::PositionVC::Dec", defines + handeye::shaders::WarpDeclaration);
  substitute(shaders[vtkShader::Vertex], "//VTK::PositionVC::Impl", handeye::shaders::WarpImplementation);
  substitute(shaders[vtkShader::Fragment], "//VTK::PositionVC::Dec",
    defines + handeye::shaders::FragmentDeclaration + handeye::shaders::LookDeclaration);
  substitute(shaders[vtkShader::Fragment], "//VTK::PositionVC::Impl", "vec4 vertexVC = vertexVCVSOutput;");
  if (this->PrimitiveInfo[this->LastBoundBO].LastLightComplexity == 0)
  {
    // VTK declares it for lit meshes alone.
    substitute(shaders[vtkShader::Vertex], "//VTK::Camera::Dec", "uniform mat4 MCVCMatrix;\n//VTK::Camera::Dec");
  }
  this->Superclass::ReplaceShaderPositionVC(shaders, renderer, actor);
}

void vtkHandEyeLensMapper::ReplaceShaderClip(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor)
{
  substitute(shaders[vtkShader::Fragment], "//VTK::Clip::Impl", handeye::shaders::LimitImplementation);
  this->Superclass::ReplaceShaderClip(shaders, renderer, actor);
}

void vtkHandEyeLensMapper::ReplaceShaderTCoord(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor)
{
  const bool lit = this->PrimitiveInfo[this->LastBoundBO].LastLightComplexity > 0;
  const std::string rim = lit ? handeye::shaders::RimImplementation : handeye::shaders::NoRimImplementation;
  substitute(shaders[vtkShader::Fragment], "//VTK::TCoord::Impl", rim + handeye::shaders::LookImplementation);
  this->Superclass::ReplaceShaderTCoord(shaders, renderer, actor);
}

void vtkHandEyeLensMapper::SetCameraShaderParameters(vtkOpenGLHelper& cellBO, vtkRenderer* renderer, vtkActor* actor)
{
  this->Superclass::SetCameraShaderParameters(cellBO, renderer, actor);
  vtkMatrix4x4 *worldToView, *worldToDisplay, *viewToDisplay;
  vtkMatrix3x3* normals;
  vtkOpenGLCamera::SafeDownCast(renderer->GetActiveCamera())
    ->GetKeyMatrices(renderer, worldToView, normals, viewToDisplay, worldToDisplay);
  vtkShaderProgram* program = cellBO.Program;
  program->SetUniformMatrix("lensVCDCMatrix", viewToDisplay);
  program->SetUniformf("lensLimitRadius", float(this->Warp.limitRadius));
  if (bends(this->Warp))
  {
    program->SetUniform1fv("lensK", int(this->Warp.coefficients.size()), this->Warp.coefficients.data());
    program->SetUniformMatrix3x3("lensTilt", this->Warp.tilt.data());
    program->SetUniformf("lensOuterSlope", float(this->Warp.outerSlope));
  }
  this->SetLookParameters(program);
}

void vtkHandEyeLensMapper::SetLookParameters(vtkShaderProgram* program)
{
  // Uniforms that the shader as built does not use are passed over.
  const handeye::LensAppearance& look = this->Appearance;
  program->SetUniformf("lensRimStrength", float(this->RimStrength));
  program->SetUniformf("lensOutputAlpha", float(look.outputAlpha));
  program->SetUniformf("lensOpacity", float(look.opacity));
  program->SetUniformf("lensClipDepth", float(look.clipDepthMm));
  program->SetUniformf("lensRowOffset", float(look.eye.rowOffset));
  program->SetUniformf("lensGhosting", float(look.ghosting));
  set2(program, "lensDepthRange", look.depthRangeMm[0], look.depthRangeMm[1]);
  set2(program, "lensVideoSize", look.videoSize[0], look.videoSize[1]);
  set3(program, "lensKeyhole", look.keyhole[0], look.keyhole[1], look.keyhole[2]);
  set4(program, "lensPicture", look.picture[0], look.picture[1], 1 / look.picture[2], 1 / look.picture[3]);
  if (this->VideoUnit >= 0)
  {
    program->SetUniformi("lensVideo", this->VideoUnit);
  }
  if (look.undistortedVideo)
  {
    program->SetUniform1fv("lookupK", int(look.lookup.coefficients.size()), look.lookup.coefficients.data());
    std::array<float, 9> tilt = look.lookup.tilt;
    program->SetUniformMatrix3x3("lookupTilt", tilt.data());
    set4(program, "lookupPinhole", look.pinhole[0], look.pinhole[1], look.pinhole[2], look.pinhole[3]);
  }
}
