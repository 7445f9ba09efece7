// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TemporalCalibration.h"

#include "NumberWords.h"
#include "PointLineRegistration.h"
#include "Statistics.h"
#include "TipTrack.h"

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
  std::vector<double> averagedPx2;  ///< by how much interpolation has lowered what the tracker's noise does to a squared residual
  std::vector<std::size_t> sightings;

  double meanSquare() const
  {
    return meanOf([&](std::size_t i) { return residualsPx[i] * residualsPx[i]; });
  }

  /// As if every pose had been measured at its moment.
  double comparableMeanSquare() const
  {
    return meanOf([&](std::size_t i) { return residualsPx[i] * residualsPx[i] + averagedPx2[i]; });
  }

private:
  template<typename Term> double meanOf(Term term) const
  {
    double sum = 0;
    for (std::size_t i = 0; i < residualsPx.size(); ++i)
    {
      sum += term(i);
    }
    return residualsPx.empty() ? std::numeric_limits<double>::infinity() : sum / double(residualsPx.size());
  }
};

class Problem
{
public:
  Problem(const std::vector<BallSighting>& sightings, const TipTrack& tips, double focalPx,
    const std::optional<Eigen::Isometry3d>& markerToCamera)
    : sightings_(sightings)
    , tips_(tips)
    , focalPx_(focalPx)
    , markerToCamera_(markerToCamera)
  {
  }

  std::optional<TipTrack::Place> place(std::size_t sighting, double latencySec) const
  {
    return tips_.at(sightings_[sighting].timeSec + latencySec);
  }

  Fit fitAt(double latencySec, const std::vector<std::size_t>& candidates) const
  {
    Fit fit;
    std::vector<PointLinePair> pairs;
    for (std::size_t sighting : candidates)
    {
      if (const std::optional<TipTrack::Place> tip = place(sighting, latencySec))
      {
        const double pxPerMm = focalPx_ / sightings_[sighting].distanceMm;
        const double noisePx = tips_.noiseMm() * pxPerMm;
        pairs.push_back({ tip->tip_Marker, Eigen::Vector3d::Zero(), sightings_[sighting].ray_Camera, pxPerMm * pxPerMm });
        fit.averagedPx2.push_back(2 * noisePx * noisePx * (1 - tip->noiseShare));  // across the ray there are two axes
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
  const TipTrack& tips_;
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

/// The minimum and curvature of cost(x) = c0 + c1 x + c2 x^2 through the fine steps; from their middle, or as a latency.
struct Parabola
{
  double minimumSec = 0, curvature = 0;
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
  return parabola;
}

/// How many times larger the mean squared residual is a tenth of a second off. About once where the ball rests.
double growthOf(const Problem& problem, double latencySec, const std::vector<std::size_t>& sightings)
{
  constexpr double AwaySec = 0.1;
  const double here = problem.fitAt(latencySec, sightings).comparableMeanSquare();
  const double earlier = problem.fitAt(latencySec - AwaySec, sightings).comparableMeanSquare();
  const double later = problem.fitAt(latencySec + AwaySec, sightings).comparableMeanSquare();
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
      isTracked = isTracked && problem.place(sighting, latencySec + step * FineStepSec).has_value();
    }
    if (isTracked)
    {
      tracked.push_back(sighting);
    }
  }
  return tracked;
}

/// The parabola around the minimum near a latency, by another around the first one's; nothing where there is no minimum.
std::optional<Parabola> parabolaNear(const Problem& problem, double startSec, const std::vector<std::size_t>& sightings)
{
  double centerSec = startSec;
  Parabola parabola;
  for (int round = 0; round < 2; ++round)
  {
    Eigen::VectorXd offsetsSec(2 * FineSteps + 1), costs(2 * FineSteps + 1);
    for (int step = -FineSteps; step <= FineSteps; ++step)
    {
      offsetsSec(step + FineSteps) = step * FineStepSec;
      costs(step + FineSteps) = problem.fitAt(centerSec + step * FineStepSec, sightings).comparableMeanSquare();
    }
    parabola = parabolaThrough(offsetsSec, costs);
    if (!(parabola.curvature > 0) || !costs.allFinite())
    {
      return std::nullopt;
    }
    centerSec += std::clamp(parabola.minimumSec, -2 * FineStepSec, 2 * FineStepSec);
  }
  parabola.minimumSec = centerSec;
  return parabola;
}

/// How much the minimum moves when a part of the recording is left out (delete-a-group jackknife): what is wrong for a while, such as
/// poses interpolated over a fast turn, is in it, and noise that repeats from frame to frame. Infinite where a part alone
/// decides.
double jackknifeSec(const Problem& problem, double latencySec, const std::vector<std::size_t>& sightings)
{
  constexpr std::size_t Groups = 8;
  std::vector<double> minimaSec;
  for (std::size_t group = 0; group < Groups; ++group)
  {
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < sightings.size(); ++i)
    {
      if (i * Groups / sightings.size() != group)
      {
        rest.push_back(sightings[i]);
      }
    }
    const std::optional<Parabola> parabola = parabolaNear(problem, latencySec, rest);
    if (!parabola)
    {
      return std::numeric_limits<double>::infinity();
    }
    minimaSec.push_back(parabola->minimumSec);
  }
  const double average = summarize(minimaSec).mean;
  double squares = 0;
  for (double minimumSec : minimaSec)
  {
    squares += (minimumSec - average) * (minimumSec - average);
  }
  return std::sqrt(squares * double(Groups - 1) / double(Groups));
}

/// The latency and its uncertainty; an infinite one where there is no minimum.
void refine(const Problem& problem, double coarseSec, const std::vector<std::size_t>& good, Result& result)
{
  result.sigmaSec = std::numeric_limits<double>::infinity();
  const std::optional<Parabola> parabola = parabolaNear(problem, coarseSec, good);
  if (!parabola)
  {
    return;
  }
  // What is there, not what the parabola has at its lowest: between poses that are far apart the cost is no parabola.
  const double meanSquare = problem.fitAt(parabola->minimumSec, good).meanSquare();
  const double count = double(good.size());
  const double varianceOfOne = meanSquare * count / (2 * count - 7);  // per axis of a residual, px^2
  result.latencySec = parabola->minimumSec;
  result.sigmaSec =
    std::max(std::sqrt(varianceOfOne / (parabola->curvature * count)), jackknifeSec(problem, parabola->minimumSec, good));
  result.rmsPx = std::sqrt(meanSquare);
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
  const TipTrack tips(marker, stylus, tip_Stylus);
  const Problem problem(sightings, tips, (camera.fx() + camera.fy()) / 2, markerToCamera);
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
