// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOverlayPipeline.h"

#include "EigenVtk.h"
#include "OverlayMesh.h"
#include "VideoMesh.h"
#include "vtkHandEyeOverlayPipelineInternals.h"

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

constexpr int SuperSampling = 2;  // pictures are rendered this much larger and averaged

}  // namespace

vtkHandEyeOverlayPipeline::vtkHandEyeOverlayPipeline()
  : Internal(std::make_unique<Internals>())
{
  this->Internal->State.Opacity = 0.65;
  this->Internal->State.Color = { 0.97, 0.89, 0.71 };
  this->Internal->State.RawMesh = handeye::makeRawVideoMesh();
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
  os << indent << "ImageSize: " << state.ImageSize[0] << " x " << state.ImageSize[1] << "\n";
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
  handeye::copyFlipped(bgr, this->Internal->Frame);
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
    this->Internal->SetBaseMesh({});
    this->Modified();
  }
}

void vtkHandEyeOverlayPipeline::SetPreparedModel(const handeye::OverlayMesh& model)
{
  if (this->Internal->Model != model.mesh)
  {
    this->Internal->Model = model.mesh;
    this->Internal->SetBaseMesh(model);
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
  return handeye::chordErrorPx(state.Lens, this->Internal->MeshDistanceMm, this->Internal->LongestEdgeMm);
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

bool vtkHandEyeOverlayPipeline::ReadShown(cv::Mat& bgr)
{
  return handeye::readShown(this->Internal->WindowScene, this->Internal->State.ImageSize, this->Internal->Pixels, bgr);
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
