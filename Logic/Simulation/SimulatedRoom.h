// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "RoomMesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <memory>
#include <string>
#include <vector>

namespace handeye::simulation
{

/// What happens in the room.
enum class RoomMotion
{
  Pivot,       ///< the stylus turns about its tip, which rests in a divot
  Spin,        ///< the stylus is spun about its shaft, to and fro, its tip in the divot
  Placements,  ///< the ball is held still at places all over the view, moving quickly in between
  Free,        ///< the ball moves smoothly through the view: for temporal calibration and for the overlay
  Rest,        ///< the ball is held still, whole and near in the view: to be looked at and clicked on
  Landmarks,   ///< the tip is held on one landmark of the phantom after another
  Tour         ///< 12 s of Pivot, 40 s of Placements, 20 s of Free, and again
};

struct RoomOptions
{
  CameraModel camera;                ///< with its image size
  Eigen::Isometry3d markerToCamera;  ///< p_Camera = markerToCamera * p_Marker, mm
  Eigen::Vector3d tip_Stylus;        ///< the ball's centre, mm
  Eigen::Isometry3d modelToPhantom;  ///< p_Phantom = modelToPhantom * p_Model, mm
  /// Of Landmarks, mm: p_Phantom = modelToPhantom * landmark_Model.
  std::vector<Eigen::Vector3d> landmarks_Model;
  /// What the phantom looks like, with dots at its landmarks: p_Phantom = modelToPhantom * p_Model. Null: a few balls of bone.
  std::shared_ptr<const RoomMesh> phantomMesh;
  double ballRadiusMm = 15;
  RoomMotion motion = RoomMotion::Tour;
  int placeCount = 15;                       ///< of Placements
  double holdSec = 1.6, moveSec = 1;         ///< at a place, to the next
  double nearestMm = 160, furthestMm = 420;  ///< depths of the ball
  double trackingSigmaMm = 0.12;             ///< noise of a pose: per axis
  double trackingSigmaDeg = 0.03;
  double dropOutShare = 0.02;  ///< of the time that a tool is not seen, in pieces of 0.2 s
  double imageNoise = 1.5;     ///< standard deviation, in steps of 8 bits
  double blurPx = 0.7;
  /// A frame's time is later than its exposure by this much, as a camera's and a network's delay make it. The poses of a frame are
  /// then those at the frame's time plus a latency of -videoDelaySec.
  double videoDelaySec = 0;
  bool hasClutter = true;   ///< red rings, tissue, wood, a phantom
  bool cameraMoves = true;  ///< a camera held in a hand
  unsigned seed = 1;

  /// A webcam of 640 x 480 pixels with a marker on its back.
  RoomOptions();

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// A tool's pose as the tracker reports it.
struct RoomPose
{
  std::string name;                                             ///< "MarkerToTracker", "StylusToTracker", "PhantomToTracker"
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();  ///< mm; the last one seen, if it is not valid
  bool isValid = true;
};

/// A tracked camera that looks at a ball on a tracked stylus, and at a tracked phantom among clutter. All of it is a function of
/// time and
/// of the seed: the same moment is the same picture.
///
/// Frames: `Tracker` (mm, the room), `Marker` (on the camera), `Camera` (OpenCV), `Stylus`, `Phantom`. The ball is drawn
/// analytically with
/// its outline anti-aliased in linear light, through the exact lens.
///
/// Safe to share between threads.
class SimulatedRoom
{
public:
  explicit SimulatedRoom(const RoomOptions& options = {});
  ~SimulatedRoom();

  const RoomOptions& options() const { return options_; }

  /// What the tracker says at a moment (s).
  std::vector<RoomPose> track(double timeSec) const;

  /// The frame that carries this time.
  cv::Mat picture(double timeSec) const;

  /// What is true at the moment of exposure of the frame that carries this time.
  struct Truth
  {
    double exposureSec = 0;
    Eigen::Isometry3d markerToTracker, stylusToTracker, phantomToTracker;
    Eigen::Vector3d ball_Camera;
  };
  Truth truth(double frameTimeSec) const;

  /// Whether the ball is held still from a while before this time until then.
  bool isHeldStill(double timeSec) const;

private:
  struct Parts;
  RoomOptions options_;
  std::unique_ptr<const Parts> parts_;
};

/// "pivot", "spin", "placements", "free", "rest", "landmarks", "tour"
std::string toString(RoomMotion motion);

}  // namespace handeye::simulation
