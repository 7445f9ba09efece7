// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeSceneProps.h"

#include "CameraModel.h"
#include "EigenVtk.h"
#include "HandEyeSceneGeometry.h"
#include "HandEyeSceneParts.h"

#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWeakPointer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

void checkFinite(const Eigen::MatrixXd& numbers, const char* what)
{
  if (!numbers.allFinite())
  {
    throw std::invalid_argument(std::string(what) + " holds a number that is not finite");
  }
}

void check(const std::optional<Eigen::Isometry3d>& pose, const char* what)
{
  if (pose)
  {
    checkFinite(pose->matrix(), what);
  }
}

/// Green, over amber, to red.
std::array<unsigned char, 3> residualColor(double share)
{
  const std::array<double, 3> green{ 46, 170, 90 }, amber{ 235, 170, 30 }, red{ 220, 50, 40 };
  const bool low = share < 0.5;
  const std::array<double, 3>& from = low ? green : amber;
  const std::array<double, 3>& to = low ? amber : red;
  const double weight = std::clamp(low ? 2 * share : 2 * share - 1, 0.0, 1.0);
  std::array<unsigned char, 3> rgb{};
  for (std::size_t channel = 0; channel < 3; ++channel)
  {
    rgb[channel] = static_cast<unsigned char>(std::lround((1 - weight) * from[channel] + weight * to[channel]));
  }
  return rgb;
}

constexpr std::array<unsigned char, 3> Grey{ 150, 150, 150 };

}  // namespace

class HandEyeSceneProps::Private
{
public:
  Private()
  {
    tracker.mapper->SetInputData(trackerShape());
    tracker.place(Eigen::Isometry3d::Identity());
    for (HandEyeSceneProp* marker : { &cameraMarker, &stylusMarker, &phantomMarker })
    {
      marker->mapper->SetInputData(markerShape());
    }
    camera.mapper->SetInputData(cameraShape());
    ball.mapper->SetInputData(unitBall());
    next.mapper->SetInputData(coarseBall());
    next.actor->GetProperty()->SetRepresentationToWireframe();
    next.actor->GetProperty()->LightingOff();
    frustum.actor->GetProperty()->LightingOff();
    this->setLineWidths(1);
    captured.clear();
    touched.clear();
  }

  void setLineWidths(double pixelRatio)
  {
    next.actor->GetProperty()->SetLineWidth(float(1.5 * pixelRatio));
    frustum.actor->GetProperty()->SetLineWidth(float(2 * pixelRatio));
  }

  std::vector<vtkProp*> props()
  {
    std::vector<vtkProp*> all = { captured.actor, touched.actor };
    for (HandEyeSceneProp* prop :
      { &tracker, &cameraMarker, &camera, &frustum, &stylusMarker, &shaft, &ball, &phantomMarker, &phantom, &next })
    {
      all.push_back(prop->actor);
    }
    return all;
  }

  void placeCamera();
  void placeStylus();
  void placePhantom();
  void colorPoints();

  HandEyeSceneProp tracker{ 0.55, 0.58, 0.62 };
  HandEyeSceneProp cameraMarker{ 0.72, 0.74, 0.78 }, camera{ 0.23, 0.43, 0.65 }, frustum{ 0.3, 0.6, 0.95 };
  HandEyeSceneProp stylusMarker{ 0.72, 0.74, 0.78 }, shaft{ 0.6, 0.62, 0.66 }, ball{ 0.85, 0.22, 0.2 };
  HandEyeSceneProp phantomMarker{ 0.72, 0.74, 0.78 }, phantom{ 0.9, 0.86, 0.72 }, next{ 0.95, 0.65, 0.15 };
  HandEyeSceneBalls captured, touched;
  vtkWeakPointer<vtkRenderer> renderer;

