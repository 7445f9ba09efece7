// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOutlinePass.h"

#include <vtkCameraPass.h>
#include <vtkLightsPass.h>
#include <vtkObjectFactory.h>
#include <vtkOpaquePass.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLQuadHelper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkOverlayPass.h>
#include <vtkRenderPassCollection.h>
#include <vtkRenderState.h>
#include <vtkRenderer.h>
#include <vtkSequencePass.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtkTranslucentPass.h>
#include <vtkVolumetricPass.h>
#include <vtk_glew.h>

vtkStandardNewMacro(vtkHandEyeOutlinePass);

namespace
{

constexpr const char* FragmentShader = R"glsl(
//VTK::System::Dec
//VTK::Output::Dec
in vec2 texCoord;
uniform sampler2D colors;
uniform sampler2D depths;
uniform vec2 texel;
uniform vec4 modelRectangle;
uniform vec2 depthRange;
uniform float lineRadius;
uniform vec3 lineColor;
uniform float depthStep;
uniform vec2 haloAxis1;
uniform vec2 haloAxis2;
uniform vec3 haloColor;
uniform float opacity;
uniform vec3 eye; // luma, alternate rows, offset of the rows

const int lineSteps = 16;
const int haloSteps = 20;

float coverage(vec2 place)
{
  return texture(colors, place).a > 0.75 ? 1.0 : 0.0;
}

float depthMm(vec2 place)
{
  float depth = texture(depths, place).r;
  return depthRange.x * depthRange.y / (depthRange.y - depth * (depthRange.y - depthRange.x));
}

// The share of a circle that is on the other side of the model's edge: a quarter is reached at 0.7 of the radius from it.
float edgeLine(float here)
{
  float different = 0.0;
  for (int i = 0; i < lineSteps; ++i)
  {
    float angle = 6.2831853 * float(i) / float(lineSteps);
    different += abs(coverage(texCoord + lineRadius * texel * vec2(cos(angle), sin(angle))) - here);
  }
  return clamp(4.0 * different / float(lineSteps), 0.0, 1.0);
}

// Where the depth has a step: a slanted surface has none, its depth is even.
float stepLine()
{
  float line = 0.0;
  float middle = depthMm(texCoord);
  for (int i = 0; i < 4; ++i)
  {
    float angle = 0.78539816 * float(i);
    vec2 away = lineRadius * texel * vec2(cos(angle), sin(angle));
    float known = coverage(texCoord + away) * coverage(texCoord - away);
    float bend = abs(depthMm(texCoord + away) + depthMm(texCoord - away) - 2.0 * middle);
    line = max(line, known * smoothstep(depthStep, 1.5 * depthStep, bend));
  }
  return line;
}

float halo()
{
  float strength = 0.0;
  for (int ring = 1; ring <= 3; ++ring)
  {
    float found = 0.0;
    for (int i = 0; i < haloSteps; ++i)
    {
      float angle = 6.2831853 * float(i) / float(haloSteps);
      vec2 away = float(ring) / 3.0 * (cos(angle) * haloAxis1 + sin(angle) * haloAxis2);
      found = max(found, coverage(texCoord + away * texel));
    }
    strength = max(strength, found * (0.95 - 0.2 * float(ring)));
  }
  return strength;
}

void main()
{
  vec2 pixel = texCoord / texel;
  if (eye.y > 0.5 && mod(floor(gl_FragCoord.y) + eye.z, 2.0) > 0.5)
  {
    discard;
  }
  vec4 drawn = texture(colors, texCoord);
  vec4 result = vec4(drawn.rgb, drawn.a > 0.25 ? 1.0 : 0.0);
  if (all(greaterThan(pixel, modelRectangle.xy)) && all(lessThan(pixel, modelRectangle.zw)))
  {
    float here = coverage(texCoord);
#ifdef WITH_HALO
    float around = (1.0 - here) * halo() * opacity;
    result = mix(vec4(haloColor, around), result, result.a);
#endif
#ifdef WITH_LINE
    float line = edgeLine(here);
    line = max(line, here * stepLine()) * opacity;
    result = vec4(mix(result.a > 0.0 ? result.rgb : lineColor, lineColor, line), max(result.a, line));
#endif
  }
  if (result.a <= 0.0)
  {
    discard;
  }
  if (eye.x > 0.5)
  {
    result.rgb = vec3(dot(result.rgb, vec3(0.299, 0.587, 0.114)));
  }
  gl_FragData[0] = result;
}
)glsl";

