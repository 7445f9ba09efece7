// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkRegistration.h"

#include "LandmarkFit.h"
#include "NumberWords.h"
#include "RigidTransform.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace handeye
{

namespace
{

using Points = std::vector<Eigen::Vector3d>;
using Status = LandmarkRegistrationResult::Status;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;

/// A mirrored fit that is better than the proper one by this factor gives a mirror image away.
constexpr double MirrorFactor = 4;
/// Another order fits about as well as the given one if its residuals are less than this multiple of it, or this much (mm)
/// above it.
constexpr double AlikeFactor = 1.5;
constexpr double AlikeMm = 0.3;

Eigen::Matrix3Xd toMatrix(const Points& points)
{
  Eigen::Matrix3Xd matrix(3, Eigen::Index(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!points[i].allFinite())
    {
      throw std::invalid_argument("landmark " + std::to_string(i + 1) + " is not finite");
    }
    matrix.col(Eigen::Index(i)) = points[i];
  }
  return matrix;
}

Eigen::VectorXd toWeights(const LandmarkRegistrationOptions& options, Eigen::Index count)
{
  return options.weights.empty() ? Eigen::VectorXd(Eigen::VectorXd::Ones(count))
                                 : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(options.weights.data(), count));
}

/// The root mean square distance that is left when the model may be mirrored as well.
double mirroredRms(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, const Eigen::VectorXd& weights)
{
  Eigen::Matrix3Xd mirrored = model;
  mirrored.row(0) *= -1;
  return fitLandmarks(mirrored, phantom, weights).rmsMm;
}

Eigen::Matrix3Xd without(const Eigen::Matrix3Xd& points, Eigen::Index left)
{
  Eigen::Matrix3Xd rest(3, points.cols() - 1);
  rest << points.leftCols(left), points.rightCols(points.cols() - 1 - left);
  return rest;
}

void leaveOutEach(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, const Eigen::VectorXd& weights,
  LandmarkRegistrationResult& result)
{
  if (model.cols() < 4)
  {
    return;
  }
  for (Eigen::Index left = 0; left < model.cols(); ++left)
  {
    Eigen::VectorXd rest(weights.size() - 1);
    rest << weights.head(left), weights.tail(weights.size() - 1 - left);
    const LandmarkFit fit = fitLandmarks(without(model, left), without(phantom, left), rest);
    result.leftOut.push_back({ fit.rmsMm, (fit.modelToPhantom * model.col(left) - phantom.col(left)).norm() });
  }
  const auto least = std::min_element(result.leftOut.begin(), result.leftOut.end(),
    [](const LandmarkLeftOut& a, const LandmarkLeftOut& b) { return a.rmsMm < b.rmsMm; });
  result.worst = int(least - result.leftOut.begin());
}

/// How a point of the model moves with the six parameters: rotation (rad) about the landmarks' middle, then translation.
Matrix36d motionOf(const Eigen::Vector3d& lever_Phantom)
{
  Matrix36d motion;
  motion << -skew(lever_Phantom), Eigen::Matrix3d::Identity();
  return motion;
}

/// Fitzpatrick and West: how far off the registration is at the landmarks and the targets.
void predictErrors(const Eigen::Matrix3Xd& model, const Eigen::VectorXd& weights, const LandmarkRegistrationOptions& options,
  LandmarkRegistrationResult& result)
{
  const Eigen::Vector3d middle_Model = model.rowwise().mean();
  const auto motionAt = [&](const Eigen::Vector3d& point_Model)
  { return motionOf(result.modelToPhantom.linear() * (point_Model - middle_Model)); };
  Matrix6d normal = Matrix6d::Zero();
  double squares = 0;
  for (Eigen::Index i = 0; i < model.cols(); ++i)
  {
    const Matrix36d motion = motionAt(model.col(i));
    normal += weights(i) * (motion.transpose() * motion);
    squares += weights(i) * result.residualsMm[std::size_t(i)] * result.residualsMm[std::size_t(i)];
  }
  // 3 n residuals less 6 unknowns, three to a point: FLE^2 = FRE^2 n / (n - 2).
  const double estimated = std::sqrt(squares / (double(model.cols()) - 2));
  result.localizationErrorMm = options.localizationErrorMm > 0 ? options.localizationErrorMm : estimated;
  const Matrix6d covariance = result.localizationErrorMm * result.localizationErrorMm / 3 * Matrix6d(normal.inverse());
  const auto predict = [&](const Eigen::Vector3d& point_Model)
  {
    const Matrix36d motion = motionAt(point_Model);
    const Matrix36d spread = motion * covariance;
    return std::sqrt((spread * motion.transpose()).trace());
  };
  for (Eigen::Index i = 0; i < model.cols(); ++i)
  {
    result.landmarkTreMm.push_back(predict(model.col(i)));
  }
  for (const Eigen::Vector3d& target_Model : options.targets_Model)
  {
    result.targetTreMm.push_back(predict(target_Model));
  }
}

std::string inWords(const std::vector<int>& order)
{
  std::string words;
  for (int touched : order)
  {
    words += (words.empty() ? "" : ", ") + std::to_string(touched + 1);
  }
  return words;
}

/// What is wrong: the order, the side, one landmark, or the whole.
void explainPoorFit(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, const Eigen::VectorXd& weights,
  const LandmarkRegistrationOptions& options, LandmarkRegistrationResult& result)
{
  const bool isMirrored = model.cols() > 3 && mirroredRms(model, phantom, weights) * MirrorFactor < result.rmsMm;
  const std::string misfit = "the landmarks differ by " + fixedDigits(result.rmsMm, 1) + " mm (RMS), more than the " +
    fixedDigits(options.largestRmsMm, 1) + " mm of a usable registration: ";
  const std::vector<LandmarkOrder> orders = model.cols() <= options.largestReorderedCount
    ? findOrders(model, phantom, std::min(options.largestRmsMm, result.rmsMm))
    : std::vector<LandmarkOrder>();
  if (!orders.empty())
  {
    result.status = Status::WrongOrder;
    result.suggestedOrder = orders[0].order;
    result.suggestedRmsMm = orders[0].rmsMm;
    result.message = misfit + "they were touched in another order; taken in the order " + inWords(orders[0].order) +
      " they fit with " + fixedDigits(orders[0].rmsMm, 2) + " mm";
    result.suggestionIsUnique = orders.size() < 2 || orders[1].rmsMm > AlikeFactor * orders[0].rmsMm + AlikeMm;
    if (!result.suggestionIsUnique)
    {
      result.message += ", and in the order " + inWords(orders[1].order) + " with " + fixedDigits(orders[1].rmsMm, 2) +
        " mm: they are too symmetric to tell";
    }
    result.message += isMirrored ? " (or the model is a mirror image)" : "";
    return;
  }
  if (isMirrored)
  {
    result.status = Status::Mirrored;
    result.message = "the touched points are the mirror image of the model's: check their order and the model's side";
    return;
  }
  result.status = Status::PoorFit;
  const bool oneIsWrong = model.cols() > 4 && result.leftOut[std::size_t(result.worst)].rmsMm <= options.largestRmsMm;
  result.message = misfit +
    (oneIsWrong ? "touch landmark " + std::to_string(result.worst + 1) + " again, without it " +
          fixedDigits(result.leftOut[std::size_t(result.worst)].rmsMm, 1) + " mm are left"
                : "check their order and that both lists are in mm");
}

/// Of a good fit: whether another order would fit as well, and which landmark is the worst.
std::string describeGoodFit(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom,
  const LandmarkRegistrationOptions& options, LandmarkRegistrationResult& result)
{
  std::string text = "registered " + std::to_string(model.cols()) + " landmarks with " + fixedDigits(result.rmsMm, 2) + " mm RMS";
  if (result.worst >= 0)
  {
    text += "; without landmark " + std::to_string(result.worst + 1) + ", the worst, " +
      fixedDigits(result.leftOut[std::size_t(result.worst)].rmsMm, 2) + " mm";
  }
  if (model.cols() <= options.largestReorderedCount)
  {
    const std::vector<LandmarkOrder> orders =
      findOrders(model, phantom, std::min(options.largestRmsMm, AlikeFactor * result.rmsMm + AlikeMm));
    if (!orders.empty())
    {
      result.suggestedOrder = orders[0].order;
      result.suggestedRmsMm = orders[0].rmsMm;
      text += "; in the order " + inWords(orders[0].order) + " they fit with " + fixedDigits(orders[0].rmsMm, 2) +
        (2 * orders[0].rmsMm < result.rmsMm ? " mm: were they touched in that order?"
                                            : " mm: they are too symmetric for the order to be checked");
    }
  }
  return text;
}

}  // namespace

