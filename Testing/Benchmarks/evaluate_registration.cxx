// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The tables of Documentation/Registration.md: evaluate_registration minima|limit|prediction|guidance|outliers [RUNS].
#include "HandEyeGuidance.h"
#include "HandEyePrediction.h"
#include "PointLineSupport.h"
#include "RegistrationProblems.h"

#include <opencv2/calib3d.hpp>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

namespace
{

using namespace handeye;
using namespace handeye::test;
using Method = PointLineOptions::Method;
using Vector6 = Eigen::Matrix<double, 6, 1>;

PointLineOptions rayOptions(Method method)
{
  return pointLineOptions(method, true);
}

Eigen::Isometry3d bySqpnp(const RegistrationProblem& problem)
{
  cv::Vec3d rotation, translation;
  cv::solvePnP(
    problem.points, problem.pixels, problem.cameraMatrix, cv::noArray(), rotation, translation, false, cv::SOLVEPNP_SQPNP);
  return makeRigid({ rotation[0], rotation[1], rotation[2] }, { translation[0], translation[1], translation[2] });
}

/// What brings the truth to the estimate from the left.
Vector6 errorOf(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth)
{
  const Eigen::Isometry3d cameraToEstimate = estimate * truth.inverse();
  const Eigen::AngleAxisd turn(cameraToEstimate.linear());
  Vector6 error;
  error << turn.angle() * turn.axis(), cameraToEstimate.translation();
  return error;
}

/// The inverse of Fisher's information at the truth: sum of J^T (sigma_px^2 I + sigma_mm^2 P P^T)^-1 J.
Covariance6 cramerRao(const EvaluationCamera& view, const std::vector<Eigen::Vector3d>& balls_Camera)
{
  Covariance6 information = Covariance6::Zero();
  for (const Eigen::Vector3d& ball_Camera : balls_Camera)
  {
    Eigen::Matrix<double, 2, 3> byPoint;
    (void)view.camera.project(ball_Camera, &byPoint);
    Eigen::Matrix2d noise = EvaluationSigmaMm * EvaluationSigmaMm * byPoint * byPoint.transpose();
    noise.diagonal().array() += EvaluationSigmaPx * EvaluationSigmaPx;
    const Eigen::Matrix<double, 2, 6> byPose = byPoint * motionJacobian(ball_Camera);
    information += byPose.transpose() * noise.inverse() * byPose;
  }
  return information.inverse();
}

std::vector<Eigen::Vector3d> randomPlaces(const EvaluationCamera& view, int count, double borderShare, Random& random)
{
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i)
  {
    places.push_back(randomPointInView(view.camera, { view.nearestMm, view.furthestMm, borderShare, 0, 0 }, random));
  }
  return places;
}

/// Costs against SQPNP, cheirality, and what becomes of the paper's iteration.
void evaluateMinima(int runs)
{
  std::printf("%-12s %7s %9s %9s %9s %7s %7s %9s | procrustes: %8s %8s %8s %10s\n", "camera", "runs", "above", "above*", "behind",
    "noresult", "proven", "sqp behind", "mirrored", "capped", "other", "iterations");
  for (const EvaluationCamera& view : evaluationCameras())
  {
    Random random(2017);
    int above = 0, aboveDescended = 0, behind = 0, none = 0, proven = 0, sqpnpBehind = 0, mirrored = 0, capped = 0, other = 0;
    double iterations = 0;
    for (int run = 0; run < runs; ++run)
    {
      const int count = random.integer(3, 30);
      const RegistrationProblem problem = randomProblem(view, count, random);
      const PointLineResult result = registerPointsToLines(problem.pairs, rayOptions(Method::Global));
      std::vector<Eigen::Isometry3d> ours = result.solutions;
      ours.insert(ours.end(), result.isUsable() ? 1 : 0, result.pointsToLines);
      proven += result.minimaCount == 1 ? 1 : 0;
      none += ours.empty() ? 1 : 0;
      double cost = std::numeric_limits<double>::infinity();
      for (const Eigen::Isometry3d& solution : ours)
      {
        cost = std::min(cost, pointLineCost(problem.pairs, solution));
        behind += count >= 6 && pointsInFront(problem.pairs, solution) < count ? 1 : 0;
      }
      const double slack = 1e-12 * count;  // mm^2: three points fit exactly, all that is left is rounding
      const Eigen::Isometry3d sqpnp = bySqpnp(problem), descended = descendPlainly(problem.pairs, sqpnp);
      const auto isAbove = [&](const Eigen::Isometry3d& theirs)
      {
        const bool isInFront = 2 * pointsInFront(problem.pairs, theirs) > count;
        return isInFront && cost > pointLineCost(problem.pairs, theirs) * (1 + 1e-9) + slack;
      };
      sqpnpBehind += 2 * pointsInFront(problem.pairs, sqpnp) <= count ? 1 : 0;
      above += isAbove(sqpnp) ? 1 : 0;
      aboveDescended += isAbove(descended) ? 1 : 0;
      if (count >= 4)
      {
        const PointLineResult procrustes = registerPointsToLines(problem.pairs, rayOptions(Method::Procrustes));
        iterations += procrustes.iterations;
        mirrored += procrustes.status == PointLineResult::Status::Mirrored ? 1 : 0;
        capped += procrustes.status == PointLineResult::Status::NotConverged ? 1 : 0;
        other += procrustes.isUsable() && pointLineCost(problem.pairs, procrustes.pointsToLines) > 1.01 * cost + slack ? 1 : 0;
      }
    }
    std::printf("%-12s %7d %9d %9d %9d %7d %7d %9d | %20d %8d %8d %10.0f\n", view.name.c_str(), runs, above, aboveDescended, behind,
      none, proven, sqpnpBehind, mirrored, capped, other, iterations / runs);
  }
  std::printf("above: cost more than 1e-9 (relative) above SQPNP's; above*: above the minimum that a descent from SQPNP's solution "
              "reaches;\nbehind: a point behind the camera with 6 points and more\n");
}

