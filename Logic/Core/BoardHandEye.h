// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "CameraModel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// One picture of the board, and where the tracker saw the camera's marker.
struct BoardHandEyeView
{
  int frame = 0;                                                      ///< index in the recording, passed through
  Eigen::Isometry3d markerToTracker = Eigen::Isometry3d::Identity();  ///< p_Tracker = markerToTracker * p_Marker
  std::vector<int> ids;                                               ///< of the points, so that views can be matched
  std::vector<Eigen::Vector3d> points_Board;                          ///< mm, one per id
  std::vector<Eigen::Vector2d> points_Image;                          ///< px of the recorded image, one per id
  /// p_Camera = boardToCamera * p_Board; found from the points where it is not given.
  std::optional<Eigen::Isometry3d> boardToCamera;
  /// Where the tracker sees the board, for `tracked-board`: p_Tracker = boardToTracker * p_Board.
  std::optional<Eigen::Isometry3d> boardToTracker;
};

struct BoardHandEyeOptions
{
  enum class Method
  {
    Tsai,              ///< Tsai and Lenz 1989: modified Rodrigues vectors, then translation
    Park,              ///< Park and Martin 1994: logarithms, then translation; "Navy" in the literature
    Horaud,            ///< Horaud and Dornaika 1995: quaternion of the axes, then translation; "Inria"
    Daniilidis,        ///< Daniilidis 1999: dual quaternions, both at once; "Dual"
    BranchAndBound,    ///< Heller, Havlena and Pajdla 2012: the global optimum of the largest epipolar error
    TrackedBoard,      ///< Voruganti and Bartz 2008, Chen et al. 2012: paired points of a board that is tracked, too
    TrackedBoardLines  ///< the same points on the rays of their pixels: point-to-line
  };

  Method method = Method::Daniilidis;
  /// Pairs of views that turn less than this, or more than pi minus it, say little of the rotation and are not used (rad).
  double minimumTurnRad = 0.05;
  /// The smallest angle (rad) that the turning axes of the pairs must span; less is parallel.
  double minimumAxisSpreadRad = 0.1;
  /// Largest root mean square disagreement of the views with the result: rotation (rad) and the board's points (mm). More is a
  /// board
  /// that was moved, a transform of the wrong direction, or a wrong lens.
  double maximumRotationRmsRad = 0.05;
  double maximumRmsMm = 25;

  /// Of `BranchAndBound`: stop as soon as the proven gap is below this (rad), or below this share of the best error.
  double gapRad = 1e-6;
  double relativeGap = 0.01;
  double timeLimitSec = 60;         ///< then the best so far is the answer, with its gap
  double maximumOffsetMm = 1000;    ///< the camera's centre is no further from the marker's origin along each axis
  int maximumPairs = 20;            ///< of views, those that turn most about different axes
  int pointsPerPair = 4;            ///< correspondences of a pair, spread over the board
  bool startFromClosedForm = true;  ///< the first candidate is `Park`'s solution; without it the search finds all by itself

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// How far a branch and bound is. All zero for other methods.
struct BranchAndBoundState
{
  double bestErrorRad = 0;   ///< largest epipolar error of the best solution so far
  double lowerBoundRad = 0;  ///< no solution has a smaller one: proven
  double gapRad = 0;         ///< the difference
  long long cubes = 0;       ///< parts of the rotation space that were looked at
  long long linearPrograms = 0;
  double elapsedSec = 0;
  bool isProven = false;  ///< the gap is as small as was asked for
};

/// Called now and then by the branch and bound; `false` cancels, which keeps the best so far.
using BranchAndBoundProgress = std::function<bool(const BranchAndBoundState&)>;

struct BoardHandEyeResult
{
  enum class Status
  {
    Ok,
    TooFewViews,      ///< fewer than three views (two motions) with a pose; tracked board: fewer than one
    ParallelMotions,  ///< all motions turn about the same axis, or none turns
    NoBoardPose,      ///< too few views in which the board's pose could be found
    NoTrackedBoard,   ///< a tracked-board method without boardToTracker
    PoorFit,          ///< the result does not explain the views
    NotFound          ///< branch and bound: cancelled or out of time before there was any solution
  };

