// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOverlayScene.h"

#include "vtkHandEyeLensMapper.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkCullerCollection.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkMath.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkPlaneSource.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>
#include <vtkTransform.h>

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkHandEyeOverlayScene);

namespace
{

constexpr int LayerCount = 3;
constexpr double NearestMm = 1;      // the near plane: nothing is looked at from closer than this
constexpr double DepthRatio = 1e-4;  // least near/far, for a depth buffer of 24 bits
constexpr double ModelRimStrength = 0.85;

void addLight(vtkRenderer* renderer, double x, double y, double z, double intensity, double red, double green, double blue)
{
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(x, y, z);
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(intensity);
  light->SetColor(red, green, blue);
  renderer->AddLight(light);
}

/// Smallest and largest Z of a mesh's bounding box in the Camera frame.
std::array<double, 2> depthRange(vtkPolyData* mesh, vtkMatrix4x4* modelToCamera)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  std::array<double, 2> range{ VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX };
  for (int corner = 0; corner < 8; ++corner)
  {
    const double corner_Model[4] = { bounds[corner & 1], bounds[2 + ((corner >> 1) & 1)], bounds[4 + ((corner >> 2) & 1)], 1 };
    double corner_Camera[4];
    modelToCamera->MultiplyPoint(corner_Model, corner_Camera);
    range[0] = std::min(range[0], corner_Camera[2]);
    range[1] = std::max(range[1], corner_Camera[2]);
  }
  return range;
}

}  // namespace

vtkHandEyeOverlayScene::vtkHandEyeOverlayScene()
{
  vtkRenderer* const renderers[LayerCount] = { this->BarsRenderer, this->VideoRenderer, this->ModelRenderer };
  for (int layer = 0; layer < LayerCount; ++layer)
  {
    renderers[layer]->SetLayer(layer);
    renderers[layer]->InteractiveOff();
    renderers[layer]->SetBackground(0, 0, 0);
    // A culler would judge by the undistorted place of the model.
    renderers[layer]->GetCullers()->RemoveAllItems();
  }
  this->SetUpVideo();
  this->SetUpModel();
  this->BarsRenderer->AddObserver(vtkCommand::StartEvent, this, &vtkHandEyeOverlayScene::Synchronize);
}

vtkHandEyeOverlayScene::~vtkHandEyeOverlayScene()
{
  this->AttachTo(nullptr);
}

void vtkHandEyeOverlayScene::SetUpVideo()
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-1, -1, 0);
  plane->SetPoint1(1, -1, 0);
  plane->SetPoint2(-1, 1, 0);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(plane->GetOutputPort());
  this->VideoTexture->SetColorModeToDirectScalars();
  this->VideoTexture->EdgeClampOn();
  this->VideoActor->SetMapper(mapper);
  this->VideoActor->SetTexture(this->VideoTexture);
  this->VideoActor->GetProperty()->LightingOff();
  this->VideoRenderer->AddActor(this->VideoActor);

  // The plane fills the viewport exactly, whatever the viewport's aspect.
  vtkCamera* camera = this->VideoRenderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetPosition(0, 0, 1);
  camera->SetFocalPoint(0, 0, 0);
  camera->SetViewUp(0, 1, 0);
  camera->SetParallelScale(1);
  camera->SetClippingRange(0.5, 1.5);
  camera->SetExplicitAspectRatio(1);
  camera->UseExplicitAspectRatioOn();
}