/// Root mean square errors over the Cramer-Rao bound, 15 points.
void evaluateLimit(int runs)
{
  std::printf(
    "%-12s %-12s %7s %12s %12s %12s %12s\n", "camera", "method", "usable", "rot mrad", "over bound", "transl mm", "over bound");
  for (const EvaluationCamera& view : evaluationCameras())
  {
    for (int estimated = 0; estimated < 2; ++estimated)
    {
      for (const Method method : allMethods())
      {
        if (estimated && method != Method::MaximumLikelihood)
        {
          continue;
        }
        Random random(2000);
        Vector6 squares = Vector6::Zero(), bounds = Vector6::Zero();
        int usable = 0;
        HandEyeCalibrationOptions options = evaluationOptions(method);
        options.estimateNoise = estimated > 0;
        for (int run = 0; run < runs; ++run)
        {
          const std::vector<Eigen::Vector3d> places = randomPlaces(view, 15, 0, random);
          const Eigen::Isometry3d truth = random.rigid(100);
          const HandEyeCalibrationResult result =
            calibrateHandEye(samplesAt(view, truth, places, random), { { view.camera } }, options);
          if (result.isUsable())
          {
            ++usable;
            squares += errorOf(result.markerToCamera, truth).cwiseAbs2();
            bounds += cramerRao(view, places).diagonal();
          }
        }
        const double turned = std::sqrt(squares.head<3>().sum() / usable), moved = std::sqrt(squares.tail<3>().sum() / usable);
        std::printf("%-12s %-12s %7d %12.3f %12.3f %12.4f %12.3f\n", view.name.c_str(),
          (toString(method) + (estimated ? ", est." : "")).c_str(), usable, 1e3 * turned,
          std::sqrt(squares.head<3>().sum() / bounds.head<3>().sum()), moved,
          std::sqrt(squares.tail<3>().sum() / bounds.tail<3>().sum()));
      }
    }
  }
}