  std::optional<Eigen::Isometry3d> markerToTracker, markerToCamera, stylusToTracker, phantomToTracker, modelToPhantom;
  std::optional<Eigen::Vector3d> tip_Stylus, next_Camera;
  std::vector<CapturedPoint> points;
  double ballRadiusMm = 15, redPx = 3;
  bool hasFrustum = false, hasMesh = false;
};

void HandEyeSceneProps::Private::placeCamera()
{
  std::optional<Eigen::Isometry3d> cameraToTracker;
  if (markerToTracker && markerToCamera)
  {
    const Eigen::Isometry3d cameraToMarker = markerToCamera->inverse();
    cameraToTracker = *markerToTracker * cameraToMarker;
  }
  cameraMarker.place(markerToTracker);
  captured.place(markerToTracker);
  camera.place(cameraToTracker);
  frustum.place(cameraToTracker, hasFrustum);
  std::optional<Eigen::Isometry3d> nextToTracker;
  if (cameraToTracker && next_Camera)
  {
    nextToTracker = *cameraToTracker * Eigen::Translation3d(*next_Camera);
  }
  next.place(nextToTracker);
  next.actor->SetScale(ballRadiusMm);
}

void HandEyeSceneProps::Private::placeStylus()
{
  stylusMarker.place(stylusToTracker);
  shaft.place(stylusToTracker, tip_Stylus.has_value());
  std::optional<Eigen::Isometry3d> tipToTracker;
  if (stylusToTracker && tip_Stylus)
  {
    tipToTracker = *stylusToTracker * Eigen::Translation3d(*tip_Stylus);
  }
  ball.place(tipToTracker);
  ball.actor->SetScale(ballRadiusMm);
}

void HandEyeSceneProps::Private::placePhantom()
{
  phantomMarker.place(phantomToTracker);
  touched.place(phantomToTracker);
  std::optional<Eigen::Isometry3d> modelToTracker;
  if (phantomToTracker && modelToPhantom)
  {
    modelToTracker = *phantomToTracker * *modelToPhantom;
  }
  phantom.place(modelToTracker, hasMesh);
}

void HandEyeSceneProps::Private::colorPoints()
{
  captured.clear();
  for (const CapturedPoint& point : points)
  {
    const bool colored = point.used && point.residualPx;
    captured.add(point.tip_Marker, point.used ? 6 : 3.5, colored ? residualColor(*point.residualPx / redPx) : Grey);
  }
  captured.data->Modified();
  captured.place(markerToTracker);
}

HandEyeSceneProps::HandEyeSceneProps()
  : d(std::make_unique<Private>())
{
}

HandEyeSceneProps::~HandEyeSceneProps()
{
  this->addTo(nullptr);
}

void HandEyeSceneProps::addTo(vtkRenderer* renderer)
{
  for (vtkProp* prop : d->props())
  {
    if (d->renderer)
    {
      d->renderer->RemoveViewProp(prop);
    }
    if (renderer)
    {
      renderer->AddViewProp(prop);
    }
  }
  d->renderer = renderer;
  if (renderer && renderer->GetRenderWindow())
  {
    // Qt's windows say by their resolution how many pixels of the device a pixel is.
    d->setLineWidths(std::max(1.0, renderer->GetRenderWindow()->GetDPI() / 72.0));
  }
}

void HandEyeSceneProps::setTrackerVisible(bool visible)
{
  d->tracker.actor->SetVisibility(visible);
}

void HandEyeSceneProps::setMarkerToTracker(const std::optional<Eigen::Isometry3d>& markerToTracker)
{
  check(markerToTracker, "markerToTracker");
  d->markerToTracker = markerToTracker;
  d->placeCamera();
}

void HandEyeSceneProps::setCameraModel(const std::optional<CameraModel>& camera, double frustumDepthMm)
{
  if (camera && !(camera->hasImageSize() && frustumDepthMm > 0 && std::isfinite(frustumDepthMm)))
  {
    throw std::invalid_argument("a frustum needs a camera with an image size and a positive depth (mm)");
  }
  d->hasFrustum = camera.has_value();
  if (camera)
  {
    d->frustum.mapper->SetInputData(frustumShape(*camera, frustumDepthMm));
  }
  d->placeCamera();
}