std::string fragmentShader(bool line, bool halo)
{
  std::string source = FragmentShader;
  const std::string tag = "//VTK::Output::Dec";
  const std::string defines = std::string(line ? "#define WITH_LINE\n" : "") + (halo ? "#define WITH_HALO\n" : "");
  source.insert(source.find(tag), defines);
  return source;
}

template<std::size_t count> std::array<float, count> floats(const std::array<double, count>& values)
{
  std::array<float, count> result;
  for (std::size_t i = 0; i < count; ++i)
  {
    result[i] = float(values[i]);
  }
  return result;
}

}  // namespace

vtkHandEyeOutlinePass::vtkHandEyeOutlinePass()
{
  vtkNew<vtkRenderPassCollection> passes;
  passes->AddItem(vtkNew<vtkLightsPass>());
  passes->AddItem(vtkNew<vtkOpaquePass>());
  passes->AddItem(vtkNew<vtkTranslucentPass>());
  passes->AddItem(vtkNew<vtkVolumetricPass>());
  vtkNew<vtkSequencePass> sequence;
  sequence->SetPasses(passes);
  vtkNew<vtkCameraPass> camera;
  camera->SetDelegatePass(sequence);
  this->Props = camera;
  this->Texts = vtkSmartPointer<vtkOverlayPass>::New();
}

vtkHandEyeOutlinePass::~vtkHandEyeOutlinePass() = default;

void vtkHandEyeOutlinePass::Render(const vtkRenderState* state)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(state->GetRenderer()->GetRenderWindow());
  int width, height, x, y;
  state->GetRenderer()->GetTiledSizeAndOrigin(&width, &height, &x, &y);
  if (width < 1 || height < 1)
  {
    return;
  }
  this->RenderProps(state, window, width, height);
  this->NumberOfRenderedProps = this->Props->GetNumberOfRenderedProps();
  this->Compose(window, { x, y, width, height });
  this->Texts->Render(state);
}

void vtkHandEyeOutlinePass::RenderProps(const vtkRenderState* state, vtkOpenGLRenderWindow* window, int width, int height)
{
  if (!this->Framebuffer)
  {
    this->Framebuffer = vtkSmartPointer<vtkOpenGLFramebufferObject>::New();
    this->Framebuffer->SetContext(window);
    this->Colors = vtkSmartPointer<vtkTextureObject>::New();
    this->Colors->SetContext(window);
    this->Colors->Allocate2D(unsigned(width), unsigned(height), 4, VTK_UNSIGNED_CHAR);
    this->Depths = vtkSmartPointer<vtkTextureObject>::New();
    this->Depths->SetContext(window);
    this->Depths->AllocateDepth(unsigned(width), unsigned(height), vtkTextureObject::Float32);
    for (vtkTextureObject* texture : { this->Colors.Get(), this->Depths.Get() })
    {
      texture->SetMinificationFilter(vtkTextureObject::Nearest);
      texture->SetMagnificationFilter(vtkTextureObject::Nearest);
      texture->SetWrapS(vtkTextureObject::ClampToEdge);
      texture->SetWrapT(vtkTextureObject::ClampToEdge);
    }
  }
  this->Colors->Resize(unsigned(width), unsigned(height));
  this->Depths->Resize(unsigned(width), unsigned(height));

  vtkOpenGLState* opengl = window->GetState();
  opengl->PushFramebufferBindings();
  this->Framebuffer->Bind();
  this->Framebuffer->AddColorAttachment(0, this->Colors);
  this->Framebuffer->AddDepthAttachment(this->Depths);
  this->Framebuffer->ActivateDrawBuffer(0);
  this->Framebuffer->StartNonOrtho(width, height);
  opengl->vtkglViewport(0, 0, width, height);
  opengl->vtkglScissor(0, 0, width, height);
  opengl->vtkglClearColor(0, 0, 0, 0);
  opengl->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  vtkRenderState inside(state->GetRenderer());
  inside.SetPropArrayAndCount(state->GetPropArray(), state->GetPropArrayCount());
  inside.SetFrameBuffer(this->Framebuffer);
  this->Props->Render(&inside);
  opengl->PopFramebufferBindings();
}

