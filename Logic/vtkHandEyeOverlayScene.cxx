// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOverlayScene.h"

#include "vtkHandEyeLensMapper.h"
#include "vtkHandEyeOutlinePass.h"
#include "vtkHandEyeVideoMapper.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkCullerCollection.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkMath.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTexture.h>
#include <vtkTransform.h>

#include <algorithm>
#include <cmath>
#include <utility>

vtkStandardNewMacro(vtkHandEyeOverlayScene);

namespace
{

constexpr int LayerCount = 3;
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
  // Only the model looks at depths.
  this->BarsRenderer->PreserveDepthBufferOn();
  this->VideoRenderer->PreserveDepthBufferOn();
  this->SetUpVideo();
  this->SetUpModel();
  this->SetUpTexts();
  this->BarsRenderer->AddObserver(vtkCommand::StartEvent, this, &vtkHandEyeOverlayScene::Synchronize);
}

vtkHandEyeOverlayScene::~vtkHandEyeOverlayScene()
{
  this->AttachTo(nullptr);
}

void vtkHandEyeOverlayScene::SetUpVideo()
{
  this->VideoTexture->SetColorModeToDirectScalars();
  this->VideoTexture->EdgeClampOn();
  this->VideoActor->SetMapper(this->VideoMapper);
  this->VideoActor->SetTexture(this->VideoTexture);
  this->VideoActor->GetProperty()->LightingOff();
  this->VideoActor->ForceOpaqueOn();
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
  const std::pair<vtkHandEyeLensMapper*, vtkActor*> drawn[] = { { this->DepthMapper, this->DepthActor },
    { this->BodyMapper, this->BodyActor }, { this->ModelMapper, this->ModelActor }, { this->RayMapper, this->RayActor },
    { this->TipMapper, this->TipActor } };
  for (const auto& [mapper, actor] : drawn)
  {
    mapper->ScalarVisibilityOff();
    actor->SetMapper(mapper);
    actor->SetVisibility(false);
    // Translucent, yet drawn with the opaque ones: the mapper mixes the video in, so there is nothing to sort.
    actor->ForceOpaqueOn();
    this->ModelRenderer->AddActor(actor);
  }
  this->DepthMapper->SetDepthOnly(true);
  this->TipMapper->SetAlwaysInFront(true);

  this->ModelRenderer->AutomaticLightCreationOff();
  addLight(this->ModelRenderer, -0.5, 0.7, 1, 1.0, 1, 0.98, 0.95);
  addLight(this->ModelRenderer, 0.9, -0.3, 0.6, 0.25, 0.85, 0.92, 1);

  // OpenCV's camera frame: x right, y down, z forward.
  vtkCamera* camera = this->ModelRenderer->GetActiveCamera();
  camera->SetPosition(0, 0, 0);
  camera->SetFocalPoint(0, 0, 1);
  camera->SetViewUp(0, -1, 0);
}

