// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "CameraModel.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye::study
{

/// One eye of a camera of the study.
struct StudyEye
{
  CameraModel camera;
  Eigen::Isometry3d markerToCamera;  ///< the truth: p_Camera = markerToCamera * p_Marker, mm
};

/// A camera of the study, with what is held in front of it.
struct StudyCamera
{
  std::string name;   ///< "webcam", "headset", "laparoscope"
  std::string title;  ///< for a person
  std::vector<StudyEye> eyes;
  double nearestMm = 0, furthestMm = 0;  ///< depths of ball and board
  double ballRadiusMm = 0;
  BoardDescription board;

  double markerDistanceMm() const;  ///< of the first eye's centre from its marker's origin
};

/// The three kinds of camera of the paper: a webcam, a head-mounted pass-through stereo camera and a stereo laparoscope, whose
/// marker sits on the handle, as it must outside of the patient. Each eye has its own lens.
std::vector<StudyCamera> studyCameras();

}  // namespace handeye::study
