// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkHandEyeOverlayScene: what is drawn over the video.
#include "vtkHandEyeLensMapper.h"
#include "vtkHandEyeOutlinePass.h"
#include "vtkHandEyeOverlayScene.h"

#include <Eigen/Dense>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTexture.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{

constexpr double NearestMm = 1;      // the near plane: nothing is looked at from closer than this
constexpr double DepthRatio = 1e-4;  // least near/far, for a depth buffer of 24 bits
constexpr double ModelRimStrength = 0.85;
constexpr double DepthStepShare = 0.03;  // of the model's diagonal: a step that the outline shows

Eigen::Matrix4d matrixOf(vtkMatrix4x4* matrix)
{
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix->GetData());
}

Eigen::Matrix<double, 3, 8> cornersInCamera(vtkPolyData* mesh, vtkMatrix4x4* modelToCamera)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  Eigen::Matrix<double, 4, 8> corners_Model;
  for (int corner = 0; corner < 8; ++corner)
  {
    corners_Model.col(corner) << bounds[corner & 1], bounds[2 + ((corner >> 1) & 1)], bounds[4 + ((corner >> 2) & 1)], 1;
  }
  return (matrixOf(modelToCamera) * corners_Model).topRows<3>();
}

/// Smallest and largest Z in the Camera frame, of the mesh's bounding box or of every point.
std::array<double, 2> depthRange(vtkPolyData* mesh, vtkMatrix4x4* modelToCamera, bool exact)
{
  if (!exact || mesh->GetNumberOfPoints() == 0)
  {
    const Eigen::Matrix<double, 3, 8> corners = cornersInCamera(mesh, modelToCamera);
    return { corners.row(2).minCoeff(), corners.row(2).maxCoeff() };
  }
  const Eigen::Vector4d row = matrixOf(modelToCamera).row(2);
  std::array<double, 2> range{ VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX };
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double point[3];
    mesh->GetPoint(i, point);
    const double z = row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
    range[0] = std::min(range[0], z);
    range[1] = std::max(range[1], z);
  }
  return range;
}

/// Whether a mesh may reach to where the lens model does not.
bool reachesLimit(vtkPolyData* mesh, vtkMatrix4x4* meshToCamera, double limitRadius)
{
  const Eigen::Matrix<double, 3, 8> corners = cornersInCamera(mesh, meshToCamera);
  // A cone is convex: if it holds the corners of a box, it holds the box.
  return (corners.row(2).array() < NearestMm).any() ||
    (corners.topRows<2>().colwise().norm().array() > 0.999 * limitRadius * corners.row(2).array()).any();
}

/// Whether the camera is outside of a mesh' bounding box, by more than the near plane, and the mesh is not mirrored.
bool isSeenFromOutside(vtkPolyData* mesh, vtkMatrix4x4* meshToCamera)
{
  const Eigen::Matrix4d matrix = matrixOf(meshToCamera);
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  if (!(linear.determinant() > 0))
  {
    return false;
  }
  const Eigen::Vector3d camera_Mesh = -linear.inverse() * matrix.topRightCorner<3, 1>();
  const double margin = 2 * NearestMm / std::cbrt(linear.determinant());
  double bounds[6];
  mesh->GetBounds(bounds);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (camera_Mesh[axis] < bounds[2 * axis] - margin || camera_Mesh[axis] > bounds[2 * axis + 1] + margin)
    {
      return true;
    }
  }
  return false;
}

std::string text(const char* pattern, double a, double b = 0)
{
  char line[128];
  std::snprintf(line, sizeof(line), pattern, a, b);
  return line;
}

}  // namespace

bool vtkHandEyeOverlayScene::NeedsOutlinePass(const vtkHandEyeOverlayState& state) const
{
  const bool halo = state.Look.errorHalo && state.ErrorField;
  return (state.Look.outline || halo) && this->IsModelSeen(state) && !state.MaskMode;
}

bool vtkHandEyeOverlayScene::IsModelSeen(const vtkHandEyeOverlayState& state) const
{
  if (!state.Camera || !state.Mesh || !state.ModelVisible)
  {
    return false;
  }
  const bool surface = (state.Look.surface || state.Look.wireframe) && state.Opacity > 0;
  const bool halo = state.Look.errorHalo && state.ErrorField;
  return state.MaskMode || (state.Fade > 0 && (surface || state.Look.outline || halo));
}

