// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensCalibration.h"

#include "LensFit.h"
#include "LensModels.h"
#include "NumberWords.h"
#include "Statistics.h"

namespace handeye
{

namespace
{

using Status = LensCalibrationResult::Status;

constexpr int FewestPointsOfView = 6;
/// Views that are better than this (px) are no outliers, however good the others.
constexpr double GoodEnoughPx = 0.25;
constexpr double DegPerRad = 180 / EIGEN_PI;

/// The views that take part, by their index.
std::vector<int> viewsWithPoints(const std::vector<LensView>& views, LensCalibrationResult& result)
{
  std::vector<int> used;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    LensCalibrationResult::View row;
    row.frame = views[i].frame;
    row.used = int(views[i].ids.size()) >= FewestPointsOfView;
    row.message = row.used ? std::string() : "fewer than " + std::to_string(FewestPointsOfView) + " points are seen";
    result.views.push_back(row);
    if (row.used)
    {
      used.push_back(int(i));
    }
  }
  return used;
}

std::vector<const LensView*> pointersTo(const std::vector<LensView>& views, const std::vector<int>& used)
{
  std::vector<const LensView*> pointers;
  for (const int i : used)
  {
    pointers.push_back(&views[std::size_t(i)]);
  }
  return pointers;
}

LensCalibrationResult failed(LensCalibrationResult result, Status status, const std::string& message)
{
  result.status = status;
  result.message = message;
  return result;
}

/// The view that disagrees most, if it does; its place among those used.
std::optional<std::size_t> worstView(const LensFit& fit, const LensCalibrationOptions& options)
{
  const auto worst = std::max_element(fit.viewRmsPx.begin(), fit.viewRmsPx.end());
  const bool isOutlier = *worst > GoodEnoughPx && *worst > options.rejectionFactor * median(fit.viewRmsPx);
  return isOutlier ? std::optional(std::size_t(worst - fit.viewRmsPx.begin())) : std::nullopt;
}

/// Fits, leaving out the worst view as long as there is one that disagrees.
std::optional<LensFit> fitWithoutOutliers(const std::vector<LensView>& views, int width, int height,
  const LensCalibrationOptions& options, std::vector<int>& used, LensCalibrationResult& result)
{
  const auto fitUsed = [&]
  { return fitLens(pointersTo(views, used), width, height, options.coefficients, options.circleDiameterMm); };
  std::optional<LensFit> fit = fitUsed();
  const int most = int(options.maximumRejectedShare * double(used.size()));
  for (int rejected = 0; fit && options.rejectOutlierViews; ++rejected)
  {
    const std::optional<std::size_t> worst = worstView(*fit, options);
    if (!worst)
    {
      break;
    }
    if (rejected == most || int(used.size()) <= options.minimumViews)
    {
      result.status = Status::MixedViews;
      return std::nullopt;
    }
    LensCalibrationResult::View& row = result.views[std::size_t(used[*worst])];
    row.used = false;
    row.rmsPx = fit->viewRmsPx[*worst];
    row.message =
      "disagrees with the other views: " + fixedDigits(row.rmsPx, 2) + " px, theirs have " + fixedDigits(median(fit->viewRmsPx), 2);
    used.erase(used.begin() + std::ptrdiff_t(*worst));
    fit = fitUsed();
  }
  return fit;
}

void storeFit(const LensFit& fit, const std::vector<int>& used, LensCalibrationResult& result)
{
  double sum = 0;
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    LensCalibrationResult::View& row = result.views[std::size_t(used[i])];
    row.rmsPx = fit.viewRmsPx[i];
    row.residuals_Image = fit.residuals_Image[i];
    row.boardToCamera = fit.boardToCamera[i];
    for (const Eigen::Vector2d& residual : row.residuals_Image)
    {
      row.maximumPx = std::max(row.maximumPx, residual.norm());
      sum += residual.norm();
    }
  }
  result.usedCount = int(used.size());
  result.rmsPx = fit.rmsPx();
  result.meanPx = sum / std::max(1, fit.pointCount);
  result.cameraMatrixSigmas = fit.cameraMatrixSigmas;
  result.coefficientSigmas = fit.coefficientSigmas;
}

