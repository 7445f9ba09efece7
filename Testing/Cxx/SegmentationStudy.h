// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CameraModel.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace handeye::test
{

/// One of the conditions under which the segmentation is studied.
struct StudyCell
{
  std::string lens;        ///< one of studyLenses()
  double radiusPx = 30;    ///< apparent radius of such a ball on the axis: f tan(alpha)
  double offAxisDeg = 0;   ///< between the ray to the ball's centre and the optical axis
  double hiddenShare = 0;  ///< of the outline, behind a straight edge in another colour
  double noise = 1;        ///< standard deviation in grey levels of 8 bits
};

struct StudyEffort
{
  int places = 12;        ///< of the ball against the grid of pixels, about the axis and within a pixel
  int draws = 6;          ///< of noise at each place
  bool isShaded = false;  ///< a lamp above; otherwise the ball has one colour
  /// Each pixel is divided into so many in each direction before the light is blurred, as by optics, and summed up over the pixel. With 1
  /// the pixels themselves are blurred: an edge is then a broken line from pixel to pixel, which no camera's is.
  int parts = 4;
};

/// What comes out of a cell. With e_pd the error of draw d at place p (px):
struct StudyResult
{
  int tried = 0;
  int found = 0;                 ///< with an error below a pixel
  double biasPx = 0;             ///< root mean square over the places of |mean over draws of e|, less what the noise adds to it
  double biasUncertaintyPx = 0;  ///< standard error of biasPx, where it is 0
  double systematicPx = 0;       ///< |mean over all of e|, turned so that the ball is to the right of the image's centre
  double spreadPx = 0;           ///< standard deviation of e about its place's mean, each of the two coordinates
  double boundPx = 0;            ///< Cramer and Rao's bound of the same
  double claimedPx = 0;          ///< standard deviation that the detection claims, root mean square
  double ratio() const { return spreadPx / boundPx; }
};

struct StudyLens
{
  std::string name;
  CameraModel camera;
};

/// A webcam (f = 650 px, 640 x 480, moderate distortion), a headset's camera (571 px, 960 x 720, k1 = -0.19) and a lens with strong
/// barrel distortion (1100 px, k1 = -0.4).
const std::vector<StudyLens>& studyLenses();

/// Renders, photographs and detects the ball `places` x `draws` times, and works out the bound.
///
/// Each picture is the part of a sensor around the ball, which is as large as it needs to be, so that every lens is tried up to
/// any angle that its model covers: the camera of a part has its principal point moved.
///
/// The bound: the covariance of the ball's centre in the image that no unbiased estimate can be below, from the derivatives of
/// the noise-free picture by the ball's three coordinates (central differences of the renderer, a quarter of a pixel to either
/// side), white noise of the given size and that of rounding (1/12) in each pixel and channel. Colours, blur and the curve of the
/// encoding count as known, the hiding edge as well: an estimate that has to find these out as well has a slightly larger bound.
/// Its square is the mean of the two coordinates' variances.
///
/// Deterministic.
/// @throws std::invalid_argument for a lens that is not known, or a ball that the lens model does not cover
StudyResult runStudyCell(const StudyCell& cell, const StudyEffort& effort, const BallDetectionOptions& options = {});

/// The bound alone, px.
double studyBound(const StudyCell& cell, const StudyEffort& effort);

}  // namespace handeye::test