void vtkHandEyeOverlayScene::SetUpModel()
{
  for (vtkHandEyeLensMapper* mapper : { this->DepthMapper.Get(), this->ModelMapper.Get() })
  {
    mapper->ScalarVisibilityOff();
  }
  this->DepthMapper->SetDepthOnly(true);
  this->DepthActor->SetMapper(this->DepthMapper);
  this->ModelActor->SetMapper(this->ModelMapper);
  // Translucent, yet drawn with the opaque ones: the depth pass before it leaves one surface to blend, so there is nothing to sort.
  this->ModelActor->ForceOpaqueOn();
  this->ModelRenderer->AddActor(this->DepthActor);
  this->ModelRenderer->AddActor(this->ModelActor);

  this->ModelRenderer->AutomaticLightCreationOff();
  addLight(this->ModelRenderer, -0.5, 0.7, 1, 1.0, 1, 0.98, 0.95);
  addLight(this->ModelRenderer, 0.9, -0.3, 0.6, 0.25, 0.85, 0.92, 1);

  // OpenCV's camera frame: x right, y down, z forward.
  vtkCamera* camera = this->ModelRenderer->GetActiveCamera();
  camera->SetPosition(0, 0, 0);
  camera->SetFocalPoint(0, 0, 1);
  camera->SetViewUp(0, -1, 0);
}

void vtkHandEyeOverlayScene::SetStateSource(std::function<const vtkHandEyeOverlayState&()> source)
{
  this->StateSource = std::move(source);
}

vtkRenderWindow* vtkHandEyeOverlayScene::GetRenderWindow()
{
  return this->Window;
}

void vtkHandEyeOverlayScene::AttachTo(vtkRenderWindow* window)
{
  if (this->Window.GetPointer() == window)
  {
    return;
  }
  for (vtkRenderer* renderer : { this->BarsRenderer.Get(), this->VideoRenderer.Get(), this->ModelRenderer.Get() })
  {
    if (this->Window)
    {
      this->Window->RemoveRenderer(renderer);
    }
    if (window)
    {
      window->AddRenderer(renderer);
    }
  }
  this->Window = window;
  if (window)
  {
    window->SetNumberOfLayers(std::max(window->GetNumberOfLayers(), LayerCount));
  }
}

std::array<int, 4> vtkHandEyeOverlayScene::Letterbox(const std::array<int, 2>& imageSize, const int windowSize[2])
{
  if (imageSize[0] < 1 || imageSize[1] < 1)
  {
    return { 0, 0, windowSize[0], windowSize[1] };
  }
  const double scale = std::min(double(windowSize[0]) / imageSize[0], double(windowSize[1]) / imageSize[1]);
  const int width = std::clamp(vtkMath::Round(imageSize[0] * scale), 1, std::max(1, windowSize[0]));
  const int height = std::clamp(vtkMath::Round(imageSize[1] * scale), 1, std::max(1, windowSize[1]));
  return { (windowSize[0] - width) / 2, (windowSize[1] - height) / 2, width, height };
}

void vtkHandEyeOverlayScene::Synchronize()
{
  if (!this->StateSource || !this->Window)
  {
    return;
  }
  const vtkHandEyeOverlayState& state = this->StateSource();
  this->SynchronizeViewports(state);
  this->SynchronizeVideo(state);
  this->SynchronizeCamera(state);
  this->SynchronizeModel(state);
  this->SynchronizeAppearance(state);
}

void vtkHandEyeOverlayScene::SynchronizeViewports(const vtkHandEyeOverlayState& state)
{
  const int* windowSize = this->Window->GetActualSize();
  if (windowSize[0] < 1 || windowSize[1] < 1)
  {
    return;
  }
  this->PictureRectangle = Letterbox(state.ImageSize, windowSize);
  const auto& [x, y, width, height] = this->PictureRectangle;
  for (vtkRenderer* renderer : { this->VideoRenderer.Get(), this->ModelRenderer.Get() })
  {
    renderer->SetViewport(
      double(x) / windowSize[0], double(y) / windowSize[1], double(x + width) / windowSize[0], double(y + height) / windowSize[1]);
  }
}

void vtkHandEyeOverlayScene::SynchronizeVideo(const vtkHandEyeOverlayState& state)
{
  const bool visible = state.Video && state.ImageSize[0] > 0 && state.ImageSize[1] > 0 && !state.MaskMode;
  this->VideoActor->SetVisibility(visible);
  if (!visible)
  {
    return;
  }
  this->VideoTexture->SetInputData(state.Video);
  // Nearest neighbours where a pixel of the video is a whole number of pixels here: the video then stays as it is, to the last bit.
  const int width = this->PictureRectangle[2], height = this->PictureRectangle[3];
  const bool whole = width % state.ImageSize[0] == 0 && height % state.ImageSize[1] == 0;
  this->VideoTexture->SetInterpolate(!whole);
}

