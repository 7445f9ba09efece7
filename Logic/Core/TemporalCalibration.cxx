// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TemporalCalibration.h"

#include "NumberWords.h"
#include "PointLineRegistration.h"
#include "Statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

using Result = TemporalCalibrationResult;

constexpr double CoarseStepSec = 0.01;
constexpr double FineStepSec = 0.004;
constexpr int FineSteps = 3;  // on each side

std::string inMs(double seconds, int digits)
{
  return fixedDigits(1000 * seconds, digits) + " ms";
}

/// The residuals in px at one latency; those sightings that have poses there.
struct Fit
{
  std::vector<double> residualsPx;
  std::vector<std::size_t> sightings;

  double meanSquare() const
  {
    double sum = 0;
    for (double residual : residualsPx)
    {
      sum += residual * residual;
    }
    return residualsPx.empty() ? std::numeric_limits<double>::infinity() : sum / double(residualsPx.size());
  }
};

class Problem
{
public:
  Problem(const std::vector<BallSighting>& sightings, const PoseTrack& marker, const PoseTrack& stylus,
    const Eigen::Vector3d& tip_Stylus, double focalPx, const std::optional<Eigen::Isometry3d>& markerToCamera)
    : sightings_(sightings)
    , marker_(marker)
    , stylus_(stylus)
    , tip_Stylus_(tip_Stylus)
    , focalPx_(focalPx)
    , markerToCamera_(markerToCamera)
  {
  }

  std::optional<Eigen::Vector3d> tip_Marker(std::size_t sighting, double latencySec) const
  {
    const double timeSec = sightings_[sighting].timeSec + latencySec;
    const PoseAtTime markerToTracker = marker_.at(timeSec), stylusToTracker = stylus_.at(timeSec);
    if (!markerToTracker.isUsable() || !stylusToTracker.isUsable())
    {
      return std::nullopt;
    }
    const Eigen::Vector3d tip_Tracker = stylusToTracker.transform * tip_Stylus_;
    return markerToTracker.transform.inverse() * tip_Tracker;
  }

  Fit fitAt(double latencySec, const std::vector<std::size_t>& candidates) const
  {
    Fit fit;
    std::vector<PointLinePair> pairs;
    for (std::size_t sighting : candidates)
    {
      if (const std::optional<Eigen::Vector3d> tip = tip_Marker(sighting, latencySec))
      {
        const double pxPerMm = focalPx_ / sightings_[sighting].distanceMm;
        pairs.push_back({ *tip, Eigen::Vector3d::Zero(), sightings_[sighting].ray_Camera, pxPerMm * pxPerMm });
        fit.sightings.push_back(sighting);
      }
    }
    if (pairs.size() < 8)
    {
      return {};
    }
    Eigen::Isometry3d markerToCamera = markerToCamera_.value_or(Eigen::Isometry3d::Identity());
    if (!markerToCamera_)
    {
      const PointLineResult registration = registerPointsToLines(pairs);
      if (!registration.isUsable())
      {
        return {};
      }
      markerToCamera = registration.pointsToLines;
    }
    for (const PointLinePair& pair : pairs)
    {
      const Eigen::Vector3d moved_Camera = markerToCamera * pair.point_Points;
      fit.residualsPx.push_back(moved_Camera.cross(pair.direction_Lines).norm() * std::sqrt(pair.weight));
    }
    return fit;
  }

private:
  const std::vector<BallSighting>& sightings_;
  const PoseTrack& marker_;
  const PoseTrack& stylus_;
  Eigen::Vector3d tip_Stylus_;
  double focalPx_;
  std::optional<Eigen::Isometry3d> markerToCamera_;
};

Result concluded(Result result, Result::Status status, const std::string& message)
{
  result.status = status;
  result.message = message;
  return result;
}

/// Those that agree, at a latency that is nearly right.
std::vector<std::size_t> withoutOutliers(const Fit& fit)
{
  constexpr double RejectionFactor = 5;
  const double sigma = std::max(median(fit.residualsPx) / MedianOfChi2, 0.2);
  std::vector<std::size_t> good;
  for (std::size_t i = 0; i < fit.sightings.size(); ++i)
  {
    if (fit.residualsPx[i] < RejectionFactor * sigma)
    {
      good.push_back(fit.sightings[i]);
    }
  }
  return good;
}

