// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkHandEyeOverlayPipeline: how it looks, the stylus, and places in the picture.
#include "EigenVtk.h"
#include "vtkHandEyeOverlayPipelineInternals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>

void vtkHandEyeOverlayPipeline::SetLook(const handeye::OverlayLook& look)
{
  look.check();
  this->Internal->State.Look = look;
  this->Modified();
}

const handeye::OverlayLook& vtkHandEyeOverlayPipeline::GetLook()
{
  return this->Internal->State.Look;
}

bool vtkHandEyeOverlayPipeline::HandleKey(char key)
{
  const bool known = handeye::applyOverlayKey(key, this->Internal->State.Look, this->Internal->State.Opacity);
  if (known)
  {
    this->Modified();
  }
  return known;
}

void vtkHandEyeOverlayPipeline::SetFade(double fade)
{
  if (!std::isfinite(fade))
  {
    throw std::invalid_argument("the fade is not a finite number");
  }
  this->Internal->State.Fade = std::clamp(fade, 0.0, 1.0);
  this->Modified();
}

double vtkHandEyeOverlayPipeline::GetFade()
{
  return this->Internal->State.Fade;
}

void vtkHandEyeOverlayPipeline::SetNotice(const std::string& notice)
{
  this->Internal->State.Notice = notice;
  this->Modified();
}

std::string vtkHandEyeOverlayPipeline::GetNotice()
{
  return this->Internal->State.Notice;
}

void vtkHandEyeOverlayPipeline::SetCalibrationCovariance(const std::optional<Eigen::Matrix<double, 6, 6>>& covariance)
{
  if (covariance && !covariance->allFinite())
  {
    throw std::invalid_argument("the covariance of the calibration holds numbers that are not finite");
  }
  if (this->Internal->Covariance != covariance)
  {
    this->Internal->Covariance = covariance;
    this->Internal->ErrorIsNew = true;
    this->Modified();
  }
}

std::optional<double> vtkHandEyeOverlayPipeline::GetPredictedErrorPx()
{
  this->Internal->Update();
  const std::optional<Eigen::Matrix2d> covariance = this->Internal->ErrorCovariancePx();
  return covariance ? std::optional<double>(std::sqrt(std::max(0.0, covariance->trace()))) : std::nullopt;
}

void vtkHandEyeOverlayPipeline::SetStylusShape(const handeye::StylusShape& shape)
{
  shape.check();
  this->Internal->StylusShape = shape;
  this->Internal->State.StylusBody = nullptr;  // made anew when it is needed
  this->Modified();
}

void vtkHandEyeOverlayPipeline::SetStylusTipToCamera(vtkMatrix4x4* stylusTipToCamera)
{
  if (!stylusTipToCamera)
  {
    this->Internal->State.StylusTipToCamera = nullptr;
    this->Modified();
    return;
  }
  if (!handeye::toEigen(stylusTipToCamera).allFinite())
  {
    throw std::invalid_argument("stylusTipToCamera holds numbers that are not finite");
  }
  if (!this->Internal->State.StylusTipToCamera)
  {
    this->Internal->State.StylusTipToCamera = vtkSmartPointer<vtkMatrix4x4>::New();
  }
  this->Internal->State.StylusTipToCamera->DeepCopy(stylusTipToCamera);
  this->Modified();
}

void vtkHandEyeOverlayPipeline::ConnectScene(vtkHandEyeOverlayScene* scene)
{
  scene->SetStateSource([internal = this->Internal.get()]() -> const vtkHandEyeOverlayState& { return internal->Update(); });
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
  const vtkHandEyeOverlayState& state = this->Internal->State;
  if (!state.Look.undistorted || !state.Camera)
  {
    return true;
  }
  const Eigen::Array2d focal(state.Camera->fx(), state.Camera->fy()), principal(state.Camera->cx(), state.Camera->cy());
  const Eigen::Array2d plain = (Eigen::Array2d(point_Image[0], point_Image[1]) - principal) / focal;
  if (plain.matrix().norm() > state.Lens.limitRadius)
  {
    return false;
  }
  const Eigen::Array2d seen_Image = state.Camera->distort(plain.matrix()).array() * focal + principal;
  point_Image[0] = seen_Image.x();
  point_Image[1] = seen_Image.y();
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
  Eigen::Array2d shown(point_Image[0], point_Image[1]);
  const vtkHandEyeOverlayState& state = this->Internal->State;
  if (state.Look.undistorted && state.Camera)
  {
    const handeye::CameraModel::Unprojection seen = state.Camera->unproject(shown.matrix());
    if (!seen.isUsable())
    {
      return false;
    }
    const Eigen::Array2d focal(state.Camera->fx(), state.Camera->fy()), principal(state.Camera->cx(), state.Camera->cy());
    shown = seen.ray_Camera.hnormalized().array() * focal + principal;
  }
  point_Display[0] = x + (shown.x() + 0.5) / imageSize[0] * width - 0.5;
  point_Display[1] = y + height - (shown.y() + 0.5) / imageSize[1] * height - 0.5;
  return true;
}
