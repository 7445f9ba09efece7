// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineRegistration.h"

#include "NumberWords.h"
#include "PointLineMethods.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

using Status = PointLineResult::Status;
using Method = PointLineOptions::Method;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t MinimumPairs = 4;
/// The information matrix of observable data is better conditioned than this.
constexpr double WorstCondition = 1e12;

/// Sums up  w motion^T V motion  with motion = [-skew(arm), I].
void addInformation(const PointLinePair& pair, const Eigen::Vector3d& arm, Matrix6& information)
{
  const Eigen::Vector3d& d = pair.direction_Lines;
  const double scale = pair.weight / d.squaredNorm();
  Eigen::Matrix3d across = -scale * d * d.transpose();
  across.diagonal().array() += pair.weight;
  const Eigen::Matrix3d turned = skew(arm) * across;
  information.topLeftCorner<3, 3>() -= turned * skew(arm);
  information.topRightCorner<3, 3>() += turned;
  information.bottomRightCorner<3, 3>() += across;
}

/// The same about another point: arm -> arm + shift.
Matrix6 shifted(const Matrix6& information, const Eigen::Vector3d& shift)
{
  Matrix6 motion = Matrix6::Identity();
  motion.bottomLeftCorner<3, 3>() = -skew(shift);
  return motion.transpose() * information * motion;
}

std::string inWords(const Eigen::Vector3d& direction)
{
  const Eigen::Vector3d unit = direction.normalized();
  std::string text = "(";
  for (int i = 0; i < 3; ++i)
  {
    const double rounded = std::round(100 * unit(i)) / 100 + 0.0;
    text += (i > 0 ? ", " : "") + std::to_string(rounded).substr(0, rounded < 0 ? 5 : 4);
  }
  return text + ")";
}

/// A freedom that nothing fixes makes the result unusable; also where it shows as any number of equal minima, it is the better
/// reason to give.
void reportFreedom(const Eigen::Matrix<double, 6, 1>& freedom, PointLineResult& result)
{
  result.status = Status::NotObservable;
  result.message = freedom.head<3>().norm() > freedom.tail<3>().norm()
    ? "a rotation is not determined, that about the axis " + inWords(freedom.head<3>()) +
      " of the lines' frame: the points lie on one line or in one place"
    : "a translation is not determined, that along " + inWords(freedom.tail<3>()) + " of the lines' frame: the lines are parallel";
}

/// What the data determine.
void measure(const PointLineQuadraticForm& form, PointLineResult& result)
{
  Matrix6 centred = form.centredInformation(result.pointsToLines.linear());
  result.information = shifted(centred, result.pointsToLines.linear() * form.centroid_Points());
  // Turn about the centroid, by the spread as the unit of length, so that the six numbers are comparable.
  const double length = std::max({ form.spread(), 1e-9 * form.centroid_Points().norm(), 1e-150 });
  centred.topRows<3>() /= length;
  centred.leftCols<3>() /= length;
  const Eigen::SelfAdjointEigenSolver<Matrix6> spectrum(centred, Eigen::EigenvaluesOnly);
  const double lowest = std::max(spectrum.eigenvalues()(0), 0.0), highest = spectrum.eigenvalues()(5);
  result.conditionNumber = lowest > 0 ? highest / lowest : std::numeric_limits<double>::infinity();
  result.rank = int((spectrum.eigenvalues().array() > highest / WorstCondition).count());
  if (!(result.conditionNumber < WorstCondition) && (result.status == Status::Ok || result.status == Status::Ambiguous))
  {
    reportFreedom(Eigen::SelfAdjointEigenSolver<Matrix6>(centred).eigenvectors().col(0), result);
  }
}

