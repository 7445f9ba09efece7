// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeLensMapper.h"

#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLCamera.h>
#include <vtkOpenGLHelper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkShader.h>
#include <vtkShaderProgram.h>
#include <vtk_glew.h>

vtkStandardNewMacro(vtkHandEyeLensMapper);

namespace
{

// Two passes (depth, then colour) must agree on the depth to the last bit, hence invariant.
constexpr const char* WarpDeclaration = R"glsl(
invariant gl_Position;
out vec4 vertexVCVSOutput;
uniform mat4 lensVCDCMatrix;
uniform float lensK[14];
uniform mat3 lensTilt;
uniform float lensLimitRadius;
uniform float lensOuterSlope;

vec2 lensDistort(vec2 n)
{
  float r2 = dot(n, n);
  float numerator = 1.0 + r2 * (lensK[0] + r2 * (lensK[1] + r2 * lensK[4]));
  float denominator = 1.0 + r2 * (lensK[5] + r2 * (lensK[6] + r2 * lensK[7]));
  vec2 tangential = 2.0 * n.x * n.y * vec2(lensK[2], lensK[3]) + (r2 + 2.0 * n * n) * vec2(lensK[3], lensK[2]);
  vec2 prism = r2 * vec2(lensK[8] + r2 * lensK[9], lensK[10] + r2 * lensK[11]);
  vec2 bent = n * numerator / denominator + tangential + prism;
  vec3 tilted = lensTilt * vec3(bent, 1.0);
  return tilted.xy / tilted.z;
}

// View coordinates (x right, y up, z backward) in, view coordinates out.
vec4 lensWarp(vec4 position)
{
  vec2 offset = vec2(position.x, -position.y);
  float depth = max(-position.z, 0.0);
  float radius = length(offset);
  float believed = lensLimitRadius * depth;
  vec2 warped;
  if (depth > 0.0 && radius <= believed)
  {
    warped = depth * lensDistort(offset / depth);
  }
  else
  {
    vec2 outward = radius > 0.0 ? offset / radius : vec2(0.0);
    warped = depth * lensDistort(lensLimitRadius * outward) + lensOuterSlope * (radius - believed) * outward;
  }
  return vec4(warped.x, -warped.y, position.zw);
}
)glsl";

constexpr const char* WarpImplementation = R"glsl(
  vertexVCVSOutput = MCVCMatrix * vertexMC;
  gl_Position = lensVCDCMatrix * lensWarp(vertexVCVSOutput);
)glsl";

// The true position of this fragment, not the warped one, decides whether the lens model can be believed there.
constexpr const char* LimitImplementation = R"glsl(
  if (vertexVC.z >= 0.0 || length(vertexVC.xy) > -lensLimitRadius * vertexVC.z)
  {
    discard;
  }
  //VTK::Clip::Impl
)glsl";

constexpr const char* RimImplementation = R"glsl(
  float lensFacing = min(abs(dot(normalVCVSOutput, normalize(vertexVC.xyz))), 1.0);
  float lensRim = pow(1.0 - lensFacing, 3.0) * lensRimStrength;
  gl_FragData[0] = vec4(gl_FragData[0].rgb * (1.0 - 0.75 * lensRim), mix(gl_FragData[0].a, 1.0, lensRim));
  //VTK::Light::Impl
)glsl";

void substitute(vtkShader* shader, const std::string& tag, const std::string& replacement)
{
  std::string source = shader->GetSource();
  vtkShaderProgram::Substitute(source, tag, replacement);
  shader->SetSource(source);
}

}  // namespace

void vtkHandEyeLensMapper::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LimitRadius: " << this->Warp.limitRadius << "\n";
  os << indent << "DepthOnly: " << this->DepthOnly << "\n";
  os << indent << "RimStrength: " << this->RimStrength << "\n";
}

void vtkHandEyeLensMapper::SetLensWarp(const handeye::LensWarp& warp)
{
  // Only uniforms change, which are set at every rendering: no Modified(), which would build the shaders anew.
  this->Warp = warp;
}

void vtkHandEyeLensMapper::RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor)
{
  vtkOpenGLState* state = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow())->GetState();
  vtkOpenGLState::ScopedglColorMask colorMask(state);
  vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
  if (this->DepthOnly)
  {
    state->vtkglColorMask(0, 0, 0, 0);
  }
  // The colour pass finds its own depth already there. (A window may come with GL_LESS.)
  state->vtkglDepthFunc(GL_LEQUAL);
  this->Superclass::RenderPieceDraw(renderer, actor);
}

void vtkHandEyeLensMapper::ReplaceShaderPositionVC(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor)
{
  substitute(shaders[vtkShader::Vertex], "//VTK::PositionVC::Dec", WarpDeclaration);
  substitute(shaders[vtkShader::Vertex], "//VTK::PositionVC::Impl", WarpImplementation);
  substitute(shaders[vtkShader::Fragment], "//VTK::PositionVC::Dec", "in vec4 vertexVCVSOutput;\nuniform float lensLimitRadius;");
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
  substitute(shaders[vtkShader::Fragment], "//VTK::Clip::Impl", LimitImplementation);
  this->Superclass::ReplaceShaderClip(shaders, renderer, actor);
}

void vtkHandEyeLensMapper::ReplaceShaderLight(ShaderMap shaders, vtkRenderer* renderer, vtkActor* actor)
{
  substitute(shaders[vtkShader::Fragment], "//VTK::Light::Dec", "uniform float lensRimStrength;\n//VTK::Light::Dec");
  this->Superclass::ReplaceShaderLight(shaders, renderer, actor);
  if (this->PrimitiveInfo[this->LastBoundBO].LastLightComplexity > 0)
  {
    substitute(shaders[vtkShader::Fragment], "//VTK::Light::Impl", RimImplementation);
  }
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
  program->SetUniform1fv("lensK", int(this->Warp.coefficients.size()), this->Warp.coefficients.data());
  program->SetUniformMatrix3x3("lensTilt", this->Warp.tilt.data());
  program->SetUniformf("lensLimitRadius", float(this->Warp.limitRadius));
  program->SetUniformf("lensOuterSlope", float(this->Warp.outerSlope));
  if (program->IsUniformUsed("lensRimStrength"))
  {
    program->SetUniformf("lensRimStrength", float(this->RimStrength));
  }
}
