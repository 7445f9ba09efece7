// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"
#include "StillnessDetector.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

struct TouchedLandmarksOptions
{
  std::string stylusToTracker = "StylusToTracker";
  /// Pose of the marker on what is touched. Empty: PhantomToTracker, ReferenceToTracker or, if there is but one other tool,
  /// that one.
  std::string phantomToTracker;
  StillnessOptions stillness;
  /// Rests in a row that are nearer to each other than this (mm) are one landmark, touched once.
  double samePlaceMm = 4;
  /// The tip may be this far (mm) from the one about which the recorded stylus turns, before the stylus' calibration is doubted.
  double largestTipErrorMm = 3;
  /// And this far without a warning; a few seconds of pivoting on each landmark know the tip about as well.
  double noticedTipErrorMm = 1;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// A place that was touched.
struct TouchedLandmark
{
  Rest rest;                                                ///< its World is the phantom's marker, its samples are frames
  Eigen::Vector3d point_Phantom = Eigen::Vector3d::Zero();  ///< mm
};

struct TouchedLandmarksResult
{
  enum class Status
  {
    Ok,
    NoRests,  ///< the tip rests nowhere
    WrongTip  ///< the stylus in the recording turns about another point than the tip that was given
  };

  Status status = Status::NoRests;
  std::string message;
  std::string stylusToTracker, phantomToTracker;  ///< the transforms that were used; the second is empty if there is no such marker
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> tipInRecording_Stylus;  ///< about which the recorded stylus turned, if it did
  std::vector<TouchedLandmark> landmarks;                ///< in the order of touching
  std::vector<TouchedLandmark> setAside;                 ///< rests that are no landmarks: held, where the landmarks were pivoted on
  std::vector<std::string> warnings;

  bool isUsable() const { return status == Status::Ok; }
  std::vector<Eigen::Vector3d> points_Phantom() const;
};

/// Finds the landmarks that were touched in a recording: where the stylus' tip rested, in the frame of the phantom's marker.
///
/// A landmark is touched by holding the stylus still on it or, more accurately, by pivoting the stylus on it. Where at least three
/// landmarks were pivoted on, that is how this recording was made, and places where the stylus only lay still (on the table, before
/// and after) are set aside.
///
/// If the stylus was pivoted, the recording itself says where its tip is; a given tip that contradicts it is refused.
///
/// @param tip_Stylus mm; nothing to take the tip from the recording. A tip of zero says that the poses are the tip's own; where
/// the stylus
///   turns about another point, that one is taken, with a warning.
/// @throws io::FileError, listing the transforms that there are, where a tool is not in the recording; std::invalid_argument if the
///   options do not check
[[nodiscard]] TouchedLandmarksResult landmarksFromRecording(
  const io::Recording& recording, const std::optional<Eigen::Vector3d>& tip_Stylus, const TouchedLandmarksOptions& options = {});

/// "ok", "no_rests", "wrong_tip".
std::string toString(TouchedLandmarksResult::Status status);

}  // namespace handeye