/// The minimum and curvature of cost(x) = c0 + c1 x + c2 x^2 through the fine steps.
struct Parabola
{
  double minimumSec = 0, lowest = 0, curvature = 0;
};

Parabola parabolaThrough(const Eigen::VectorXd& offsetsSec, const Eigen::VectorXd& costs)
{
  Eigen::MatrixXd powers(offsetsSec.size(), 3);
  powers.col(0).setOnes();
  powers.col(1) = offsetsSec / FineStepSec;
  powers.col(2) = powers.col(1).cwiseAbs2();
  const Eigen::Vector3d c = powers.colPivHouseholderQr().solve(costs);
  Parabola parabola;
  parabola.curvature = c(2) / (FineStepSec * FineStepSec);
  parabola.minimumSec = -c(1) / (2 * c(2)) * FineStepSec;
  parabola.lowest = std::max(0.0, c(0) - c(1) * c(1) / (4 * c(2)));
  return parabola;
}

/// How many times larger the mean squared residual is a tenth of a second off. About once where the ball rests: noise alone gives
/// the cost a shape, since poses between two of the tracker's are averages with less noise.
double growthOf(const Problem& problem, double latencySec, const std::vector<std::size_t>& sightings)
{
  constexpr double AwaySec = 0.1;
  const double here = problem.fitAt(latencySec, sightings).meanSquare();
  const double earlier = problem.fitAt(latencySec - AwaySec, sightings).meanSquare();
  const double later = problem.fitAt(latencySec + AwaySec, sightings).meanSquare();
  return std::min(earlier, later) / std::max(here, 1e-12);
}

/// The same sightings at every fine step: those with poses on all of the way.
std::vector<std::size_t> trackedAround(const Problem& problem, double latencySec, const std::vector<std::size_t>& sightings)
{
  std::vector<std::size_t> tracked;
  for (std::size_t sighting : sightings)
  {
    bool isTracked = true;
    for (int step = -FineSteps - 2; step <= FineSteps + 2; ++step)
    {
      isTracked = isTracked && problem.tip_Marker(sighting, latencySec + step * FineStepSec).has_value();
    }
    if (isTracked)
    {
      tracked.push_back(sighting);
    }
  }
  return tracked;
}

/// The latency by two parabolas, one around the other's minimum, and its uncertainty; an infinite one where there is no minimum.
void refine(const Problem& problem, double coarseSec, const std::vector<std::size_t>& good, Result& result)
{
  double center = coarseSec;
  Parabola parabola;
  result.sigmaSec = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 2; ++round)
  {
    Eigen::VectorXd offsetsSec(2 * FineSteps + 1), costs(2 * FineSteps + 1);
    for (int step = -FineSteps; step <= FineSteps; ++step)
    {
      offsetsSec(step + FineSteps) = step * FineStepSec;
      costs(step + FineSteps) = problem.fitAt(center + step * FineStepSec, good).meanSquare();
    }
    parabola = parabolaThrough(offsetsSec, costs);
    if (!(parabola.curvature > 0) || !costs.allFinite())
    {
      return;
    }
    center += std::clamp(parabola.minimumSec, -2 * FineStepSec, 2 * FineStepSec);
  }
  const double count = double(good.size());
  const double varianceOfOne = parabola.lowest * count / (2 * count - 7);  // per axis of a residual, px^2
  result.latencySec = center;
  result.sigmaSec = std::sqrt(varianceOfOne / (parabola.curvature * count));
  result.rmsPx = std::sqrt(parabola.lowest);
  result.usedCount = int(good.size());
}

Result judged(const Result& result, double growth, const TemporalCalibrationOptions& options)
{
  constexpr double LeastGrowth = 2;
  if (!std::isfinite(result.sigmaSec) || growth < LeastGrowth)
  {
    return concluded(result, Result::Status::TooLittleMotion, "the ball did not move enough: other latencies fit nearly as well");
  }
  if (!(result.sigmaSec < options.maximumSigmaSec))
  {
    return concluded(result, Result::Status::TooLittleMotion,
      "the latency is known to " + inMs(result.sigmaSec, 1) + " only: move the ball faster, for longer, over more of the view");
  }
  if (result.rmsPx > options.maximumRmsPx)
  {
    return concluded(result, Result::Status::PoorFit,
      "video and tracker disagree by " + fixedDigits(result.rmsPx, 1) +
        " px whatever the latency: are camera, stylus and ball the right ones?");
  }
  return concluded(result, Result::Status::Ok,
    "the poses of a frame are those " + inMs(std::abs(result.latencySec), 1) + (result.latencySec < 0 ? " before" : " after") +
      " its time, +- " + inMs(result.sigmaSec, 1));
}