void LandmarkRegistrationOptions::check(std::size_t count) const
{
  if (!weights.empty() && weights.size() != count)
  {
    throw std::invalid_argument(
      "there are " + std::to_string(weights.size()) + " weights for " + std::to_string(count) + " landmarks: one each is expected");
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    if (!(weights[i] > 0 && std::isfinite(weights[i])))
    {
      throw std::invalid_argument("the weight of landmark " + std::to_string(i + 1) + " is not a positive number");
    }
  }
  for (std::size_t i = 0; i < targets_Model.size(); ++i)
  {
    if (!targets_Model[i].allFinite())
    {
      throw std::invalid_argument("target " + std::to_string(i + 1) + " is not finite");
    }
  }
  if (!(localizationErrorMm >= 0 && std::isfinite(localizationErrorMm)) || !(largestRmsMm > 0))
  {
    throw std::invalid_argument(
      "landmark registration options: a positive limit and an error (mm) that is not negative are expected");
  }
}

LandmarkRegistrationResult registerLandmarks(
  const Points& points_Model, const Points& points_Phantom, const LandmarkRegistrationOptions& options)
{
  if (points_Model.size() != points_Phantom.size())
  {
    throw std::invalid_argument("the model has " + std::to_string(points_Model.size()) + " landmarks, " +
      std::to_string(points_Phantom.size()) + " were touched: the same number in the same order is expected");
  }
  options.check(points_Model.size());
  LandmarkRegistrationResult result;
  const Eigen::Matrix3Xd model = toMatrix(points_Model), phantom = toMatrix(points_Phantom);
  if (points_Model.size() < 3)
  {
    result.message = "only " + std::to_string(points_Model.size()) + " landmarks, at least 3 are needed (6 are recommended)";
    return result;
  }
  if (areCollinear(model) || areCollinear(phantom))
  {
    result.status = Status::Collinear;
    result.message = "the landmarks lie on one line or in one place: nothing fixes the rotation about it";
    return result;
  }
  const Eigen::VectorXd weights = toWeights(options, model.cols());
  const LandmarkFit fit = fitLandmarks(model, phantom, weights);
  result.modelToPhantom = fit.modelToPhantom;
  for (std::size_t i = 0; i < points_Model.size(); ++i)
  {
    result.residualsMm.push_back((result.modelToPhantom * points_Model[i] - points_Phantom[i]).norm());
  }
  result.rmsMm = summarize(result.residualsMm).rms;
  leaveOutEach(model, phantom, weights, result);
  if (!(result.rmsMm <= options.largestRmsMm))
  {
    explainPoorFit(model, phantom, weights, options, result);
    return result;
  }
  predictErrors(model, weights, options, result);
  result.status = Status::Ok;
  result.message = describeGoodFit(model, phantom, options, result);
  return result;
}

Points reordered(const Points& points_Phantom, const std::vector<int>& order)
{
  std::vector<int> sorted = order, all(points_Phantom.size());
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  if (sorted != all)
  {
    throw std::invalid_argument("an order of " + std::to_string(points_Phantom.size()) + " landmarks names each of them once");
  }
  Points points;
  for (int touched : order)
  {
    points.push_back(points_Phantom[std::size_t(touched)]);
  }
  return points;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewPoints:
      return "too_few_points";
    case Status::Collinear:
      return "collinear";
    case Status::PoorFit:
      return "poor_fit";
    case Status::WrongOrder:
      return "wrong_order";
    case Status::Mirrored:
      return "mirrored";
  }
  return "unknown";
}

}  // namespace handeye