void vtkHandEyeOverlayScene::SetUpTexts()
{
  for (vtkTextActor* actor : { this->NoticeActor.Get(), this->LegendActor.Get() })
  {
    actor->SetVisibility(false);
    actor->GetTextProperty()->SetColor(1, 1, 1);
    actor->GetTextProperty()->SetBackgroundColor(0, 0, 0);
    actor->GetTextProperty()->SetBackgroundOpacity(0.6);
    actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    this->ModelRenderer->AddActor2D(actor);
  }
  this->NoticeActor->SetPosition(0.02, 0.03);
  this->NoticeActor->GetTextProperty()->SetColor(1, 0.85, 0.2);
  this->LegendActor->SetPosition(0.02, 0.97);
  this->LegendActor->GetTextProperty()->SetVerticalJustificationToTop();
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

std::array<int, 4> vtkHandEyeOverlayScene::Letterbox(const std::array<double, 2>& imageSize, const std::array<int, 4>& area)
{
  if (!(imageSize[0] > 0 && imageSize[1] > 0))
  {
    return area;
  }
  const double scale = std::min(area[2] / imageSize[0], area[3] / imageSize[1]);
  const int width = std::clamp(vtkMath::Round(imageSize[0] * scale), 1, std::max(1, area[2]));
  const int height = std::clamp(vtkMath::Round(imageSize[1] * scale), 1, std::max(1, area[3]));
  return { area[0] + (area[2] - width) / 2, area[1] + (area[3] - height) / 2, width, height };
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
  this->SynchronizeProperty(state);
  this->SynchronizeAppearance(state);
  this->SynchronizeStylus(state);
  this->SynchronizeOutline(state);
  this->SynchronizeTexts(state);
}

void vtkHandEyeOverlayScene::SynchronizeViewports(const vtkHandEyeOverlayState& state)
{
  const int* windowSize = this->Window->GetActualSize();
  if (windowSize[0] < 1 || windowSize[1] < 1)
  {
    return;
  }
  const int left = vtkMath::Round(this->Area[0] * windowSize[0]), bottom = vtkMath::Round(this->Area[1] * windowSize[1]);
  const int right = vtkMath::Round((this->Area[0] + this->Area[2]) * windowSize[0]);
  const int top = vtkMath::Round((this->Area[1] + this->Area[3]) * windowSize[1]);
  const std::array<int, 4> area{ left, bottom, right - left, top - bottom };
  this->PictureRectangle = Letterbox({ state.ImageSize[0] * this->Squeeze[0], state.ImageSize[1] * this->Squeeze[1] }, area);
  const auto place = [&windowSize](vtkRenderer* renderer, const std::array<int, 4>& rectangle)
  {
    const auto& [x, y, width, height] = rectangle;
    renderer->SetViewport(
      double(x) / windowSize[0], double(y) / windowSize[1], double(x + width) / windowSize[0], double(y + height) / windowSize[1]);
  };
  place(this->BarsRenderer, area);
  place(this->VideoRenderer, this->PictureRectangle);
  place(this->ModelRenderer, this->PictureRectangle);
}

void vtkHandEyeOverlayScene::SynchronizeVideo(const vtkHandEyeOverlayState& state)
{
  const bool undistorted = state.Look.undistorted && state.UndistortedMesh;
  const bool visible = state.Video && state.ImageSize[0] > 0 && state.ImageSize[1] > 0 && !state.MaskMode;
  this->VideoActor->SetVisibility(visible);
  if (!visible)
  {
    return;
  }
  this->VideoMapper->SetInputData(undistorted ? state.UndistortedMesh : state.RawMesh);
  this->VideoMapper->SetEye(this->Channel());
  this->VideoTexture->SetInputData(state.Video);
  // Nearest neighbours where a pixel of the video is a whole number of pixels here: the video then stays as it is, to the last bit.
  const int width = this->PictureRectangle[2], height = this->PictureRectangle[3];
  const bool whole = width % state.ImageSize[0] == 0 && height % state.ImageSize[1] == 0;
  this->VideoTexture->SetInterpolate(undistorted || !whole);
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

handeye::EyeChannel vtkHandEyeOverlayScene::Channel() const
{
  handeye::EyeChannel channel;
  const int height = this->Window ? this->Window->GetActualSize()[1] : 0;
  switch (this->EyeMode)
  {
    case Eye::Both:
      break;
    case Eye::LeftRows:  // the uppermost row, the third, ...
      channel.alternateRows = true;
      channel.rowOffset = (height + 1) % 2;
      break;
    case Eye::RightRows:
      channel.alternateRows = true;
      channel.rowOffset = height % 2;
      break;
    case Eye::RedOfLeft:
      channel.colors = { true, false, false };
      channel.luma = true;
      break;
    case Eye::CyanOfRight:
      channel.colors = { false, true, true };
      break;
  }
  return channel;
}
