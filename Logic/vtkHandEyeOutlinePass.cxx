// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOutlinePass.h"

#include <vtkCameraPass.h>
#include <vtkLightsPass.h>
#include <vtkObjectFactory.h>
#include <vtkOpaquePass.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLQuadHelper.h>
#include <vtkOpenGLRenderUtilities.h>  // OpenGL's names, by GLEW or (VTK 9.4) GLAD
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

#include <vector>

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
uniform vec3 haloColor;
uniform float opacity;
uniform vec3 eye; // luma, alternate rows, offset of the rows

const int lineSteps = 16;
const int searchSteps = 16;
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

#ifdef WITH_HALO
// The covariance of a pixel, a polynomial in 1/depth: xx, xy, yy at the nodes of a grid from corner to corner.
uniform sampler2D haloConstant;
uniform sampler2D haloLinear;
uniform sampler2D haloQuadratic;
uniform vec2 haloGrid;
uniform vec2 haloScale;
uniform vec2 haloNearness; // 1/depth where the model is nearest and where it is furthest
uniform float haloQuantile;

// Takes the unit circle to the ellipse of the error (device px, y up) of what is seen around here, 1/nearness away.
mat2 haloEllipse(vec3 constant, vec3 linear, vec3 quadratic, float nearness)
{
  vec3 covariance = constant + nearness * (linear + nearness * quadratic);
  float xx = sqrt(max(covariance.x, 1e-12));
  float xy = covariance.y / xx;
  float yy = sqrt(max(covariance.z - xy * xy, 0.0));
  return haloQuantile * mat2(haloScale * vec2(xx, xy), haloScale * vec2(0.0, yy));
}

float sizeOf(mat2 ellipse)
{
  return dot(ellipse[0], ellipse[0]) + dot(ellipse[1], ellipse[1]);
}

vec2 onCircle(int step, int steps)
{
  float angle = 6.2831853 * float(step) / float(steps);
  return vec2(cos(angle), sin(angle));
}

float halo()
{
  vec2 node = (texCoord * (haloGrid - 1.0) + 0.5) / haloGrid;
  vec3 constant = texture(haloConstant, node).rgb;
  vec3 linear = texture(haloLinear, node).rgb;
  vec3 quadratic = texture(haloQuadratic, node).rgb;
  mat2 nearest = haloEllipse(constant, linear, quadratic, haloNearness.x);
  mat2 furthest = haloEllipse(constant, linear, quadratic, haloNearness.y);
  mat2 search = 1.1 * (sizeOf(nearest) > sizeOf(furthest) ? nearest : furthest);
  // How near the model is around here, if it is around here at all.
  float nearness = 0.0;
  float found = 0.0;
  for (int i = 0; i < searchSteps + searchSteps / 2; ++i)
  {
    bool inner = i >= searchSteps;
    vec2 away = search * onCircle(inner ? 2 * i + 1 : i, searchSteps) * (inner ? 0.5 : 1.0);
    float covered = coverage(texCoord + away * texel);
    nearness += covered / depthMm(texCoord + away * texel);
    found += covered;
  }
  // Around a large ellipse the search has gaps that a thin part fits into; the rings decide then.
  if (found < 0.5 && sizeOf(search) < 288.0)
  {
    return 0.0;
  }
  mat2 ellipse = found < 0.5 ? search / 1.1 : haloEllipse(constant, linear, quadratic, nearness / found);
  for (int ring = 1; ring <= 3; ++ring)
  {
    for (int i = 0; i < haloSteps; ++i)
    {
      vec2 away = float(ring) / 3.0 * (ellipse * onCircle(i, haloSteps));
      if (coverage(texCoord + away * texel) > 0.5)
      {
        return 0.95 - 0.2 * float(ring);
      }
    }
  }
  return 0.0;
}
#endif

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
    float around = here > 0.5 ? 0.0 : halo() * opacity;
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
  const std::string source = fragmentShader(this->Current.line, this->Current.haloField != nullptr);
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
  this->LoadField(window);
  std::vector<vtkTextureObject*> used{ this->Colors, this->Depths };
  if (this->Current.haloField)
  {
    used.insert(used.end(), this->Field.begin(), this->Field.end());
  }
  for (vtkTextureObject* texture : used)
  {
    texture->Activate();
  }
  this->SetParameters(this->Quad->Program, rectangle);
  this->Quad->Render();
  for (vtkTextureObject* texture : used)
  {
    texture->Deactivate();
  }
}

/// The field of the error goes to the graphics card when it is another one.
void vtkHandEyeOutlinePass::LoadField(vtkOpenGLRenderWindow* window)
{
  if (!this->Current.haloField || this->Current.haloField == this->LoadedField)
  {
    return;
  }
  const handeye::HandEyeErrorField& field = *this->Current.haloField;
  const handeye::HandEyeErrorField::Nodes* const parts[3] = { &field.constant(), &field.linear(), &field.quadratic() };
  for (std::size_t i = 0; i < this->Field.size(); ++i)
  {
    vtkSmartPointer<vtkTextureObject>& texture = this->Field[i];
    if (!texture)
    {
      texture = vtkSmartPointer<vtkTextureObject>::New();
      texture->SetContext(window);
      texture->SetMinificationFilter(vtkTextureObject::Linear);
      texture->SetMagnificationFilter(vtkTextureObject::Linear);
      texture->SetWrapS(vtkTextureObject::ClampToEdge);
      texture->SetWrapT(vtkTextureObject::ClampToEdge);
    }
    handeye::HandEyeErrorField::Nodes nodes = *parts[i];
    texture->Create2DFromRaw(
      handeye::HandEyeErrorField::Columns, handeye::HandEyeErrorField::Rows, 3, VTK_FLOAT, nodes.front().data());
  }
  this->LoadedField = this->Current.haloField;
}

void vtkHandEyeOutlinePass::SetHaloParameters(vtkShaderProgram* program)
{
  const char* const names[3] = { "haloConstant", "haloLinear", "haloQuadratic" };
  for (std::size_t i = 0; i < this->Field.size(); ++i)
  {
    program->SetUniformi(names[i], this->Field[i]->GetTextureUnit());
  }
  const auto& [nearestMm, furthestMm] = this->Current.modelDepthRangeMm;
  const float grid[2] = { float(handeye::HandEyeErrorField::Columns), float(handeye::HandEyeErrorField::Rows) };
  const float scale[2] = { float(this->Current.haloScale[0]), -float(this->Current.haloScale[1]) };  // the field's y is down
  const float nearness[2] = { float(1 / nearestMm), float(1 / furthestMm) };
  program->SetUniform2f("haloGrid", grid);
  program->SetUniform2f("haloScale", scale);
  program->SetUniform2f("haloNearness", nearness);
  program->SetUniformf("haloQuantile", float(handeye::ErrorQuantile95));
  program->SetUniform3f("haloColor", floats(this->Current.haloColor).data());
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
  if (settings.haloField)
  {
    this->SetHaloParameters(program);
  }
}

void vtkHandEyeOutlinePass::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Quad.reset();
  for (vtkTextureObject* texture :
    { this->Colors.Get(), this->Depths.Get(), this->Field[0].Get(), this->Field[1].Get(), this->Field[2].Get() })
  {
    if (texture)
    {
      texture->ReleaseGraphicsResources(window);
    }
  }
  this->Field = {};
  this->LoadedField.reset();
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
