// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// What counts as a rest.
struct StillnessOptions
{
  enum class Touch
  {
    Held,     ///< the tool keeps still, tip and orientation
    Pivoted,  ///< the tip keeps still while the tool turns about it
    Either    ///< the tip keeps still, whatever the tool does
  };

  Touch touch = Touch::Either;
  double maximumMotionMm = 1.5;                         ///< of the tip from the middle of its rest
  double maximumTurn = double(2 * EIGEN_PI / 180);      ///< rad, from the mean orientation, of a tool that is held still
  double minimumPivoting = double(5 * EIGEN_PI / 180);  ///< rad, root mean square from the mean orientation, of a tool that pivots
  double minimumDurationSec = 1.0;
  double maximumGapSec = 0.5;        ///< without a valid pose, before a rest is over
  double maximumExcursionSec = 0.2;  ///< beyond the limits, before a rest is over; what is shorter is left out

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// One rest: the average of its samples, and their spread.
struct Rest
{
  enum class Kind
  {
    Held,
    Pivoted
  };

  Kind kind = Kind::Held;
  Eigen::Vector3d tip_World = Eigen::Vector3d::Zero();            ///< mm, the mean
  Eigen::Matrix3d tipCovariance = Eigen::Matrix3d::Zero();        ///< mm^2, of one sample about the mean
  Eigen::Isometry3d toolToWorld = Eigen::Isometry3d::Identity();  ///< mean orientation, and such that the tip is at its mean
  double rmsMm = 0;                                               ///< root mean square distance of the samples from the mean
  double turn = 0;                                                ///< rad, root mean square angle from the mean orientation
  double beginSec = 0;
  double endSec = 0;
  long long firstSample = 0;  ///< counts what was added, from 0
  long long lastSample = 0;
  int count = 0;    ///< samples that were averaged
  int leftOut = 0;  ///< short excursions
};

/// Recognises from a stream of poses where a tool was held still, or pivoted on its resting tip.
///
/// Frames: tip_World = toolToWorld * tip_Tool; World is the tracker, or better a marker on what is touched. A rest begins with the
/// first `minimumDurationSec` in which at most a tenth of the samples lie beyond the limits about the median; it goes on while
/// samples stay within the limits about the running mean, and ends with an excursion or a gap that is too long. Memory is fixed
/// at construction; each sample costs one pass over a window of at most 256 samples until a rest has begun, and constant time
/// from then on.
///
/// Not safe to share between threads.
class StillnessDetector
{
public:
  /// @param tip_Tool mm @throws std::invalid_argument if the tip is not finite or the options do not check
  explicit StillnessDetector(const Eigen::Vector3d& tip_Tool, const StillnessOptions& options = {});

  /// A valid pose at a time. A sample that is older than the one before it is left out; by more than 10 s, and the clock was set:
  /// the rest ends and everything begins anew.
  /// @return the rest that this sample ended
  /// @throws std::invalid_argument if a number is not finite
  std::optional<Rest> add(double timeSec, const Eigen::Isometry3d& toolToWorld);

  /// A sample without a valid pose: it only lets time pass. @return the rest that it ended
  std::optional<Rest> addInvalid(double timeSec);

  /// The end of the stream. @return the rest that was under way
  std::optional<Rest> finish();

  /// The rest that is under way, with the samples so far.
  std::optional<Rest> current() const;

  /// How near the newest samples are to a rest: 0 moving, 1 at rest; for a ring that fills.
  double progress() const;

private:
  struct Sample
  {
    double timeSec;
    long long index;
    Eigen::Vector3d tip_World;
    Eigen::Quaterniond toolToWorld;
  };

  bool isWithin(const Sample& sample, const Eigen::Vector3d& tip_World, const Eigen::Quaterniond& orientation) const;
  void push(const Sample& sample);
  std::size_t windowBegin(double sinceSec) const;
  double stillSince() const;
  void tryToBegin();
  void include(const Sample& sample);
  std::optional<Rest> end();
  std::optional<Rest> finishIfClockWasSet(double timeSec);

  Eigen::Vector3d tip_Tool_;
  StillnessOptions options_;
  std::vector<Sample> window_;  ///< the newest samples, oldest first; its capacity is fixed
  long long added_ = 0;
  double newestSec_ = 0;
  double newestValidSec_ = 0;
  bool isResting_ = false;
  Rest rest_;
  int pending_ = 0;  ///< samples beyond the limits since the last one of the rest
  Eigen::Matrix3d scatter_ = Eigen::Matrix3d::Zero();
  Eigen::Quaterniond orientationSum_ = Eigen::Quaterniond::Identity();
};

/// "held", "pivoted".
std::string toString(Rest::Kind kind);

}  // namespace handeye
