// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkHandEyeOverlayPipeline: from what was set to what is shown.
#include "EigenVtk.h"
#include "HandEyePrediction.h"
#include "LensWarp.h"
#include "OverlayMesh.h"
#include "VideoMesh.h"
#include "vtkHandEyeOverlayPipelineInternals.h"

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>

namespace
{

constexpr double EdgeTolerancePx = 0.05;
constexpr double DistanceHysteresis = 0.3;  // in doublings of the distance

std::string sizeText(int width, int height)
{
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

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
  if (this->State.Look.undistorted && this->State.Camera && !this->State.UndistortedMesh)
  {
    this->State.UndistortedMesh = handeye::makeUndistortedVideoMesh(*this->State.Camera, this->State.Lens);
  }
  this->UpdateMesh();
  this->UpdateStylus();
  this->UpdateError();
  return this->State;
}

void vtkHandEyeOverlayPipeline::Internals::UpdateLens()
{
  this->LensIsNew = false;
  this->ErrorIsNew = true;
  this->State.Camera.reset();
  this->State.UndistortedMesh = nullptr;
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
    this->State.Lens = handeye::makeLensWarp(*this->State.Camera);
  }
}

double vtkHandEyeOverlayPipeline::Internals::PreparedDistanceMm() const
{
  // Depths of a box are those of its corners.
  double bounds[6];
  this->Model->GetBounds(bounds);
  const Eigen::Vector4d row = handeye::toEigen(this->State.ModelToCamera).row(2);
  double nearest = row[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    nearest += std::min(row[axis] * bounds[2 * axis], row[axis] * bounds[2 * axis + 1]);
  }
  const double doublings = std::log2(std::max(1.0, nearest / this->NearestDistanceMm));
  const double before = std::log2(std::max(1.0, this->MeshDistanceMm / this->NearestDistanceMm));
  // A model that stays near a threshold does not change its mesh to and fro.
  const bool stays = doublings >= before && doublings < before + 1 + DistanceHysteresis;
  return stays ? std::max(this->MeshDistanceMm, this->NearestDistanceMm)
               : this->NearestDistanceMm * std::exp2(std::floor(doublings));
}

vtkMTimeType vtkHandEyeOverlayPipeline::Internals::ModelTime() const
{
  return std::max(this->Model->GetMTime(), this->Model->GetPoints() ? this->Model->GetPoints()->GetMTime() : 0);
}

void vtkHandEyeOverlayPipeline::Internals::SetBaseMesh(const handeye::OverlayMesh& mesh)
{
  this->BaseMesh = mesh;
  this->Meshes.clear();
  this->MeshDistanceMm = 0;
  this->LongestEdgeMm = 0;
  this->State.Mesh = nullptr;
  this->State.MeshIsClosed = mesh.isClosed;
  this->MeshTime = this->Model ? this->ModelTime() : 0;
}

void vtkHandEyeOverlayPipeline::Internals::UpdateMesh()
{
  if (!this->Model || !this->State.Camera)
  {
    return;
  }
  if (!this->BaseMesh.mesh || this->ModelTime() != this->MeshTime)
  {
    this->SetBaseMesh(handeye::prepareOverlayMesh(this->Model));
  }
  this->MeshDistanceMm = this->PreparedDistanceMm();
  const double limitMm = handeye::longestEdgeMm(this->State.Lens, this->MeshDistanceMm, EdgeTolerancePx);
  if (this->BaseMesh.longestEdgeMm <= limitMm)
  {
    this->State.Mesh = this->BaseMesh.mesh;
    this->LongestEdgeMm = this->BaseMesh.longestEdgeMm;
    return;
  }
  const auto [place, isNew] = this->Meshes.try_emplace(limitMm);
  if (isNew)
  {
    place->second = handeye::dividedOverlayMesh(this->BaseMesh, limitMm);
  }
  this->State.Mesh = place->second.mesh;
  this->LongestEdgeMm = place->second.longestEdgeMm;
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
  handeye::readPixels(this->ImageWindow, this->Pixels, { 0, 0, width, height }, bgr);
}

void vtkHandEyeOverlayPipeline::Internals::UpdateStylus()
{
  if (this->State.StylusTipToCamera && !this->State.StylusBody)
  {
    this->State.StylusBody = handeye::makeStylusBody(this->StylusShape);
    this->State.StylusRay = handeye::makeStylusRay(this->StylusShape);
    this->State.StylusTip = handeye::makeStylusTip(this->StylusShape);
  }
}

handeye::CameraModel vtkHandEyeOverlayPipeline::Internals::ShownCamera() const
{
  const handeye::CameraModel& camera = *this->State.Camera;
  const bool straight = this->State.Look.undistorted;
  return straight ? handeye::CameraModel(camera.width(), camera.height(), camera.cameraMatrix(), {}) : camera;
}