void vtkHandEyeOverlayScene::SynchronizeModel(const vtkHandEyeOverlayState& state)
{
  const bool visible = this->IsModelSeen(state);
  const bool wireframe = state.Look.wireframe && !state.MaskMode;
  this->ModelActor->SetVisibility(visible);
  this->DepthActor->SetVisibility(visible && wireframe);
  if (!visible)
  {
    return;
  }
  const handeye::LensWarp warp = state.Look.undistorted ? handeye::plainWarp(state.Lens) : state.Lens;
  for (vtkHandEyeLensMapper* mapper : { this->DepthMapper.Get(), this->ModelMapper.Get() })
  {
    mapper->SetInputData(state.Mesh);
    mapper->SetLensWarp(warp);
  }
  for (vtkActor* actor : { this->DepthActor.Get(), this->ModelActor.Get() })
  {
    actor->SetUserMatrix(state.ModelToCamera);
  }
  const bool exact = state.Look.clipping || state.Look.depthColors;
  this->ModelDepthRangeMm = depthRange(state.Mesh, state.ModelToCamera, exact);
}

void vtkHandEyeOverlayScene::SynchronizeProperty(const vtkHandEyeOverlayState& state)
{
  vtkProperty* property = this->ModelActor->GetProperty();
  // Ambient light alone is the colour itself, to the last bit: a mask is white without any shading.
  property->SetAmbient(state.MaskMode ? 1 : 0.18);
  property->SetDiffuse(state.MaskMode ? 0 : 0.85);
  property->SetSpecular(state.MaskMode ? 0 : 0.25);
  property->SetSpecularPower(30);
  property->SetSpecularColor(1, 1, 1);
  if (state.MaskMode)
  {
    property->SetColor(1, 1, 1);
  }
  else
  {
    property->SetColor(state.Color[0], state.Color[1], state.Color[2]);
  }
  const bool wireframe = state.Look.wireframe && !state.MaskMode;
  property->SetRepresentation(wireframe ? VTK_WIREFRAME : VTK_SURFACE);
  // Half of a closed mesh cannot be seen: it is not drawn. Where something is cut off, or the camera is inside, it can.
  const bool whole = state.MeshIsClosed && state.Mesh && !wireframe && !state.Look.clipping;
  property->SetBackfaceCulling(whole && isSeenFromOutside(state.Mesh, state.ModelToCamera) &&
    !reachesLimit(state.Mesh, state.ModelToCamera, state.Lens.limitRadius));
}

handeye::LensAppearance vtkHandEyeOverlayScene::Appearance(const vtkHandEyeOverlayState& state) const
{
  const bool textured = this->NeedsOutlinePass(state);
  const auto& [x, y, width, height] = this->PictureRectangle;
  handeye::LensAppearance appearance;
  appearance.features.compose = true;
  appearance.picture = { textured ? 0.0 : x, textured ? 0.0 : y, double(std::max(1, width)), double(std::max(1, height)) };
  // The pass that draws into the window divides the eyes.
  appearance.eye = textured ? handeye::EyeChannel() : this->Channel();
  appearance.videoSize = { std::max(1, state.ImageSize[0]), std::max(1, state.ImageSize[1]) };
  if (state.Camera && state.Look.undistorted)
  {
    appearance.undistortedVideo = true;
    appearance.lookup = state.Lens;
    appearance.pinhole = { state.Camera->fx(), state.Camera->fy(), state.Camera->cx(), state.Camera->cy() };
  }
  return appearance;
}

void vtkHandEyeOverlayScene::SynchronizeAppearance(const vtkHandEyeOverlayState& state)
{
  const handeye::OverlayLook& look = state.Look;
  handeye::LensAppearance appearance = this->Appearance(state);
  appearance.outputAlpha = vtkHandEyeOutlinePass::ModelAlpha;
  const bool surface = look.surface || look.wireframe;
  appearance.opacity = state.MaskMode ? 1 : (surface ? state.Opacity * state.Fade : 0);
  const bool plain = state.MaskMode;
  appearance.features.keyhole = look.keyhole && !plain;
  appearance.features.ghosting = look.ghosting && state.Video && !plain;
  appearance.features.depthColors = look.depthColors && !plain;
  appearance.features.clip = look.clipping;
  appearance.features.limit = state.Mesh && reachesLimit(state.Mesh, state.ModelToCamera, state.Lens.limitRadius);
  appearance.features.mix = appearance.opacity < 1 || appearance.features.keyhole || appearance.features.ghosting;
  const auto& [nearest, furthest] = this->ModelDepthRangeMm;
  appearance.clipDepthMm = nearest + look.clippingDepth * (furthest - nearest);
  appearance.depthRangeMm = { nearest, std::max(furthest, nearest + 1e-3) };
  appearance.keyhole = { look.keyholeCenter[0], 1 - look.keyholeCenter[1], look.keyholeRadius * this->PictureRectangle[3] };
  appearance.ghosting = look.ghostingStrength;
  const bool hasVideo = state.Video && !state.MaskMode;
  this->ModelMapper->SetVideoTexture(hasVideo ? this->VideoTexture.Get() : nullptr);
  this->ModelMapper->SetAppearance(appearance);
  // A faint model has faint outlines, and what is seen edge-on is not what a picture by depth or of lines is about.
  this->ModelMapper->SetRimStrength(plain || look.wireframe ? 0 : ModelRimStrength * std::min(1.0, 2 * appearance.opacity));
  handeye::LensAppearance depthOnly = this->Appearance(state);
  depthOnly.features.clip = appearance.features.clip;
  depthOnly.features.limit = appearance.features.limit;
  depthOnly.clipDepthMm = appearance.clipDepthMm;
  this->DepthMapper->SetAppearance(depthOnly);
}