/// Predicted errors against those of fresh noise on the same places, at 5 x 5 pixels and 3 depths.
void evaluatePrediction(int runs)
{
  std::printf("%-12s %4s %6s | predicted over Monte Carlo, lowest and highest in the view: %6s %6s (mm) %6s %6s (px)\n", "camera",
    "n", "set", "low", "high", "low", "high");
  for (const EvaluationCamera& view : evaluationCameras())
  {
    for (const int count : { 10, 15, 30 })
    {
      for (int set = 0; set < 3; ++set)
      {
        Random random(unsigned(100 * count + set));
        const std::vector<Eigen::Vector3d> places = randomPlaces(view, count, 0.05, random);
        const Eigen::Isometry3d truth = random.rigid(100);
        std::vector<Eigen::Vector3d> targets_Camera;
        for (int k = 0; k < 75; ++k)
        {
          const Eigen::Vector2d pixel((view.camera.width() - 1) * (k % 5) / 4.0, (view.camera.height() - 1) * (k / 5 % 5) / 4.0);
          const double depth = view.nearestMm + (view.furthestMm - view.nearestMm) * (k / 25) / 2.0;
          targets_Camera.push_back(*pointSeenAt({ view.camera }, pixel, depth));
        }
        std::vector<double> mm(75, 0), px(75, 0), predictedMm(75, 0), predictedPx(75, 0);
        for (int run = 0; run < runs; ++run)
        {
          const HandEyeCalibrationResult result = calibrateHandEye(
            samplesAt(view, truth, places, random), { { view.camera } }, evaluationOptions(Method::MaximumLikelihood));
          const Eigen::Isometry3d cameraToEstimate = result.markerToCamera * truth.inverse();
          for (std::size_t k = 0; k < targets_Camera.size(); ++k)
          {
            const Eigen::Vector3d& target = targets_Camera[k];
            const Eigen::Vector3d shown = cameraToEstimate * target;
            const Eigen::Vector2d pixel = view.camera.project(target).point_Image;
            mm[k] += (shown - target).squaredNorm();
            px[k] += (view.camera.project(shown).point_Image - pixel).squaredNorm();
            predictedMm[k] += std::pow(predictTargetErrorMm(result.covariance, target), 2);
            predictedPx[k] +=
              std::pow(predictProjectionErrorPx(result.covariance, { view.camera }, pixel, target.z()).value_or(0), 2);
          }
        }
        double low[2] = { 1e9, 1e9 }, high[2] = { 0, 0 };
        for (std::size_t k = 0; k < targets_Camera.size(); ++k)
        {
          const double ratios[2] = { std::sqrt(predictedMm[k] / mm[k]), std::sqrt(predictedPx[k] / px[k]) };
          for (int unit = 0; unit < 2; ++unit)
          {
            low[unit] = std::min(low[unit], ratios[unit]);
            high[unit] = std::max(high[unit], ratios[unit]);
          }
        }
        std::printf("%-12s %4d %6d | %61.3f %6.3f %11.3f %6.3f\n", view.name.c_str(), count, set, low[0], high[0], low[1], high[1]);
      }
    }
  }
}

std::vector<Eigen::Vector3d> guidedPlaces(const EvaluationCamera& view, int count, double scatterMm, Random& random)
{
  HandEyeGuidanceOptions options;
  options.nearestMm = view.nearestMm;
  options.furthestMm = view.furthestMm;
  options.trackingSigmaMm = EvaluationSigmaMm;
  options.segmentationSigmaPx = EvaluationSigmaPx;
  std::vector<Eigen::Vector3d> places;
  while (int(places.size()) < count)
  {
    places.push_back(suggestPlacement(places, { view.camera }, options).ball_Camera + random.normal3(scatterMm));
  }
  return places;
}

/// A ball in the middle of each of 4 x 4 parts of the image, at any depth.
std::vector<Eigen::Vector3d> gridPlaces(const EvaluationCamera& view, Random& random)
{
  std::vector<Eigen::Vector3d> places;
  for (int k = 0; k < 16; ++k)
  {
    const Eigen::Vector2d pixel(view.camera.width() * (k % 4 + 0.5) / 4, view.camera.height() * (k / 4 + 0.5) / 4);
    places.push_back(*pointSeenAt({ view.camera }, pixel, random.uniform(view.nearestMm, view.furthestMm)));
  }
  return places;
}