void HandEyeSceneProps::setMarkerToCamera(const std::optional<Eigen::Isometry3d>& markerToCamera)
{
  check(markerToCamera, "markerToCamera");
  d->markerToCamera = markerToCamera;
  d->placeCamera();
}

void HandEyeSceneProps::setStylusToTracker(const std::optional<Eigen::Isometry3d>& stylusToTracker)
{
  check(stylusToTracker, "stylusToTracker");
  d->stylusToTracker = stylusToTracker;
  d->placeStylus();
}

void HandEyeSceneProps::setStylusTip(const std::optional<Eigen::Vector3d>& tip_Stylus, double ballRadiusMm)
{
  if (!(ballRadiusMm > 0 && std::isfinite(ballRadiusMm)))
  {
    throw std::invalid_argument("a ball has a positive radius (mm)");
  }
  if (tip_Stylus)
  {
    checkFinite(*tip_Stylus, "tip_Stylus");
    d->shaft.mapper->SetInputData(shaftShape(*tip_Stylus));
  }
  d->tip_Stylus = tip_Stylus;
  d->ballRadiusMm = ballRadiusMm;
  d->placeStylus();
  d->placeCamera();
}

void HandEyeSceneProps::setPhantomMesh(vtkPolyData* mesh)
{
  d->hasMesh = mesh != nullptr;
  d->phantom.mapper->SetInputData(mesh);
  d->placePhantom();
}

void HandEyeSceneProps::setPhantomToTracker(const std::optional<Eigen::Isometry3d>& phantomToTracker)
{
  check(phantomToTracker, "phantomToTracker");
  d->phantomToTracker = phantomToTracker;
  d->placePhantom();
}

void HandEyeSceneProps::setModelToPhantom(const std::optional<Eigen::Isometry3d>& modelToPhantom)
{
  check(modelToPhantom, "modelToPhantom");
  d->modelToPhantom = modelToPhantom;
  d->placePhantom();
}

void HandEyeSceneProps::setTouchedLandmarks(const std::vector<Eigen::Vector3d>& points_Phantom)
{
  d->touched.clear();
  for (std::size_t index = 0; index < points_Phantom.size(); ++index)
  {
    checkFinite(points_Phantom[index], ("landmark " + std::to_string(index)).c_str());
    d->touched.add(points_Phantom[index], 3, { 224, 72, 62 });
  }
  d->touched.data->Modified();
  d->placePhantom();
}

void HandEyeSceneProps::setCapturedPoints(const std::vector<CapturedPoint>& points)
{
  for (std::size_t index = 0; index < points.size(); ++index)
  {
    checkFinite(points[index].tip_Marker, ("captured point " + std::to_string(index)).c_str());
  }
  d->points = points;
  d->colorPoints();
}

void HandEyeSceneProps::setResidualScalePx(double redPx)
{
  if (!(redPx > 0 && std::isfinite(redPx)))
  {
    throw std::invalid_argument("the residual (px) that is red is positive");
  }
  d->redPx = redPx;
  d->colorPoints();
}

void HandEyeSceneProps::setNextPlace(const std::optional<Eigen::Vector3d>& ball_Camera)
{
  if (ball_Camera)
  {
    checkFinite(*ball_Camera, "ball_Camera");
  }
  d->next_Camera = ball_Camera;
  d->placeCamera();
}

bool HandEyeSceneProps::isCameraVisible() const
{
  return d->camera.actor->GetVisibility();
}

bool HandEyeSceneProps::isStylusVisible() const
{
  return d->shaft.actor->GetVisibility();
}

bool HandEyeSceneProps::isPhantomVisible() const
{
  return d->phantom.actor->GetVisibility();
}

}  // namespace handeye