void vtkHandEyeOverlayScene::SynchronizeStylus(const vtkHandEyeOverlayState& state)
{
  const bool known = state.Camera && state.StylusTipToCamera && state.StylusBody && !state.MaskMode;
  const bool hides = state.Camera && state.StylusTipToCamera && state.StylusBody && state.Look.occlusion;
  const bool shown = known && state.Look.stylus;
  const handeye::LensWarp warp = state.Look.undistorted ? handeye::plainWarp(state.Lens) : state.Lens;
  handeye::LensAppearance appearance = this->Appearance(state);
  appearance.outputAlpha = vtkHandEyeOutlinePass::OtherAlpha;
  const auto set = [&](vtkHandEyeLensMapper* mapper, vtkActor* actor, vtkPolyData* mesh, bool visible)
  {
    actor->SetVisibility(visible && mesh && mesh->GetNumberOfPolys() > 0);
    if (actor->GetVisibility())
    {
      mapper->SetInputData(mesh);
      mapper->SetLensWarp(warp);
      actor->SetUserMatrix(state.StylusTipToCamera);
    }
  };
  set(this->BodyMapper, this->BodyActor, state.StylusBody, hides && this->IsModelSeen(state));
  set(this->RayMapper, this->RayActor, state.StylusRay, shown);
  set(this->TipMapper, this->TipActor, state.StylusTip, shown);
  this->RayMapper->SetAppearance(appearance);
  this->TipMapper->SetAppearance(appearance);
  appearance.features.mix = true;
  appearance.opacity = 0;
  const bool hasVideo = state.Video && !state.MaskMode;
  this->BodyMapper->SetVideoTexture(hasVideo ? this->VideoTexture.Get() : nullptr);
  this->BodyMapper->SetAppearance(appearance);
  const auto paint = [](vtkActor* actor, double red, double green, double blue)
  {
    actor->GetProperty()->SetColor(red, green, blue);
    actor->GetProperty()->SetAmbient(0.6);
    actor->GetProperty()->SetDiffuse(0.4);
  };
  paint(this->RayActor, 0.2, 0.9, 1);
  paint(this->TipActor, 1, 1, 0.1);

  double nearest = this->ModelActor->GetVisibility() ? this->ModelDepthRangeMm[0] : VTK_DOUBLE_MAX;
  double furthest = this->ModelActor->GetVisibility() ? this->ModelDepthRangeMm[1] : -VTK_DOUBLE_MAX;
  for (vtkActor* actor : { this->BodyActor.Get(), this->RayActor.Get(), this->TipActor.Get() })
  {
    if (actor->GetVisibility())
    {
      auto* mesh = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput());
      const std::array<double, 2> range = depthRange(mesh, state.StylusTipToCamera, false);
      nearest = std::min(nearest, range[0]);
      furthest = std::max(furthest, range[1]);
    }
  }
  if (furthest >= nearest)
  {
    const double far = std::max(1.01 * furthest, 2 * NearestMm);
    this->DepthRangeMm = { std::max({ 0.99 * nearest, NearestMm, DepthRatio * far }), far };
    this->ModelRenderer->GetActiveCamera()->SetClippingRange(this->DepthRangeMm[0], this->DepthRangeMm[1]);
  }
}

/// How far (px of the picture) the halo reaches beyond the model, at most: no further than by the error of the worst corner of
/// its box.
double vtkHandEyeOverlayScene::HaloReach(const vtkHandEyeOverlayState& state) const
{
  const Eigen::Matrix<double, 3, 8> corners = cornersInCamera(state.Mesh, state.ModelToCamera);
  double variance = 0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const double depthMm = std::max(corners(2, corner), NearestMm);
    const Eigen::Vector2d plain = corners.col(corner).head<2>() / depthMm;
    const Eigen::Vector2d place(
      plain.x() * state.Camera->fx() + state.Camera->cx(), plain.y() * state.Camera->fy() + state.Camera->cy());
    variance = std::max(variance, state.ErrorField->covariancePx(place, depthMm).trace());
  }
  return 1.2 * handeye::ErrorQuantile95 * std::sqrt(variance);
}

