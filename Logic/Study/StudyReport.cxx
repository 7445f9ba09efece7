// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyReport.h"

#include "ComparisonFiles.h"
#include "ComparisonReport.h"
#include "ImageFile.h"
#include "NumberWords.h"
#include "ReportPlots.h"
#include "StudyTables.h"

#include <algorithm>
#include <map>

namespace handeye::study
{

namespace
{

using report::Heading;
using report::Paragraph;

/// Distances in so many steps; a dot for each of tens of thousands of samples would be a cloud.
constexpr int DistanceSteps = 8;

/// Mean error by distance, a line a method.
std::optional<report::Plot> errorByDistance(const StudyCameraResult& camera)
{
  report::Plot plot;
  plot.title = "Mean projection error against distance, " + camera.camera.name;
  plot.xLabel = "distance of the ball from the camera (mm)";
  plot.yLabel = "mean projection error (px)";
  double largest = 0, least = 1e300;
  for (std::size_t i = 0; i < camera.comparison.methods.size(); ++i)
  {
    const MethodResult& method = camera.comparison.methods[i];
    std::map<int, std::vector<std::pair<double, double>>> bins;
    for (const ComparedCapture& capture : method.captures)
    {
      for (const HandEyeValidationSample& sample : capture.validation.samples)
      {
        const double share = (sample.distanceMm - camera.camera.nearestMm) / (camera.camera.furthestMm - camera.camera.nearestMm);
        if (sample.status == CameraModel::Status::Ok)
        {
          bins[std::clamp(int(share * DistanceSteps), 0, DistanceSteps - 1)].emplace_back(sample.distanceMm, sample.errorPx);
        }
      }
    }
    report::PlotSeries series = report::seriesOf(camera.comparison.methods, i, report::PlotSeries::Style::LineAndDots);
    for (const auto& [bin, samples] : bins)
    {
      double distance = 0, error = 0;
      for (const auto& [mm, px] : samples)
      {
        distance += mm / double(samples.size());
        error += px / double(samples.size());
      }
      series.x.push_back(distance);
      series.y.push_back(error);
      largest = std::max(largest, error);
      least = std::min(least, error);
    }
    if (!series.x.empty())
    {
      plot.series.push_back(std::move(series));
    }
  }
  plot.isLogarithmic = least > 0 && largest > 8 * least;
  return plot.series.empty() ? std::nullopt : std::make_optional(std::move(plot));
}

/// Own mean error against the range of the board's directions, a line a method with a board and `ml`.
std::optional<report::Plot> errorByTilt(const StudyCameraResult& camera)
{
  report::Plot plot;
  // No longer than a plot is wide.
  plot.title = "Own error by the board's directions, " + camera.camera.name + " (" + tiltRepetitionWords(camera) + ")";
  plot.xLabel = "board seen from up to so far off its normal (degrees)";
  plot.yLabel = "mean error without the validation's noise (px)";
  plot.isLogarithmic = true;
  for (std::size_t i = 0; i < camera.comparison.methods.size(); ++i)
  {
    const MethodResult& method = camera.comparison.methods[i];
    report::PlotSeries series = report::seriesOf(camera.comparison.methods, i, report::PlotSeries::Style::LineAndDots);
    for (const StudyTiltResult& tilt : camera.byTilt)
    {
      for (const MethodResult& one : tilt.truth.methods)
      {
        if (one.name == method.name && one.isUsable())
        {
          series.x.push_back(tilt.tiltDeg);
          series.y.push_back(one.errorPx.mean);
        }
      }
    }
    if (!series.x.empty() && (method.target == ComparedMethod::Target::Board || method.name == "ml"))
    {
      plot.series.push_back(std::move(series));
    }
  }
  return plot.series.empty() ? std::nullopt : std::make_optional(std::move(plot));
}

/// The plots of a camera with the names of their files.
std::vector<std::pair<std::string, report::Plot>> plotsOf(const StudyCameraResult& camera)
{
  std::vector<std::pair<std::string, report::Plot>> plots;
  if (auto plot = errorByDistance(camera))
  {
    plots.emplace_back(camera.camera.name + "-distance.png", std::move(*plot));
  }
  if (auto plot = report::errorAgainstSamples(camera.comparison.methods))
  {
    plot->title += ", " + camera.camera.name;
    plots.emplace_back(camera.camera.name + "-samples.png", std::move(*plot));
  }
  if (auto plot = errorByTilt(camera))
  {
    plots.emplace_back(camera.camera.name + "-tilt.png", std::move(*plot));
  }
  return plots;
}

/// A paragraph for each statement that does not hold.
void addReasons(report::ReportDocument& document, const StudyResult& result)
{
  for (const StudyClaim& claim : result.claims)
  {
    for (const StudyCheck& check : claim.checks)
    {
      if (!check.holds)
      {
        document.blocks.push_back(Paragraph{ "Why not, " + claim.camera + ", " + check.what + ": " + check.reason });
      }
    }
  }
}

report::Table setUpTable(const StudyResult& result)
{
  report::Table table;
  table.caption = "The cameras. Noise of features: root mean square per axis, measured on rendered pictures with our detectors";
  table.caption += result.options.cornerSigmaPx < 0 ? "" : "; that of the corners was given";
  table.headings = { "camera", "eyes", "image (px)", "fx (px)", "depths (mm)", "ball radius (mm)", "board", "marker from lens (mm)",
    "ball noise (px)", "corner noise (px)", "validation's own error (px)" };
  table.textColumns = 1;
  for (const StudyCameraResult& one : result.cameras)
  {
    const StudyCamera& camera = one.camera;
    const CameraModel& lens = camera.eyes.front().camera;
    table.rows.push_back(
      { camera.name, std::to_string(camera.eyes.size()), std::to_string(lens.width()) + " x " + std::to_string(lens.height()),
        fixedDigits(lens.fx(), 0), fixedDigits(camera.nearestMm, 0) + " to " + fixedDigits(camera.furthestMm, 0),
        fixedDigits(camera.ballRadiusMm, 0), toString(camera.board), fixedDigits(camera.markerDistanceMm(), 0),
        fixedDigits(one.noise.ballSigmaPx, 3), fixedDigits(one.noise.cornerSigmaPx, 3), fixedDigits(one.floorPx.mean, 2) });
  }
  return table;
}

std::string lensWords(const StudyOptions& options)
{
  if (options.lensFocalShare == 0 && options.lensCenterPx == 0)
  {
    return "The lens is known exactly.";
  }
  return "The lens that all methods are told is off, anew in each repetition, by " + fixedDigits(100 * options.lensFocalShare, 2) +
    " % of the focal length and " + fixedDigits(options.lensCenterPx, 1) + " px of the principal point per axis.";
}

std::string printWords(const StudyOptions& options)
{
  return options.boardScaleShare == 0 ? "its print, and its place on its own marker, are known exactly."
                                      : "its print is off, anew in each repetition, by " +
      fixedDigits(100 * options.boardScaleShare, 2) + " % of its size, its place on its own marker is known exactly.";
}

std::string noiseWords(const StudyResult& result)
{
  const StudyOptions& options = result.options;
  std::string text = std::to_string(options.repetitions) + " repetitions with fixed seeds (--seed " + std::to_string(options.seed) +
    "), each eye for itself: " + std::to_string(options.size.ballSamples) + " balls, " + std::to_string(options.size.boardViews) +
    " views of the board, " + std::to_string(options.size.validationSamples) +
    " other balls to validate on; the stylus' tip from " + std::to_string(options.size.pivotPoses) + " poses. ";
  return text +
    (options.isNoiseFree ? "No noise at all."
                         : "Every pose of every marker has noise of " + fixedDigits(options.trackingSigmaMm, 3) + " mm and " +
          fixedDigits(options.trackingSigmaDeg, 3) + " degrees per axis, the same for ball and board. " + lensWords(options) +
          " The board is looked at from up to " + fixedDigits(options.size.boardTiltDeg, 0) +
          " degrees off, the camera turned by up to " + fixedDigits(options.size.boardRollDeg, 0) + " degrees to either side; " +
          printWords(options) + " The branch and bound had " + significantDigits(options.branchAndBoundSec, 3) + " s a capture.");
}

/// Pooled results have hundreds of captures: the median gap of the branch and bound says how far its proof was.
std::string gapWords(const ComparisonResult& comparison)
{
  std::vector<double> gaps;
  for (const MethodResult& method : comparison.methods)
  {
    for (const ComparedCapture& capture : method.captures)
    {
      if (capture.answer.gap)
      {
        gaps.push_back(*capture.answer.gap);
      }
    }
  }
  return gaps.empty() ? std::string()
                      : "Branch and bound: in the median its answer is at most " + fixedDigits(100 * median(gaps), 0) +
      " % above the bound that it proved. ";
}

void addCamera(report::ReportDocument& document, const StudyCameraResult& camera, const StudyClaim& claim)
{
  document.blocks.push_back(Heading{ camera.camera.title });
  document.blocks.push_back(Paragraph{ claim.message + " Lowest mean of all methods: " + claim.lowestMean +
    "; lowest maximum: " + claim.lowestMaximum + ". A perfect calibration with the true lens would show " +
    fixedDigits(camera.floorPx.mean, 2) + " px mean and " + fixedDigits(camera.floorPx.maximum, 2) +
    " px at most: the noise of the validation itself. " + gapWords(camera.comparison) + camera.comparison.message });
  document.blocks.push_back(report::methodsTable(
    camera.comparison, "Projection error (px) as a validation shows it, with the tracker's noise in it; all repetitions and eyes"));
  document.blocks.push_back(
    report::methodsTable(camera.truth, "The calibrations' own error (px): the same, at the same balls without noise"));
  for (const auto& [name, plot] : plotsOf(camera))
  {
    document.blocks.push_back(
      report::Figure{ plot.title + ". Solid: methods with the ball; dashed: with a board.", report::drawPlot(plot), false });
  }
  if (!camera.byTilt.empty())
  {
    document.blocks.push_back(tiltTable(camera));
  }
  if (!camera.byCondition.empty())
  {
    document.blocks.push_back(conditionsTable(camera));
  }
  if (!camera.comparison.methods.empty() && !camera.comparison.methods.front().subsets.empty())
  {
    document.blocks.push_back(report::subsetsTable(camera.comparison.methods));
  }
  report::Table spread = report::repeatabilityTable(camera.comparison.methods);
  spread.caption = "Repeatability: spread of the first eye's calibrations over the repetitions (root mean square)";
  document.blocks.push_back(std::move(spread));
  if (camera.renderedEyes > 0)
  {
    document.blocks.push_back(report::methodsTable(camera.rendered,
      "Projection error (px) of " + std::to_string(camera.renderedEyes) +
        " repetitions whose balls and boards were rendered and found by the detectors, instead of projected with noise; lens and "
        "print are off as in the others, noise of corners that was given has no part in it"));
  }
}

void addData(report::ReportDocument& document, const StudyCameraResult& camera)
{
  const std::string& name = camera.camera.name;
  document.data.push_back({ name + "-methods.csv", "one line a method: projection errors as a validation shows them (px)",
    methodsCsv(camera.comparison) });
  document.data.push_back({ name + "-true.csv", "one line a method: the calibrations' own errors (px)", methodsCsv(camera.truth) });
  document.data.push_back({ name + "-subsets.csv", "one line a method and number of samples (px)", subsetsCsv(camera.comparison) });
  document.data.push_back({ name + "-repeatability.csv", "one line a method: spread over the repetitions (degrees, mm, px)",
    repeatabilityCsv(camera.comparison) });
  if (camera.renderedEyes > 0)
  {
    document.data.push_back(
      { name + "-rendered.csv", "one line a method: with features found in pictures (px)", methodsCsv(camera.rendered) });
  }
}

nlohmann::json summariesJson(const ComparisonResult& comparison)
{
  nlohmann::json methods = nlohmann::json::array();
  for (const MethodResult& method : comparison.methods)
  {
    const Summary& error = method.errorPx;
    nlohmann::json one = { { "name", method.name }, { "target", toString(method.target) }, { "status", method.status },
      { "calibrations", method.usableCount() }, { "captures", method.captures.size() },
      { "medianSeconds", method.medianSeconds() } };
    if (method.isUsable())
    {
      one["projectionErrorPx"] = { { "mean", error.mean }, { "std", error.standardDeviation }, { "min", error.minimum },
        { "max", error.maximum }, { "rms", error.rms }, { "count", error.count } };
    }
    methods.push_back(std::move(one));
  }
  return methods;
}

nlohmann::json checksJson(const StudyClaim& claim)
{
  nlohmann::json checks = nlohmann::json::array();
  for (const StudyCheck& check : claim.checks)
  {
    checks.push_back({ { "what", check.what }, { "holds", check.holds }, { "measured", check.measured }, { "reason", check.reason },
      { "isOfThePaper", check.isOfThePaper } });
  }
  return checks;
}

}  // namespace

report::ReportDocument studyDocument(const StudyResult& result)
{
  report::ReportDocument document;
  document.title = "Study: hand-eye calibration of three cameras, by every method";
  document.verdictText = result.message;
  const bool holds = std::all_of(result.claims.begin(), result.claims.end(),
    [](const StudyClaim& claim)
    {
      return claim.hasLowestMean && claim.hasLowestMaximum &&
        std::all_of(
          claim.checks.begin(), claim.checks.end(), [](const StudyCheck& check) { return check.holds || !check.isOfThePaper; });
    });
  document.verdict = holds ? report::ReportDocument::Verdict::Good : report::ReportDocument::Verdict::Fair;
  document.blocks.push_back(Heading{ "What holds" });
  document.blocks.push_back(checksTable(result, true));
  const report::Table others = checksTable(result, false);
  if (!others.rows.empty())
  {
    document.blocks.push_back(others);
  }
  addReasons(document, result);
  document.blocks.push_back(Heading{ "What was simulated" });
  document.blocks.push_back(Paragraph{ noiseWords(result) });
  document.blocks.push_back(setUpTable(result));
  for (std::size_t i = 0; i < result.cameras.size(); ++i)
  {
    addCamera(document, result.cameras[i], result.claims[i]);
    addData(document, result.cameras[i]);
  }
  return document;
}

void writeStudyReport(const std::filesystem::path& folder, const StudyResult& result)
{
  report::writeReport(folder, studyDocument(result));
  for (const StudyCameraResult& camera : result.cameras)
  {
    for (const auto& [name, plot] : plotsOf(camera))
    {
      io::writePng(folder / name, report::drawPlot(plot));
    }
  }
}

nlohmann::json studyJson(const StudyResult& result)
{
  nlohmann::json json = { { "schema", "handeye-study/1" }, { "status", result.status }, { "message", result.message },
    { "repetitions", result.options.repetitions }, { "seed", result.options.seed }, { "cameras", nlohmann::json::array() } };
  for (std::size_t i = 0; i < result.cameras.size(); ++i)
  {
    const StudyCameraResult& camera = result.cameras[i];
    const StudyClaim& claim = result.claims[i];
    nlohmann::json one = { { "name", camera.camera.name }, { "ballSigmaPx", camera.noise.ballSigmaPx },
      { "cornerSigmaPx", camera.noise.cornerSigmaPx }, { "validationFloorPx", camera.floorPx.mean },
      { "claim",
        { { "lowestMean", claim.hasLowestMean }, { "lowestMaximum", claim.hasLowestMaximum },
          { "lowestMeanOfAll", claim.lowestMean }, { "lowestMaximumOfAll", claim.lowestMaximum },
          { "branchAndBoundOverOursMean", claim.branchAndBoundMean }, { "branchAndBoundOverOursMax", claim.branchAndBoundMaximum },
          { "branchAndBoundOverOursTrueMean", claim.branchAndBoundTrueMean },
          { "trackedBoardOverOursMean", claim.trackedBoardMean }, { "message", claim.message } } },
      { "checks", checksJson(claim) }, { "methods", summariesJson(camera.comparison) },
      { "methodsAgainstTruth", summariesJson(camera.truth) } };
    for (const StudyTiltResult& tilt : camera.byTilt)
    {
      one["byBoardTilt"].push_back({ { "tiltDeg", tilt.tiltDeg }, { "methods", summariesJson(tilt.comparison) },
        { "methodsAgainstTruth", summariesJson(tilt.truth) } });
    }
    for (const StudyConditionResult& condition : camera.byCondition)
    {
      one["byCondition"].push_back({ { "condition", condition.words }, { "methods", summariesJson(condition.comparison) },
        { "methodsAgainstTruth", summariesJson(condition.truth) } });
    }
    if (camera.renderedEyes > 0)
    {
      one["methodsOnRenderedPictures"] = summariesJson(camera.rendered);
    }
    json["cameras"].push_back(std::move(one));
  }
  return json;
}

}  // namespace handeye::study