bool isCovariance(const Eigen::Matrix3d& matrix)
{
  if (!matrix.allFinite() || (matrix - matrix.transpose()).norm() > 1e-9 * matrix.norm())
  {
    return false;
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()(0) >= -1e-9 * matrix.norm();
}

void checkNoise(const PointLinePairs& pairs, const std::vector<PointLineNoise>& noise)
{
  if (!noise.empty() && noise.size() != pairs.size())
  {
    throw std::invalid_argument("point and line " + std::to_string(std::min(pairs.size(), noise.size()) + 1) + ": " +
      std::to_string(pairs.size()) + " pairs but " + std::to_string(noise.size()) + " covariances, one each or none are expected");
  }
  for (std::size_t i = 0; i < noise.size(); ++i)
  {
    if (!isCovariance(noise[i].point_Points) || !isCovariance(noise[i].direction_Lines))
    {
      throw std::invalid_argument("point and line " + std::to_string(i + 1) +
        ": symmetric covariances of finite numbers and without negative eigenvalues are expected");
    }
  }
}

void solve(
  const PointLinePairs& pairs, const PointLineQuadraticForm& form, const PointLineOptions& options, PointLineResult& result)
{
  switch (options.method)
  {
    case Method::Global:
    case Method::MaximumLikelihood:
      return solveGlobal(pairs, form, options, result);
    case Method::Procrustes:
      return solveProcrustes(pairs, options, result);
    case Method::OrthogonalIteration:
      return solveOrthogonalIteration(pairs, options, result);
    case Method::ProcrustesPnP:
      return solveProcrustesPnP(pairs, options, result);
    case Method::Epnp:
    case Method::Sqpnp:
    case Method::Iterative:
      return solveByOpenCV(pairs, options, result);
  }
}

PointLineResult registerWhatAgrees(
  const PointLinePairs& pairs, const std::vector<PointLineNoise>& noise, const PointLineOptions& options)
{
  const std::vector<int> kept = findAgreeingPairs(pairs, options);
  PointLineOptions plain = options;
  plain.rejectOutliers = false;
  PointLinePairs subset;
  std::vector<PointLineNoise> subsetNoise;
  for (int i : kept)
  {
    subset.push_back(pairs[std::size_t(i)]);
    if (!noise.empty())
    {
      subsetNoise.push_back(noise[std::size_t(i)]);
    }
  }
  PointLineResult result = registerPointsToLines(subset, subsetNoise, plain);
  result.residualsMm.clear();
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    result.residualsMm.push_back(offsetFromLine(pairs[i], result.pointsToLines).norm());
    if (!std::binary_search(kept.begin(), kept.end(), int(i)))
    {
      result.rejected.push_back(int(i));
    }
  }
  if (!result.rejected.empty() && result.isUsable())
  {
    result.message = "registered " + std::to_string(kept.size()) + " of " + std::to_string(pairs.size()) +
      " points, the others disagree with them";
  }
  return result;
}

}  // namespace

void PointLineOptions::check() const
{
  if (maximumIterations < 1 || !(tolerance > 0))
  {
    throw std::invalid_argument("point-to-line options: a positive tolerance and at least one iteration are expected");
  }
  if (!(sigmaMm >= 0) || !(sigmaRad >= 0) || !std::isfinite(sigmaMm + sigmaRad) || !(robustFactor > 1) || !(maximumMisfit >= 0) ||
    !(maximumRelativeRms > 0))
  {
    throw std::invalid_argument("point-to-line options: noise of at least 0 and a robust factor above 1 are expected");
  }
  if (sigmaRad > 0 && !linesAreRays)
  {
    throw std::invalid_argument("point-to-line options: noise of directions (rad) acts from the origins of rays; for lines give "
                                "that of the points (mm) alone");
  }
}

PointLineResult registerPointsToLines(const PointLinePairs& pairs, const PointLineOptions& options)
{
  return registerPointsToLines(pairs, {}, options);
}