void vtkHandEyeOverlayScene::SynchronizeCamera(const vtkHandEyeOverlayState& state)
{
  if (!state.Camera)
  {
    return;
  }
  const handeye::CameraModel& lens = *state.Camera;
  const double width = lens.width(), height = lens.height();
  vtkCamera* camera = this->ModelRenderer->GetActiveCamera();
  camera->SetViewAngle(vtkMath::DegreesFromRadians(2 * std::atan(height / (2 * lens.fy()))));
  // fx is not fy: the aspect is that of the view, not that of the viewport.
  camera->SetExplicitAspectRatio((width / lens.fx()) / (height / lens.fy()));
  camera->UseExplicitAspectRatioOn();
  // Pixel centres are whole numbers: the picture spans [-0.5, width - 0.5], which is [-1, 1] in normalised device coordinates.
  const double shiftX = 2 * (lens.cx() + 0.5) / width - 1;
  const double shiftY = 1 - 2 * (lens.cy() + 0.5) / height;
  auto* shift = vtkTransform::SafeDownCast(camera->GetUserTransform());
  if (!shift || shift->GetMatrix()->GetElement(0, 3) != shiftX || shift->GetMatrix()->GetElement(1, 3) != shiftY)
  {
    vtkNew<vtkTransform> principalPoint;
    principalPoint->Translate(shiftX, shiftY, 0);
    camera->SetUserTransform(principalPoint);
  }
}

void vtkHandEyeOverlayScene::SynchronizeModel(const vtkHandEyeOverlayState& state)
{
  const bool visible = state.Camera && state.Mesh && state.ModelVisible && (state.Opacity > 0 || state.MaskMode);
  const bool translucent = state.Opacity < 1 && !state.MaskMode;
  this->ModelActor->SetVisibility(visible);
  this->DepthActor->SetVisibility(visible && translucent);
  if (!visible)
  {
    return;
  }
  for (vtkHandEyeLensMapper* mapper : { this->DepthMapper.Get(), this->ModelMapper.Get() })
  {
    mapper->SetInputData(state.Mesh);
    mapper->SetLensWarp(state.Warp);
  }
  for (vtkActor* actor : { this->DepthActor.Get(), this->ModelActor.Get() })
  {
    actor->SetUserMatrix(state.ModelToCamera);
  }
  const std::array<double, 2> range = depthRange(state.Mesh, state.ModelToCamera);
  const double farthest = std::max(1.01 * range[1], 2 * NearestMm);
  const double nearest = std::max({ 0.99 * range[0], NearestMm, DepthRatio * farthest });
  this->ModelRenderer->GetActiveCamera()->SetClippingRange(nearest, farthest);
}

void vtkHandEyeOverlayScene::SynchronizeAppearance(const vtkHandEyeOverlayState& state)
{
  vtkProperty* property = this->ModelActor->GetProperty();
  // Ambient light alone is the colour itself, to the last bit: a mask is white without any shading.
  property->SetAmbient(state.MaskMode ? 1 : 0.18);
  property->SetDiffuse(state.MaskMode ? 0 : 0.85);
  property->SetSpecular(state.MaskMode ? 0 : 0.25);
  property->SetSpecularPower(30);
  property->SetOpacity(state.MaskMode ? 1 : state.Opacity);
  if (state.MaskMode)
  {
    property->SetColor(1, 1, 1);
  }
  else
  {
    property->SetColor(state.Color[0], state.Color[1], state.Color[2]);
  }
  property->SetSpecularColor(1, 1, 1);
  // A faint model has faint outlines.
  this->ModelMapper->SetRimStrength(state.MaskMode ? 0 : ModelRimStrength * std::min(1.0, 2 * state.Opacity));
}