void checkInput(const std::vector<BallSighting>& sightings)
{
  for (std::size_t i = 0; i < sightings.size(); ++i)
  {
    const BallSighting& sighting = sightings[i];
    if (!std::isfinite(sighting.timeSec) || !sighting.ray_Camera.allFinite() || !(sighting.distanceMm > 0) ||
      !std::isfinite(sighting.distanceMm))
    {
      throw std::invalid_argument("sighting " + std::to_string(i) + ": finite numbers and a positive distance are expected");
    }
  }
}

/// The latency of the coarse steps with the smallest cost, and its fit; steps at which too many sightings have no poses do not
/// count.
std::pair<double, Fit> coarseMinimum(const Problem& problem, std::size_t count, const TemporalCalibrationOptions& options)
{
  std::vector<std::size_t> all(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    all[i] = i;
  }
  std::pair<double, Fit> best{ 0, {} };
  double lowest = std::numeric_limits<double>::infinity();
  const int steps = int(std::ceil(options.maximumLatencySec / CoarseStepSec));
  for (int step = -steps; step <= steps; ++step)
  {
    Fit fit = problem.fitAt(step * CoarseStepSec, all);
    // The median: a few wrong sightings must not choose.
    const double cost = fit.residualsPx.size() < std::size_t(options.minimumSightings) ? std::numeric_limits<double>::infinity()
                                                                                       : median(fit.residualsPx);
    if (cost < lowest)
    {
      lowest = cost;
      best = { step * CoarseStepSec, std::move(fit) };
    }
  }
  return best;
}

}  // namespace

void TemporalCalibrationOptions::check() const
{
  if (!(maximumLatencySec > 0) || minimumSightings < 10 || !(maximumSigmaSec > 0) || !(maximumRmsPx > 0))
  {
    throw std::invalid_argument("temporal calibration: positive limits and at least 10 sightings are expected");
  }
}

TemporalCalibrationResult calibrateLatency(const std::vector<BallSighting>& sightings, const PoseTrack& marker,
  const PoseTrack& stylus, const Eigen::Vector3d& tip_Stylus, const CameraModel& camera,
  const std::optional<Eigen::Isometry3d>& markerToCamera, const TemporalCalibrationOptions& options)
{
  options.check();
  checkInput(sightings);
  const Problem problem(sightings, marker, stylus, tip_Stylus, (camera.fx() + camera.fy()) / 2, markerToCamera);
  Result result;
  const auto [coarseSec, fit] = coarseMinimum(problem, sightings.size(), options);
  if (fit.residualsPx.empty())
  {
    return concluded(result, Result::Status::TooFewSightings,
      "at least " + std::to_string(options.minimumSightings) +
        " frames in which the ball is found and both tools are tracked are needed; there are " + std::to_string(sightings.size()) +
        " with the ball");
  }
  if (std::abs(coarseSec) > options.maximumLatencySec - CoarseStepSec / 2)
  {
    return concluded(result, Result::Status::AtLimit,
      "the latency is beyond " + inMs(options.maximumLatencySec, 0) + ", or the ball did not move: it was looked for no further");
  }
  const std::vector<std::size_t> agreeing = withoutOutliers(fit);
  const std::vector<std::size_t> good = trackedAround(problem, coarseSec, agreeing);
  result.rejectedCount = int(fit.sightings.size() - agreeing.size());
  if (int(good.size()) < options.minimumSightings)
  {
    return concluded(result, Result::Status::TooFewSightings,
      std::to_string(good.size()) + " frames agree and are tracked; at least " + std::to_string(options.minimumSightings) +
        " are needed");
  }
  refine(problem, coarseSec, good, result);
  return judged(result, growthOf(problem, result.latencySec, good), options);
}

std::string toString(TemporalCalibrationResult::Status status)
{
  switch (status)
  {
    case Result::Status::Ok:
      return "ok";
    case Result::Status::TooFewSightings:
      return "too_few_sightings";
    case Result::Status::AtLimit:
      return "at_limit";
    case Result::Status::TooLittleMotion:
      return "too_little_motion";
    case Result::Status::PoorFit:
      return "poor_fit";
  }
  return "too_few_sightings";
}

}  // namespace handeye
