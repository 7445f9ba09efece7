// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOverlayPipeline.h"

#include "EigenVtk.h"
#include "LensWarp.h"
#include "OverlayMesh.h"
#include "vtkHandEyeOverlayScene.h"

#include <opencv2/imgproc.hpp>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <stdexcept>

vtkStandardNewMacro(vtkHandEyeOverlayPipeline);

namespace
{

constexpr double EdgeTolerancePx = 0.05;
constexpr int SuperSampling = 2;  // pictures are rendered this much larger and averaged

std::string sizeText(int width, int height)
{
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

class vtkHandEyeOverlayPipeline::Internals
{
public:
  vtkHandEyeOverlayState State;
  std::optional<handeye::CameraModel> Camera;  ///< as set
  vtkSmartPointer<vtkPolyData> Model;          ///< as set
  vtkNew<vtkImageData> Frame;                  ///< for SetVideoFrame()
  double NearestDistanceMm = 50;
  double LongestEdgeMm = 0;
  std::string Problem;

  vtkNew<vtkHandEyeOverlayScene> WindowScene;
  vtkNew<vtkHandEyeOverlayScene> ImageScene;
  vtkSmartPointer<vtkRenderWindow> ImageWindow;
  vtkNew<vtkUnsignedCharArray> Pixels;

  /// Brings the state up to date with what was set since.
  const vtkHandEyeOverlayState& Update();
  void Render(int width, int height, cv::Mat& bgr);

  bool LensIsNew = true;

private:
  void UpdateLens();
  void UpdateMesh();

  vtkMTimeType MeshTime = 0;
  double MeshEdgeLimitMm = 0;
};

const vtkHandEyeOverlayState& vtkHandEyeOverlayPipeline::Internals::Update()
{
  std::array<int, 2> size{ 0, 0 };
  if (this->State.Video)
  {
    size = { this->State.Video->GetDimensions()[0], this->State.Video->GetDimensions()[1] };
  }
  else if (this->Camera)
  {
    size = { this->Camera->width(), this->Camera->height() };
  }
  this->LensIsNew = this->LensIsNew || size != this->State.ImageSize;
  this->State.ImageSize = size;
  if (this->LensIsNew)
  {
    this->UpdateLens();
  }
  this->UpdateMesh();
  return this->State;
}

void vtkHandEyeOverlayPipeline::Internals::UpdateLens()
{
  this->LensIsNew = false;
  this->State.Camera.reset();
  this->Problem.clear();
  const auto& [width, height] = this->State.ImageSize;
  if (!this->Camera)
  {
    this->Problem = "no camera is set, so it is not known where the model belongs on the video";
  }
  else if (width == 0)
  {
    this->Problem = "the camera's image size is not known until there is a video";
  }
  else if (this->Camera->hasImageSize() && (this->Camera->width() != width || this->Camera->height() != height))
  {
    this->Problem = "the video is " + sizeText(width, height) + " px, but the camera was calibrated for " +
      sizeText(this->Camera->width(), this->Camera->height()) + " px";
  }
  else
  {
    this->State.Camera = this->Camera->withImageSize(width, height);
    this->State.Warp = handeye::makeLensWarp(*this->State.Camera);
  }
}

void vtkHandEyeOverlayPipeline::Internals::UpdateMesh()
{
  if (!this->Model || !this->State.Camera)
  {
    return;
  }
  const double limitMm = handeye::longestEdgeMm(this->State.Warp, this->NearestDistanceMm, EdgeTolerancePx);
  const vtkMTimeType modelTime =
    std::max(this->Model->GetMTime(), this->Model->GetPoints() ? this->Model->GetPoints()->GetMTime() : 0);
  if (this->State.Mesh && modelTime == this->MeshTime && limitMm == this->MeshEdgeLimitMm)
  {
    return;
  }
  const handeye::OverlayMesh prepared = handeye::prepareOverlayMesh(this->Model, limitMm);
  this->State.Mesh = prepared.mesh;
  this->LongestEdgeMm = prepared.longestEdgeMm;
  this->MeshTime = modelTime;
  this->MeshEdgeLimitMm = limitMm;
}

void vtkHandEyeOverlayPipeline::Internals::Render(int width, int height, cv::Mat& bgr)
{
  if (!this->ImageWindow)
  {
    this->ImageWindow = vtkSmartPointer<vtkRenderWindow>::New();
    this->ImageWindow->SetShowWindow(false);
    this->ImageWindow->SetOffScreenRendering(1);
    this->ImageWindow->SetMultiSamples(0);
    this->ImageScene->AttachTo(this->ImageWindow);
  }
  this->ImageWindow->SetSize(width, height);
  this->ImageWindow->Render();
  this->ImageWindow->GetPixelData(0, 0, width - 1, height - 1, 0, this->Pixels);
  const cv::Mat rgb(height, width, CV_8UC3, this->Pixels->GetPointer(0));
  cv::Mat upright;
  cv::flip(rgb, upright, 0);
  cv::cvtColor(upright, bgr, cv::COLOR_RGB2BGR);
}

vtkHandEyeOverlayPipeline::vtkHandEyeOverlayPipeline()
  : Internal(std::make_unique<Internals>())
{
  this->Internal->State.Opacity = 0.65;
  this->Internal->State.Color = { 0.97, 0.89, 0.71 };
  const auto source = [internal = this->Internal.get()]() -> const vtkHandEyeOverlayState& { return internal->Update(); };
  this->Internal->WindowScene->SetStateSource(source);
  this->Internal->ImageScene->SetStateSource(source);
}

vtkHandEyeOverlayPipeline::~vtkHandEyeOverlayPipeline()
{
  // The scenes outlive the state only as long as their windows keep their renderers.
  this->Internal->WindowScene->AttachTo(nullptr);
  this->Internal->ImageScene->AttachTo(nullptr);
}

void vtkHandEyeOverlayPipeline::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const vtkHandEyeOverlayState& state = this->Internal->State;
  os << indent << "ImageSize: " << sizeText(state.ImageSize[0], state.ImageSize[1]) << "\n";
  os << indent << "ModelVisible: " << state.ModelVisible << "\n";
  os << indent << "ModelOpacity: " << state.Opacity << "\n";
  os << indent << "MaskMode: " << state.MaskMode << "\n";
  os << indent << "Problem: " << this->Internal->Problem << "\n";
}

void vtkHandEyeOverlayPipeline::SetCameraModel(const handeye::CameraModel& camera)
{
  this->Internal->Camera = camera;
  this->Internal->LensIsNew = true;
  this->Modified();
}

void vtkHandEyeOverlayPipeline::SetVideoFrame(const cv::Mat& bgr)
{
  if (bgr.empty())
  {
    this->SetVideoImage(nullptr);
    return;
  }
  handeye::toVtk(bgr, this->Internal->Frame);
  this->SetVideoImage(this->Internal->Frame);
}

void vtkHandEyeOverlayPipeline::SetVideoImage(vtkImageData* image)
{
  this->Internal->State.Video = image;
  this->Modified();
}

void vtkHandEyeOverlayPipeline::SetModel(vtkPolyData* model)
{
  if (this->Internal->Model != model)
  {
    this->Internal->Model = model;
    this->Internal->State.Mesh = nullptr;
    this->Internal->LongestEdgeMm = 0;
    this->Modified();
  }
}

vtkPolyData* vtkHandEyeOverlayPipeline::GetModel()
{
  return this->Internal->Model;
}

void vtkHandEyeOverlayPipeline::SetModelToCamera(vtkMatrix4x4* modelToCamera)
{
  if (!modelToCamera)
  {
    throw std::invalid_argument("no modelToCamera given");
  }
  if (!handeye::toEigen(modelToCamera).allFinite())
  {
    throw std::invalid_argument("modelToCamera holds numbers that are not finite");
  }
  this->Internal->State.ModelToCamera->DeepCopy(modelToCamera);
  this->Modified();
}

void vtkHandEyeOverlayPipeline::SetModelVisible(bool visible)
{
  this->Internal->State.ModelVisible = visible;
  this->Modified();
}

bool vtkHandEyeOverlayPipeline::GetModelVisible()
{
  return this->Internal->State.ModelVisible;
}

void vtkHandEyeOverlayPipeline::SetModelOpacity(double opacity)
{
  this->Internal->State.Opacity = std::clamp(opacity, 0.0, 1.0);
  this->Modified();
}

double vtkHandEyeOverlayPipeline::GetModelOpacity()
{
  return this->Internal->State.Opacity;
}

void vtkHandEyeOverlayPipeline::SetModelColor(double red, double green, double blue)
{
  this->Internal->State.Color = { red, green, blue };
  this->Modified();
}

void vtkHandEyeOverlayPipeline::SetMaskMode(bool mask)
{
  this->Internal->State.MaskMode = mask;
  this->Modified();
}

bool vtkHandEyeOverlayPipeline::GetMaskMode()
{
  return this->Internal->State.MaskMode;
}

void vtkHandEyeOverlayPipeline::SetNearestDistanceMm(double distance)
{
  if (!(distance > 0))
  {
    throw std::invalid_argument("the nearest distance must be positive");
  }
  this->Internal->NearestDistanceMm = distance;
  this->Modified();
}

double vtkHandEyeOverlayPipeline::GetNearestDistanceMm()
{
  return this->Internal->NearestDistanceMm;
}

double vtkHandEyeOverlayPipeline::GetEdgeErrorPx()
{
  const vtkHandEyeOverlayState& state = this->Internal->Update();
  if (!state.Camera || !state.Mesh)
  {
    return 0;
  }
  return handeye::chordErrorPx(state.Warp, this->Internal->NearestDistanceMm, this->Internal->LongestEdgeMm);
}

std::string vtkHandEyeOverlayPipeline::GetProblem()
{
  const vtkHandEyeOverlayState& state = this->Internal->Update();
  return this->Internal->Model && state.ModelVisible ? this->Internal->Problem : std::string();
}

void vtkHandEyeOverlayPipeline::AttachTo(vtkRenderWindow* window)
{
  this->Internal->WindowScene->AttachTo(window);
  this->Modified();
}

vtkRenderer* vtkHandEyeOverlayPipeline::GetModelRenderer()
{
  return this->Internal->WindowScene->GetModelRenderer();
}

bool vtkHandEyeOverlayPipeline::DisplayToImage(const double point_Display[2], double point_Image[2])
{
  const auto& [x, y, width, height] = this->Internal->WindowScene->GetPictureRectangle();
  const auto& imageSize = this->Internal->State.ImageSize;
  if (width < 1 || height < 1 || imageSize[0] < 1)
  {
    return false;
  }
  point_Image[0] = (point_Display[0] + 0.5 - x) / width * imageSize[0] - 0.5;
  point_Image[1] = (y + height - point_Display[1] - 0.5) / height * imageSize[1] - 0.5;
  return true;
}

bool vtkHandEyeOverlayPipeline::ImageToDisplay(const double point_Image[2], double point_Display[2])
{
  const auto& [x, y, width, height] = this->Internal->WindowScene->GetPictureRectangle();
  const auto& imageSize = this->Internal->State.ImageSize;
  if (width < 1 || height < 1 || imageSize[0] < 1)
  {
    return false;
  }
  point_Display[0] = x + (point_Image[0] + 0.5) / imageSize[0] * width - 0.5;
  point_Display[1] = y + height - (point_Image[1] + 0.5) / imageSize[1] * height - 0.5;
  return true;
}

void vtkHandEyeOverlayPipeline::RenderToImage(cv::Mat& bgr)
{
  const std::string problem = this->GetProblem();
  if (!problem.empty())
  {
    throw std::runtime_error(problem);
  }
  const auto& [width, height] = this->Internal->State.ImageSize;
  if (width < 1 || height < 1)
  {
    throw std::runtime_error("there is neither a video nor a camera, so the picture's size is not known");
  }
  if (this->Internal->State.MaskMode)
  {
    this->Internal->Render(width, height, bgr);
    return;
  }
  cv::Mat large;
  this->Internal->Render(SuperSampling * width, SuperSampling * height, large);
  cv::resize(large, bgr, cv::Size(width, height), 0, 0, cv::INTER_AREA);
}