std::array<double, 4> vtkHandEyeOverlayScene::ModelRectangle(const vtkHandEyeOverlayState& state, double marginPx) const
{
  const double width = this->PictureRectangle[2], height = this->PictureRectangle[3];
  const std::array<double, 4> everything{ -1, -1, width + 1, height + 1 };
  const Eigen::Matrix<double, 3, 8> corners = cornersInCamera(state.Mesh, state.ModelToCamera);
  std::array<double, 4> rectangle{ width, height, 0, 0 };
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d& point = corners.col(corner);
    const Eigen::Array2d plain = point.head<2>() / point.z();
    if (point.z() < NearestMm || plain.matrix().norm() > state.Lens.limitRadius)
    {
      return everything;  // a corner that the lens does not see says nothing about where the others are
    }
    const Eigen::Array2d seen = state.Look.undistorted ? plain : state.Camera->distort(plain.matrix()).array();
    const double x = (seen.x() * state.Camera->fx() + state.Camera->cx() + 0.5) / state.Camera->width() * width;
    const double y = height - (seen.y() * state.Camera->fy() + state.Camera->cy() + 0.5) / state.Camera->height() * height;
    rectangle = { std::min(rectangle[0], x), std::min(rectangle[1], y), std::max(rectangle[2], x), std::max(rectangle[3], y) };
  }
  // The box' edges are bent by less than a tenth of its size.
  const double margin = marginPx + 0.1 * std::max(rectangle[2] - rectangle[0], rectangle[3] - rectangle[1]);
  return { rectangle[0] - margin, rectangle[1] - margin, rectangle[2] + margin, rectangle[3] + margin };
}

void vtkHandEyeOverlayScene::SynchronizeOutline(const vtkHandEyeOverlayState& state)
{
  const bool needed = this->NeedsOutlinePass(state);
  this->ModelRenderer->SetPass(needed ? this->OutlinePass.Get() : nullptr);
  if (!needed)
  {
    return;
  }
  const double scaleX = double(this->PictureRectangle[2]) / state.ImageSize[0];
  const double scaleY = double(this->PictureRectangle[3]) / state.ImageSize[1];
  double bounds[6];
  state.Mesh->GetBounds(bounds);
  const Eigen::Vector3d diagonal(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]);
  vtkHandEyeOutlinePass::Settings settings;
  settings.line = state.Look.outline;
  settings.lineWidthPx = std::max(1.5, state.Look.outlineWidthPx * scaleY);
  settings.lineColor = state.Look.outlineColor;
  settings.depthStepMm = std::max(1e-3, DepthStepShare * diagonal.norm());
  double marginPx = settings.lineWidthPx + 2;
  if (state.Look.errorHalo && state.ErrorField)
  {
    settings.haloField = state.ErrorField;
    settings.haloScale = { scaleX, scaleY };
    settings.modelDepthRangeMm = this->ModelDepthRangeMm;
    for (double& depthMm : settings.modelDepthRangeMm)
    {
      depthMm = std::max(depthMm, NearestMm);
    }
    marginPx += std::max(scaleX, scaleY) * this->HaloReach(state);
  }
  settings.haloColor = state.Look.haloColor;
  settings.modelRectanglePx = this->ModelRectangle(state, marginPx);
  settings.depthRangeMm = this->DepthRangeMm;
  settings.opacity = state.Fade;
  settings.eye = this->Channel();
  this->OutlinePass->SetSettings(settings);
}

void vtkHandEyeOverlayScene::SynchronizeTexts(const vtkHandEyeOverlayState& state)
{
  std::string legend;
  if (state.Look.depthColors && this->IsModelSeen(state))
  {
    legend = text("depth: red %.0f mm, blue %.0f mm", this->ModelDepthRangeMm[0], this->ModelDepthRangeMm[1]);
  }
  if (state.Look.errorHalo && state.ModelVisible)
  {
    const std::string unknown = "predicted error: not known";
    const std::string known = state.ErrorAxes_Px
      ? text("halo: 95 %% of the predicted error, %.1f x %.1f px in the middle", (*state.ErrorAxes_Px)[0], (*state.ErrorAxes_Px)[1])
      : std::string("halo: 95 % of the predicted error");
    legend += (legend.empty() ? "" : "\n") + (state.ErrorField ? known : unknown);
  }
  const int size = std::max(8, int(std::lround(this->PictureRectangle[3] / 28.0)));
  const auto write = [&](vtkTextActor* actor, const std::string& words)
  {
    actor->SetVisibility(!words.empty() && !state.MaskMode);
    actor->SetInput(words.c_str());
    actor->GetTextProperty()->SetFontSize(size);
  };
  write(this->NoticeActor, state.Notice);
  write(this->LegendActor, legend);
}