void vtkHandEyeOutlinePass::Compose(vtkOpenGLRenderWindow* window, const std::array<int, 4>& rectangle)
{
  vtkOpenGLState* opengl = window->GetState();
  const std::string source = fragmentShader(this->Current.line, this->Current.halo);
  // The cache knows a source that it has compiled before.
  this->Quad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr, source.c_str(), nullptr);
  vtkOpenGLState::ScopedglEnableDisable blending(opengl, GL_BLEND);
  vtkOpenGLState::ScopedglEnableDisable depth(opengl, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglColorMask colorMask(opengl);
  vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(opengl);
  opengl->vtkglEnable(GL_BLEND);
  opengl->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  opengl->vtkglDisable(GL_DEPTH_TEST);
  const auto& colors = this->Current.eye.colors;
  opengl->vtkglColorMask(colors[0], colors[1], colors[2], 1);
  opengl->vtkglViewport(rectangle[0], rectangle[1], rectangle[2], rectangle[3]);
  opengl->vtkglScissor(rectangle[0], rectangle[1], rectangle[2], rectangle[3]);
  this->Colors->Activate();
  this->Depths->Activate();
  this->SetParameters(this->Quad->Program, rectangle);
  this->Quad->Render();
  this->Depths->Deactivate();
  this->Colors->Deactivate();
}

void vtkHandEyeOutlinePass::SetParameters(vtkShaderProgram* program, const std::array<int, 4>& rectangle)
{
  const Settings& settings = this->Current;
  const float texel[2] = { 1.0f / float(rectangle[2]), 1.0f / float(rectangle[3]) };
  const float eye[3] = { settings.eye.luma ? 1.0f : 0.0f, settings.eye.alternateRows ? 1.0f : 0.0f, float(settings.eye.rowOffset) };
  program->SetUniformi("colors", this->Colors->GetTextureUnit());
  program->SetUniformi("depths", this->Depths->GetTextureUnit());
  program->SetUniform2f("texel", texel);
  program->SetUniform3f("eye", eye);
  program->SetUniform4f("modelRectangle", floats(settings.modelRectanglePx).data());
  program->SetUniform2f("depthRange", floats(settings.depthRangeMm).data());
  program->SetUniformf("opacity", float(settings.opacity));
  program->SetUniformf("lineRadius", float(settings.lineWidthPx / 2));
  program->SetUniform3f("lineColor", floats(settings.lineColor).data());
  program->SetUniformf("depthStep", float(settings.depthStepMm));
  program->SetUniform2f("haloAxis1", floats(settings.haloAxis1Px).data());
  program->SetUniform2f("haloAxis2", floats(settings.haloAxis2Px).data());
  program->SetUniform3f("haloColor", floats(settings.haloColor).data());
}

void vtkHandEyeOutlinePass::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Quad.reset();
  for (vtkTextureObject* texture : { this->Colors.Get(), this->Depths.Get() })
  {
    if (texture)
    {
      texture->ReleaseGraphicsResources(window);
    }
  }
  if (this->Framebuffer)
  {
    this->Framebuffer->ReleaseGraphicsResources(window);
  }
  this->Framebuffer = nullptr;
  this->Colors = nullptr;
  this->Depths = nullptr;
  this->Props->ReleaseGraphicsResources(window);
  this->Texts->ReleaseGraphicsResources(window);
}