/// Whether the lens model holds all over the image.
bool holdsInImage(const CameraModel& camera)
{
  constexpr int Steps = 12;
  for (int i = 0; i <= Steps * (Steps + 1) + Steps; ++i)
  {
    const double u = double(i % (Steps + 1)) / Steps, v = double(i / (Steps + 1)) / Steps;
    if (!camera.unproject({ u * (camera.width() - 1), v * (camera.height() - 1) }).isUsable())
    {
      return false;
    }
  }
  return true;
}

/// The lens must be the same in the first half of the views as in the second: a zoom in between fits a lens in the middle, and no
/// view stands out.
void checkZoom(const std::vector<LensView>& views, const std::vector<int>& used, int width, int height,
  const LensCalibrationOptions& options, LensCalibrationResult& result)
{
  constexpr double Deviations = 6, LeastShare = 0.005;
  const std::ptrdiff_t half = std::ptrdiff_t(used.size()) / 2;
  if (!result.isUsable() || half < options.minimumViews)
  {
    return;
  }
  const std::vector<int> first(used.begin(), used.begin() + half), second(used.begin() + half, used.end());
  const std::optional<LensFit> before = fitLens(pointersTo(views, first), width, height, 4, options.circleDiameterMm);
  const std::optional<LensFit> after = fitLens(pointersTo(views, second), width, height, 4, options.circleDiameterMm);
  if (!before || !after)
  {
    return;
  }
  const double change = after->camera.fx() - before->camera.fx();
  const double sigma = std::hypot(before->cameraMatrixSigmas(0), after->cameraMatrixSigmas(0));
  if (std::abs(change) > Deviations * sigma && std::abs(change) > LeastShare * before->camera.fx())
  {
    result.status = Status::MixedViews;
    result.camera.reset();
    result.message = "the lens changed between the views: its focal length is " + fixedDigits(before->camera.fx(), 1) +
      " px in the first half and " + fixedDigits(after->camera.fx(), 1) + " px in the second. Was it zoomed or focused anew?";
  }
}

std::string verdict(const LensFit& fit, const LensCalibrationResult& result)
{
  std::string left;
  for (const LensCalibrationResult::View& view : result.views)
  {
    left += view.used ? std::string() : (left.empty() ? "" : ", ") + std::to_string(view.frame);
  }
  const double focal = (fit.camera.fx() + fit.camera.fy()) / 2;
  const double share = fit.cameraMatrixSigmas.head<2>().maxCoeff() / focal;
  return std::string(result.rmsPx < 0.5 ? "good: " : "fair: ") + fixedDigits(result.rmsPx, 2) + " px RMS over " +
    std::to_string(result.usedCount) + " views, focal length " + fixedDigits(focal, 1) + " px known to " +
    fixedDigits(100 * share, 2) + " %" + (left.empty() ? std::string() : "; left out: frame " + left);
}