PointLineResult registerPointsToLines(
  const PointLinePairs& pairs, const std::vector<PointLineNoise>& noise, const PointLineOptions& options)
{
  options.check();
  const PointLineSums sums = sumPairs(pairs);
  checkNoise(pairs, noise);
  PointLineResult result;
  if (pairs.size() < MinimumPairs)
  {
    if (pairs.size() + 1 == MinimumPairs)
    {
      PointLineResult candidates;
      solveGlobal(pairs, PointLineQuadraticForm(pairs, sums), options, candidates);
      result.solutions = candidates.status == Status::Ok ? std::vector<Eigen::Isometry3d>{ candidates.pointsToLines }
                                                         : std::move(candidates.solutions);
    }
    result.message =
      "only " + std::to_string(pairs.size()) + " points with a line, at least " + std::to_string(MinimumPairs) + " are needed";
    return result;
  }
  if (options.rejectOutliers)
  {
    return registerWhatAgrees(pairs, noise, options);
  }
  const PointLineQuadraticForm form(pairs, sums);
  solve(pairs, form, options, result);
  if (result.status == Status::NotObservable || result.status == Status::NotApplicable)
  {
    return result;
  }
  if (result.residualsMm.empty())
  {
    measureResiduals(pairs, form, result);
  }
  measure(form, result);
  if (result.isUsable() && options.method == Method::MaximumLikelihood)
  {
    solveMaximumLikelihood(pairs, noise, options, result);
    measureResiduals(pairs, form, result);
    measure(form, result);
  }
  if (result.isUsable() && result.rmsMm > options.maximumRelativeRms * form.spread() && result.rmsMm > 0)
  {
    result.status = Status::PoorFit;
    result.message = "points and lines do not belong together: the best solution misses the lines by " +
      significantDigits(result.rmsMm, 3) + " mm (RMS), the points' spread being " + significantDigits(form.spread(), 3) + " mm";
  }
  if (result.isUsable())
  {
    result.message = "registered " + std::to_string(pairs.size()) + " points";
  }
  return result;
}

Matrix6 informationMatrix(const PointLinePairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  Matrix6 information = Matrix6::Zero();
  for (const PointLinePair& pair : pairs)
  {
    addInformation(pair, pointsToLines.linear() * pair.point_Points, information);
  }
  information.bottomLeftCorner<3, 3>() = information.topRightCorner<3, 3>().transpose();
  return information;
}

std::size_t measureResiduals(const PointLinePairs& pairs, const PointLineQuadraticForm& form, PointLineResult& result)
{
  result.residualsMm.resize(pairs.size());
  const PointLineDistances distances = measureDistances(pairs, result.pointsToLines, form.hasCommonOrigin(), result.residualsMm);
  result.rmsMm = std::sqrt(distances.squaresMm2 / double(pairs.size()));
  return distances.inFront;
}

Eigen::Vector3d offsetFromLine(const PointLinePair& pair, const Eigen::Isometry3d& pointsToLines)
{
  const Eigen::Vector3d offset = pointsToLines * pair.point_Points - pair.origin_Lines;
  const Eigen::Vector3d& d = pair.direction_Lines;
  return offset - d * (d.dot(offset) / d.squaredNorm());
}

bool areMostInFront(const PointLinePairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  std::size_t inFront = 0;
  for (std::size_t i = 0; i < pairs.size() && 2 * inFront <= pairs.size(); ++i)
  {
    const PointLinePair& pair = pairs[i];
    inFront += pair.direction_Lines.dot(pointsToLines * pair.point_Points - pair.origin_Lines) > 0 ? 1 : 0;
  }
  return 2 * inFront > pairs.size();
}

bool haveOneCentre(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  const bool oneCentre = std::all_of(
    pairs.begin(), pairs.end(), [&](const PointLinePair& pair) { return pair.origin_Lines == pairs.front().origin_Lines; });
  if (!oneCentre)
  {
    result.status = Status::NotApplicable;
    result.message = toString(options.method) +
      " needs lines that all begin at one centre, those of one camera: use ml, global, procrustes or oi for others";
  }
  return oneCentre;
}

std::string toString(Method method)
{
  switch (method)
  {
    case Method::Global:
      return "global";
    case Method::Procrustes:
      return "procrustes";
    case Method::MaximumLikelihood:
      return "ml";
    case Method::OrthogonalIteration:
      return "oi";
    case Method::ProcrustesPnP:
      return "ppnp";
    case Method::Epnp:
      return "epnp";
    case Method::Sqpnp:
      return "sqpnp";
    case Method::Iterative:
      return "iterative";
  }
  return "unknown";
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewPairs:
      return "too_few_pairs";
    case Status::NotObservable:
      return "not_observable";
    case Status::NotConverged:
      return "not_converged";
    case Status::Mirrored:
      return "mirrored";
    case Status::Ambiguous:
      return "ambiguous";
    case Status::PoorFit:
      return "poor_fit";
    case Status::NotApplicable:
      return "not_applicable";
  }
  return "unknown";
}

}  // namespace handeye