/// Guided placements against random ones and the grid: the largest and the mean projection error in the working volume.
void evaluateGuidance(int runs)
{
  const std::vector<std::pair<std::string, int>> plans = { { "random", 15 }, { "grid 4x4", 16 }, { "guided", 6 }, { "guided", 7 },
    { "guided", 8 }, { "guided", 9 }, { "guided", 10 } };
  std::printf("%-12s %-10s %4s %22s %14s\n", "camera", "placements", "n", "largest error px (RMS)", "mean error px");
  for (const EvaluationCamera& view : evaluationCameras())
  {
    for (const auto& [plan, count] : plans)
    {
      Random random(77);
      double largestSquares = 0, means = 0;
      for (int run = 0; run < runs; ++run)
      {
        const std::vector<Eigen::Vector3d> places = plan == "random" ? randomPlaces(view, count, 0.1, random)
          : plan == "guided"                                         ? guidedPlaces(view, count, 0.02 * view.nearestMm, random)
                                                                     : gridPlaces(view, random);
        const Eigen::Isometry3d truth = random.rigid(100);
        const HandEyeCalibrationResult result = calibrateHandEye(
          samplesAt(view, truth, places, random), { { view.camera } }, evaluationOptions(Method::MaximumLikelihood));
        const Eigen::Isometry3d cameraToEstimate = result.markerToCamera * truth.inverse();
        double largest = 0, sum = 0;
        for (int k = 0; k < 75; ++k)
        {
          const Eigen::Vector2d pixel((view.camera.width() - 1) * (k % 5) / 4.0, (view.camera.height() - 1) * (k / 5 % 5) / 4.0);
          const double depth = view.nearestMm + (view.furthestMm - view.nearestMm) * (k / 25) / 2.0;
          const Eigen::Vector3d target = *pointSeenAt({ view.camera }, pixel, depth);
          const double error = (view.camera.project(cameraToEstimate * target).point_Image - pixel).norm();
          largest = std::max(largest, error);
          sum += error / 75;
        }
        largestSquares += largest * largest;
        means += sum;
      }
      std::printf(
        "%-12s %-10s %4d %22.3f %14.3f\n", view.name.c_str(), plan.c_str(), count, std::sqrt(largestSquares / runs), means / runs);
    }
  }
}

/// Shares of wrong samples: how often exactly the wrong ones are left out.
void evaluateOutliers(int runs)
{
  std::printf("%-12s %6s %8s %10s %12s %14s\n", "camera", "wrong", "usable", "all found", "right lost", "error px (RMS)");
  for (const EvaluationCamera& view : evaluationCameras())
  {
    for (const int wrongCount : { 0, 2, 4, 5 })
    {
      Random random(30);
      int usable = 0, allFound = 0, lost = 0;
      double squares = 0;
      for (int run = 0; run < runs; ++run)
      {
        RegistrationProblem problem = randomProblem(view, 15, random);
        std::set<int> wrong;
        while (int(wrong.size()) < wrongCount)
        {
          wrong.insert(random.integer(0, 14));
        }
        for (int i : wrong)
        {
          HandEyeSample& sample = problem.samples[std::size_t(i)];
          sample.ball_Image = { random.uniform(0, view.camera.width() - 1), random.uniform(0, view.camera.height() - 1) };
          sample.ray_Eye = view.camera.unproject(sample.ball_Image).ray_Camera;
        }
        HandEyeCalibrationOptions options = evaluationOptions(Method::MaximumLikelihood);
        options.rejectOutliers = true;
        const HandEyeCalibrationResult result = calibrateHandEye(problem.samples, { { view.camera } }, options);
        if (!result.isUsable())
        {
          continue;
        }
        ++usable;
        bool found = true;
        for (int i = 0; i < 15; ++i)
        {
          const bool used = result.samples[std::size_t(i)].used;
          found = found && !(wrong.count(i) && used);
          lost += !wrong.count(i) && !used ? 1 : 0;
        }
        allFound += found ? 1 : 0;
        const Eigen::Vector2d middle(view.camera.cx(), view.camera.cy());
        const Eigen::Vector3d target = *pointSeenAt({ view.camera }, middle, (view.nearestMm + view.furthestMm) / 2);
        const Eigen::Isometry3d cameraToEstimate = result.markerToCamera * problem.truth.inverse();
        squares += (view.camera.project(cameraToEstimate * target).point_Image - middle).squaredNorm();
      }
      std::printf(
        "%-12s %6d %8d %10d %12d %14.3f\n", view.name.c_str(), wrongCount, usable, allFound, lost, std::sqrt(squares / usable));
    }
  }
}

}  // namespace

int main(int argc, char** argv)
{
  const std::map<std::string, std::pair<void (*)(int), int>> tables = { { "minima", { evaluateMinima, 10000 } },
    { "limit", { evaluateLimit, 4000 } }, { "prediction", { evaluatePrediction, 2000 } }, { "guidance", { evaluateGuidance, 400 } },
    { "outliers", { evaluateOutliers, 100 } } };
  const auto table = tables.find(argc > 1 ? argv[1] : "");
  const int runs = argc > 2 ? std::atoi(argv[2]) : table != tables.end() ? table->second.second : 0;
  if (table == tables.end() || runs < 1)
  {
    std::fprintf(stderr, "usage: evaluate_registration minima|limit|prediction|guidance|outliers [RUNS]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  table->second.first(runs);
  return 0;
}