std::optional<Eigen::Matrix2d> vtkHandEyeOverlayPipeline::Internals::ErrorCovariancePx() const
{
  if (!this->Covariance || !this->State.Camera || !this->State.Mesh || this->State.Mesh->GetNumberOfPoints() == 0)
  {
    return std::nullopt;
  }
  double middle[3];
  this->State.Mesh->GetCenter(middle);
  const Eigen::Vector4d middle_Model(middle[0], middle[1], middle[2], 1);
  const Eigen::Vector3d middle_Camera = (handeye::toEigen(this->State.ModelToCamera) * middle_Model).head<3>();
  const auto jacobian = handeye::pixelJacobian({ this->ShownCamera() }, middle_Camera);
  if (!jacobian || !this->State.Camera->project(middle_Camera).isUsable())
  {
    return std::nullopt;
  }
  return *jacobian * *this->Covariance * jacobian->transpose();
}

void vtkHandEyeOverlayPipeline::Internals::UpdateError()
{
  this->State.ErrorAxes_Px.reset();
  if (!this->Covariance || !this->State.Camera)
  {
    this->State.ErrorField.reset();
    return;
  }
  if (!this->State.Look.errorHalo)
  {
    return;  // made when it is looked at
  }
  const bool straight = this->State.Look.undistorted;
  if (!this->State.ErrorField || this->ErrorIsNew || this->ErrorIsStraight != straight)
  {
    this->State.ErrorField = std::make_shared<handeye::HandEyeErrorField>(this->ShownCamera(), *this->Covariance);
    this->ErrorIsNew = false;
    this->ErrorIsStraight = straight;
  }
  if (const std::optional<Eigen::Matrix2d> covariance = this->ErrorCovariancePx())
  {
    const Eigen::Vector2d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(*covariance).eigenvalues();
    const auto length = [](double variance) { return handeye::ErrorQuantile95 * std::sqrt(std::max(0.0, variance)); };
    this->State.ErrorAxes_Px = { length(variances[1]), length(variances[0]) };
  }
}

void handeye::copyFlipped(const cv::Mat& bgr, vtkImageData* image)
{
  if (bgr.type() != CV_8UC3)
  {
    handeye::toVtk(bgr, image);
    return;
  }
  const int* size = image->GetDimensions();
  if (size[0] != bgr.cols || size[1] != bgr.rows || image->GetScalarType() != VTK_UNSIGNED_CHAR ||
    image->GetNumberOfScalarComponents() != 4 || !image->GetScalarPointer())
  {
    image->SetExtent(0, bgr.cols - 1, 0, bgr.rows - 1, 0, 0);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  }
  cv::Mat target(bgr.rows, bgr.cols, CV_8UC4, image->GetScalarPointer());
  for (int row = 0; row < bgr.rows; ++row)
  {
    cv::Mat flipped = target.row(bgr.rows - 1 - row);
    cv::cvtColor(bgr.row(row), flipped, cv::COLOR_BGR2RGBA);
  }
  image->GetPointData()->GetScalars()->Modified();
  image->Modified();
}

void handeye::readPixels(vtkRenderWindow* window, vtkUnsignedCharArray* pixels, const std::array<int, 4>& rectangle, cv::Mat& bgr)
{
  const auto& [x, y, width, height] = rectangle;
  window->GetPixelData(x, y, x + width - 1, y + height - 1, 0, pixels);
  const cv::Mat rgb(height, width, CV_8UC3, pixels->GetPointer(0));
  cv::Mat upright;
  cv::flip(rgb, upright, 0);
  cv::cvtColor(upright, bgr, cv::COLOR_RGB2BGR);
}

bool handeye::readShown(vtkHandEyeOverlayScene* scene, const std::array<int, 2>& size, vtkUnsignedCharArray* pixels, cv::Mat& bgr)
{
  const std::array<int, 4>& rectangle = scene->GetPictureRectangle();
  if (!scene->GetRenderWindow() || rectangle[2] < 1 || rectangle[3] < 1)
  {
    return false;
  }
  cv::Mat shown;
  readPixels(scene->GetRenderWindow(), pixels, rectangle, shown);
  const bool larger = shown.cols > size[0] || shown.rows > size[1];
  if (size[0] < 1 || size[1] < 1 || (shown.cols == size[0] && shown.rows == size[1]))
  {
    bgr = shown;
    return true;
  }
  bgr = cv::Mat();  // whoever was given the last picture keeps it
  cv::resize(shown, bgr, cv::Size(size[0], size[1]), 0, 0, larger ? cv::INTER_AREA : cv::INTER_LINEAR);
  return true;
}
