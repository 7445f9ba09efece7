// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <vector>

class vtkPolyData;
class vtkRenderer;

namespace handeye
{

class CameraModel;

/// The operating room in three dimensions: tracker, camera with its frustum, stylus with its ball, phantom, the places that were
/// captured, and the next one; props for any renderer, whose world frame is the `Tracker`'s, mm.
///
/// A pose that is not there (nothing) hides what depends on it: a hidden tool is not shown where it last was. No call renders.
///
///     p_Tracker = cameraToTracker * p_Camera      cameraToTracker = markerToTracker * inverse(markerToCamera)
///
/// Transforms are rigid, mm. Setters throw std::invalid_argument for numbers that are not finite. All calls belong to the thread
/// that renders.
class HandEyeSceneProps
{
public:
  /// A place where the ball was held, in the frame of the camera's marker, with which it moves.
  struct CapturedPoint
  {
    Eigen::Vector3d tip_Marker = Eigen::Vector3d::Zero();
    std::optional<double> residualPx;  ///< green to red; nothing: grey
    bool used = true;                  ///< not used: small and grey
  };

  HandEyeSceneProps();
  ~HandEyeSceneProps();
  HandEyeSceneProps(const HandEyeSceneProps&) = delete;
  HandEyeSceneProps& operator=(const HandEyeSceneProps&) = delete;

  /// Adds the props to a renderer and takes them out of the one before; null only takes them out. The renderer is not kept alive.
  void addTo(vtkRenderer* renderer);

  /// The tracker's body at the origin; shown until set.
  void setTrackerVisible(bool visible);

  /// The marker on the camera; captured points hang on it.
  void setMarkerToTracker(const std::optional<Eigen::Isometry3d>& markerToTracker);
  /// The lens, for the frustum, which reaches this far; needs an image size. Nothing: no frustum.
  void setCameraModel(const std::optional<CameraModel>& camera, double frustumDepthMm = 300);
  /// The calibration: without it there is a marker and no camera.
  void setMarkerToCamera(const std::optional<Eigen::Isometry3d>& markerToCamera);

  void setStylusToTracker(const std::optional<Eigen::Isometry3d>& stylusToTracker);
  /// The tip and its ball. Nothing: a marker without a stylus.
  void setStylusTip(const std::optional<Eigen::Vector3d>& tip_Stylus, double ballRadiusMm);

  /// The phantom's mesh in its own (`Model`) frame; shared, not changed. Null: only the marker.
  void setPhantomMesh(vtkPolyData* mesh);
  void setPhantomToTracker(const std::optional<Eigen::Isometry3d>& phantomToTracker);
  /// The registration: without it the mesh is not shown.
  void setModelToPhantom(const std::optional<Eigen::Isometry3d>& modelToPhantom);
  /// Landmarks touched so far, in the frame of the phantom's marker.
  void setTouchedLandmarks(const std::vector<Eigen::Vector3d>& points_Phantom);

  void setCapturedPoints(const std::vector<CapturedPoint>& points);
  /// The residual (px) from which on a point is red; 3 until set.
  void setResidualScalePx(double redPx);
  /// Where the ball is wanted next; without a calibration it is not shown.
  void setNextPlace(const std::optional<Eigen::Vector3d>& ball_Camera);

  /// Whether something is shown, for tests and for the words beside the view.
  bool isCameraVisible() const;
  bool isStylusVisible() const;
  bool isPhantomVisible() const;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