/// What is wrong with a fit, if anything.
void judge(const LensFit& fit, const LensCalibrationOptions& options, LensCalibrationResult& result)
{
  const auto fail = [&](Status status, const std::string& message)
  {
    result.status = status;
    result.message = message;
  };
  const double spread = tiltSpreadRad(fit.boardToCamera);
  const double focal = (fit.camera.fx() + fit.camera.fy()) / 2, sigma = fit.cameraMatrixSigmas.head<2>().maxCoeff();
  if (spread < options.minimumTiltSpreadRad)
  {
    fail(Status::ParallelViews,
      "the board always stood the same way (within " + fixedDigits(spread * DegPerRad, 1) +
        " degrees): a lens cannot be told from a distance. Tilt it to all sides, by 20 to 40 degrees");
  }
  else if (!(result.rmsPx <= options.maximumRmsPx))
  {
    fail(Status::NoFit,
      "no lens explains the views: " + fixedDigits(result.rmsPx, 1) +
        " px RMS are left. Is the board the one described, flat, and " + "the zoom the same in all?");
  }
  else if (!(sigma <= options.maximumFocalDeviation * focal))
  {
    fail(Status::TooUncertain,
      "the focal length of " + fixedDigits(focal, 1) + " px is only known to " + fixedDigits(sigma, 1) +
        " px: take more views, tilted to all sides");
  }
  else if (!holdsInImage(fit.camera))
  {
    fail(Status::FoldsInImage,
      "the lens with " + std::to_string(options.coefficients) + " coefficients folds back on itself inside the image: hold the " +
        "board into its corners, too, or take fewer coefficients");
  }
  else
  {
    fail(Status::Ok, verdict(fit, result));
    result.camera = fit.camera;
  }
}

}  // namespace

LensView toLensView(int frame, const BoardDetection& detection)
{
  return { frame, detection.ids, detection.points_Board, detection.points_Image };
}

void LensCalibrationOptions::check() const
{
  const auto require = [](bool isGood, const char* what)
  {
    if (!isGood)
    {
      throw std::invalid_argument(std::string("LensCalibrationOptions: ") + what);
    }
  };
  require(coefficients == 4 || coefficients == 5 || coefficients == 8, "coefficients are 4, 5 or 8");
  require(minimumViews >= 3, "minimumViews is at least 3");
  require(rejectionFactor > 1, "rejectionFactor is above 1");
  require(maximumRejectedShare >= 0 && maximumRejectedShare < 1, "maximumRejectedShare is between 0 and 1");
  require(maximumRmsPx > 0 && maximumFocalDeviation > 0, "maximumRmsPx and maximumFocalDeviation are positive");
  require(minimumTiltSpreadRad > 0 && minimumTiltSpreadRad < 1, "minimumTiltSpreadRad is between 0 and 1");
  require(circleDiameterMm >= 0 && std::isfinite(circleDiameterMm), "circleDiameterMm is not negative");
}

LensCalibrationResult calibrateLens(
  const std::vector<LensView>& views, int width, int height, const LensCalibrationOptions& options)
{
  options.check();
  checkLensViews(views, width, height);
  LensCalibrationResult result;
  std::vector<int> used = viewsWithPoints(views, result);
  if (int(used.size()) < options.minimumViews)
  {
    return failed(std::move(result), Status::TooFewViews,
      std::to_string(used.size()) + " views of the board can be used, at least " + std::to_string(options.minimumViews) +
        " are needed");
  }
  const std::optional<LensFit> fit = fitWithoutOutliers(views, width, height, options, used, result);
  if (!fit && result.status == Status::MixedViews)
  {
    return failed(std::move(result), Status::MixedViews,
      "too many views disagree with each other: was the zoom or the focus changed, or another board shown?");
  }
  if (!fit)
  {
    return failed(std::move(result), Status::NoFit, "no lens explains the views: is the board the one described?");
  }
  storeFit(*fit, used, result);
  judge(*fit, options, result);
  if (options.rejectOutlierViews)
  {
    checkZoom(views, used, width, height, options, result);
  }
  const bool isWorthComparing = result.isUsable() || result.status == Status::FoldsInImage;
  if (isWorthComparing && options.compareModels)
  {
    compareLensModels(pointersTo(views, used), width, height, options, *fit, result);
  }
  return result;
}

std::string toString(LensCalibrationResult::Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewViews:
      return "too_few_views";
    case Status::ParallelViews:
      return "parallel_views";
    case Status::TooUncertain:
      return "too_uncertain";
    case Status::MixedViews:
      return "mixed_views";
    case Status::NoFit:
      return "no_fit";
    case Status::FoldsInImage:
      return "folds_in_image";
  }
  return "unknown";
}

}  // namespace handeye
