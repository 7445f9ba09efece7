// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeUncertainty.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace handeye
{

namespace
{

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Tips that are closer than this are one place of the ball.
constexpr double SamePlaceMm = 2;
/// From the first of these multiples of the expected scatter on (more where few samples make chance larger), a misfit is taken to
/// be systematic; this much further on wholly.
constexpr double RandomMisfit = 1.25;
constexpr double ToSystematicMisfit = 0.75;
/// So many standard deviations above the expected scatter one capture in a hundred and one in a thousand scatter by chance.
constexpr double OneInHundred = 2.33;
constexpr double OneInThousand = 3.09;

/// What the solution's normal equations inherit from errors that several samples share.
struct Shared
{
  std::map<int, Eigen::Matrix<double, 6, 3>> byTracking;                      ///< of a place
  std::map<std::pair<int, int>, Eigen::Matrix<double, 6, 2>> bySegmentation;  ///< of a place and an eye
  Eigen::Matrix<double, 6, 3> byTip = Eigen::Matrix<double, 6, 3>::Zero();    ///< of all
};

template<typename Map, typename Matrix> void addTo(Map& map, const typename Map::key_type& key, const Matrix& matrix)
{
  const auto inserted = map.try_emplace(key, matrix);
  if (!inserted.second)
  {
    inserted.first->second += matrix;
  }
}

Matrix6 sandwich(const Matrix6& normal, const Shared& shared, const HandEyeCalibrationOptions& options)
{
  Matrix6 scatter = shared.byTip * options.tipCovariance_Stylus * shared.byTip.transpose();
  for (const auto& place : shared.byTracking)
  {
    scatter += options.trackingSigmaMm * options.trackingSigmaMm * place.second * place.second.transpose();
  }
  for (const auto& seen : shared.bySegmentation)
  {
    scatter += seen.second * seen.second.transpose();
  }
  const Matrix6 inverse = normal.inverse();
  const Matrix6 covariance = inverse * scatter * inverse;
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

std::vector<int> usedIndices(const HandEyeCalibrationResult& result)
{
  std::vector<int> used;
  for (std::size_t i = 0; i < result.samples.size(); ++i)
  {
    if (result.samples[i].used)
    {
      used.push_back(int(i));
    }
  }
  return used;
}

std::vector<int> placesOf(const HandEyeSamples& samples, const std::vector<int>& used)
{
  std::vector<int> places(samples.size(), -1);
  for (int i : used)
  {
    const auto isHere = [&](int k)
    {
      const bool isFirst = k == i || places[std::size_t(k)] == k;
      return isFirst && (samples[std::size_t(k)].tip_Marker - samples[std::size_t(i)].tip_Marker).norm() < SamePlaceMm;
    };
    places[std::size_t(i)] = *std::find_if(used.begin(), used.end(), isHere);
  }
  return places;
}

Eigen::Matrix2d weightOf(
  const HandEyeTerm& term, double distance, const CameraModel& camera, const HandEyeCalibrationOptions& options)
{
  const double mmPerPx = std::max(distance, 1.0) / focalLength(camera);
  switch (options.method)
  {
    case PointLineOptions::Method::MaximumLikelihood:
      return term.covariancePx.inverse();
    case PointLineOptions::Method::Global:
      return Eigen::Matrix2d::Identity() /
        (term.sigmaPx * term.sigmaPx + options.trackingSigmaMm * options.trackingSigmaMm / (mmPerPx * mmPerPx));
    default:
      return mmPerPx * mmPerPx * Eigen::Matrix2d::Identity();
  }
}

double estimateCovariance(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  const std::vector<int> used = usedIndices(result);
  const std::vector<int> places = placesOf(samples, used);
  std::map<std::pair<int, int>, int> looks;
  for (int i : used)
  {
    ++looks[{ places[std::size_t(i)], samples[std::size_t(i)].eye }];
  }
  Matrix6 normal = Matrix6::Zero();
  Shared shared;
  double squares = 0;
  for (int i : used)
  {
    const HandEyeSample& sample = samples[std::size_t(i)];
    const std::optional<HandEyeTerm> term = handEyeTerm(sample, eyes, result.markerToCamera, options);
    const std::pair<int, int> look{ places[std::size_t(i)], sample.eye };
    if (!term)
    {
      squares += 1e6;
      continue;
    }
    squares += term->residualPx.dot(term->covariancePx.inverse() * term->residualPx) / looks[look];
    const double distance = distanceMm(sample, eyes, result.markerToCamera);
    const Eigen::Matrix2d weight = weightOf(*term, distance, eyes[std::size_t(sample.eye)].camera, options);
    const Eigen::Matrix<double, 6, 2> weighted = term->byPose.transpose() * weight;
    normal += weighted * term->byPose;
    const Eigen::Matrix<double, 6, 3> byTip_Camera = weighted * term->byPoint;
    const Eigen::Matrix3d stylusToCamera = result.markerToCamera.linear() * sample.stylusToMarker;
    addTo(shared.byTracking, look.first, byTip_Camera);
    addTo(shared.bySegmentation, look, Eigen::Matrix<double, 6, 2>(term->sigmaPx * weighted));
    shared.byTip += byTip_Camera * stylusToCamera;
  }
  const double freedoms = std::max(1.0, 2.0 * double(looks.size()) - 6);
  const double misfit = std::sqrt(squares / freedoms);
  const double deviation = 1 / std::sqrt(2 * freedoms);
  const double random = std::max(RandomMisfit, 1 + OneInThousand * deviation);
  const double systematic = std::clamp((misfit - random) / ToSystematicMisfit, 0.0, 1.0);
  const bool isClearlyMore = misfit > 1 + OneInHundred * deviation;
  result.placeCount = int(shared.byTracking.size());
  const double varianceFactor = (isClearlyMore ? misfit * misfit : 1) * (1 + systematic * (result.placeCount - 1));
  result.covariance = varianceFactor * sandwich(normal, shared, options);
  return misfit;
}

}  // namespace handeye