  struct View
  {
    bool used = false;       ///< false where the board's pose was not found: see message
    std::string message;     ///< why not
    double residualPx = 0;   ///< root mean square over the view's points of the reprojection through tracker and result
    double residualMm = 0;   ///< the same in mm: the points by the camera against those by the tracker
    double residualRad = 0;  ///< angle between the board's attitudes by the camera and by the tracker
    Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();  ///< as given or found; meaningless unless used
  };

  Status status = Status::TooFewViews;
  std::string message;                                               ///< for a person, verdict first
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();  ///< p_Camera = markerToCamera * p_Marker; only if usable
  /// p_Tracker = boardToTracker * p_Board, of the board that stands still; only if usable. Of a tracked board that of the first
  /// view.
  Eigen::Isometry3d boardToTracker = Eigen::Isometry3d::Identity();
  /// Of (rotation vector rad, translation mm) acting from the left in the camera frame, by leaving out one view at a time
  /// (jackknife): it holds whatever the method. Nothing for the branch and bound, and where there are too few views.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
  std::vector<View> views;  ///< one per view given
  int usedCount = 0;
  int pairCount = 0;             ///< motions that were used
  double reprojectionRmsPx = 0;  ///< of the views that were used: the data that were fitted, not a validation
  double rmsMm = 0;
  double rmsRad = 0;
  BranchAndBoundState branchAndBound;

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds where the camera sits relative to its marker from pictures of a board: the classical way, for comparison with
/// calibrateHandEye().
///
/// The board stands still and the camera moves. With C_ij the motion of the camera between two views (from the board's poses) and
/// M_ij that of the marker (from the tracker),
///
///     C_ij * markerToCamera = markerToCamera * M_ij          ("AX = XB": A = C_ij, X = markerToCamera, B = M_ij)
///     C_ij = boardToCamera_j * inverse(boardToCamera_i),     M_ij = inverse(markerToTracker_j) * markerToTracker_i
///
/// All pairs of views that turn enough are used. `BranchAndBound` takes the pixels instead of the board's poses: it minimises the
/// largest angle by which rays of corresponding points have to be bent to meet, over all rotations and all positions of the camera
/// within `maximumOffsetMm`; what it proves is in `branchAndBound`. The tracked-board methods need one view at least and no motion.
///
/// @param views points without a pose are given one by estimateBoardPose()
/// @param progress of the branch and bound, may be empty
/// @throws std::invalid_argument, naming the view (by its index, from 0), where sizes differ or a number is not finite
/// Thread-safe, deterministic but for the time limit.
/// References: Tsai and Lenz, IEEE T Robotics Automation 5:345 (1989), eq. 10-15. Park and Martin, IEEE T Robotics Automation
/// 10:717
/// (1994), eq. 16-19. Horaud and Dornaika, Int J Robotics Research 14:195 (1995), sec. 4.1. Daniilidis, Int J Robotics Research
/// 18:286 (1999), eq. 31-36. Heller, Havlena and Pajdla, CVPR 2012 and TPAMI 38:1027 (2016). Voruganti and Bartz, VRST 2008; Chen
/// et
/// al., MICCAI 2012 workshop AE-CAI.
[[nodiscard]] BoardHandEyeResult calibrateBoardHandEye(const std::vector<BoardHandEyeView>& views, const CameraModel& camera,
  const BoardHandEyeOptions& options = {}, const BranchAndBoundProgress& progress = {});

/// For boards that look the same turned: gives the views the numbering that agrees with the tracker's motions (a half turn of the
/// board changes the angle between two views, which the marker's motion knows). The first view keeps its own.
/// @return how many views were turned; nothing where the views do not say
std::optional<int> resolveHalfTurns(std::vector<BoardHandEyeView>& views, const BoardDescription& board, const CameraModel& camera);

/// "ok", "too_few_views", ...: the word that result files use.
std::string toString(BoardHandEyeResult::Status status);

/// "tsai", "park", "horaud", "daniilidis", "branch-and-bound", "tracked-board", "tracked-board-lines": the word of `--method`.
std::string toString(BoardHandEyeOptions::Method method);

}  // namespace handeye
