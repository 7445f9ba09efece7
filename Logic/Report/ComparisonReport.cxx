// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonReport.h"

#include "ComparisonFiles.h"
#include "MarkedPicture.h"
#include "NumberWords.h"
#include "ReportPlots.h"
#include "ReportWords.h"

#include <algorithm>

namespace handeye
{

namespace
{

constexpr std::size_t MostPictures = 8;
constexpr std::size_t MostPredictions = 6;
/// Of report::seriesColor(), for pictures: all different, and none of them the green of the segmented ball.
constexpr std::size_t PictureColors[MostPredictions] = { 0, 1, 3, 5, 6, 4 };

/// The methods that are drawn on pictures: the best one, the best with a board, and those that the paper is about; more hide each
/// other.
std::vector<int> methodsToShow(const ComparisonResult& result)
{
  std::vector<int> shown;
  const auto add = [&](int index)
  {
    if (shown.size() < MostPredictions && std::find(shown.begin(), shown.end(), index) == shown.end())
    {
      shown.push_back(index);
    }
  };
  const auto isBoard = [&](int index) { return result.methods[std::size_t(index)].target == ComparedMethod::Target::Board; };
  add(result.ranking.front());
  const auto board = std::find_if(result.ranking.begin(), result.ranking.end(), isBoard);
  if (board != result.ranking.end())
  {
    add(*board);
  }
  for (const char* const name : { "ml", "as-published", "branch-and-bound", "procrustes" })
  {
    for (const int index : result.ranking)
    {
      if (result.methods[std::size_t(index)].name == name)
      {
        add(index);
      }
    }
  }
  return shown;
}

/// The validation samples by the error of the best method, the worst first.
std::vector<std::size_t> samplesToShow(const ComparisonResult& result, const ComparisonReportInput& input)
{
  const HandEyeValidationResult* best = nullptr;
  for (const ComparedCapture& capture : result.methods[std::size_t(result.ranking.front())].captures)
  {
    best = best == nullptr && capture.answer.isUsable() ? &capture.validation : best;
  }
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; best != nullptr && i < best->samples.size(); ++i)
  {
    if (input.recording->hasImage(best->samples[i].frame))
    {
      samples.push_back(i);
    }
  }
  std::stable_sort(samples.begin(), samples.end(),
    [&](std::size_t a, std::size_t b) { return best->samples[a].errorPx > best->samples[b].errorPx; });
  return report::spreadOut(samples, MostPictures);
}

report::Figure pictureOf(const ComparisonResult& result, const ComparisonReportInput& input, std::size_t sample)
{
  const int frame = input.validation[sample].frame;
  const std::vector<report::PredictedCenter> predicted = report::predictedCenters(result, sample);
  std::string errors;
  for (const report::PredictedCenter& center : predicted)
  {
    const double errorPx = (center.place_Image - input.validation[sample].ball_Image).norm();
    errors += (errors.empty() ? "" : ", ") + center.label + " " + fixedDigits(errorPx, 2) + " px";
  }
  BallDetection ball;
  for (const CapturedFrame& captured : input.frames)
  {
    ball = captured.frame == frame ? captured.ball : ball;
  }
  report::Figure figure;
  figure.picture = report::drawMarkedPicture(input.recording->image(frame), ball, predicted);
  figure.isPhotograph = true;
  figure.caption = "frame " + std::to_string(frame) + ": " + errors;
  return figure;
}

void addPictures(report::ReportDocument& document, const ComparisonResult& result, const ComparisonReportInput& input)
{
  if (input.recording == nullptr || result.ranking.empty())
  {
    return;
  }
  const std::vector<std::size_t> samples = samplesToShow(result, input);
  if (samples.empty())
  {
    return;
  }
  report::Gallery gallery;
  for (const std::size_t sample : samples)
  {
    gallery.figures.push_back(pictureOf(result, input, sample));
  }
  document.blocks.push_back(report::Heading{ "Predicted and segmented centres" });
  document.blocks.push_back(report::Paragraph{
    "Green: the segmented ball's outline and centre. The colours that each picture's legend names, which are not those of the "
    "plots: where a method's calibration (of the first capture) puts the tracked ball. Right: the framed part, enlarged; arrows "
    "are the errors. The worst frame of the best method first." });
  document.blocks.push_back(std::move(gallery));
}

report::Table capturesTable(const std::vector<MethodResult>& methods)
{
  report::Table table;
  table.caption = "Each method on each capture";
  table.headings = { "method", "capture", "status", "samples", "used", "mean error (px)", "time (s)", "what it said" };
  table.textColumns = 3;
  table.endsWithText = true;
  for (const MethodResult& method : methods)
  {
    for (std::size_t i = 0; i < method.captures.size(); ++i)
    {
      const MethodAnswer& answer = method.captures[i].answer;
      const Summary& error = method.captures[i].validation.projectionErrorPx;
      table.rows.push_back(
        { method.name, std::to_string(i + 1), answer.status, std::to_string(answer.sampleCount), std::to_string(answer.usedCount),
          error.count > 0 ? fixedDigits(error.mean, 2) : "", significantDigits(answer.seconds, 2), answer.message });
    }
  }
  return table;
}

/// Where more samples stop helping.
std::string plateauWords(const std::vector<MethodResult>& methods)
{
  std::string text;
  for (const MethodResult& method : methods)
  {
    if (const std::optional<int> plateau = report::plateauOf(method))
    {
      text += (text.empty() ? "" : ", ") + method.name + " from " + std::to_string(*plateau);
    }
  }
  return text.empty() ? "No method levels out within the samples that there are."
                      : "Within 10 % of what the largest subsets reach (samples): " + text + ".";
}

void addSubsets(report::ReportDocument& document, const ComparisonResult& result, const report::PlotDrawer& draw)
{
  const std::optional<report::Plot> plot = report::errorAgainstSamples(result.methods);
  if (!plot)
  {
    return;
  }
  document.blocks.push_back(report::Heading{ "How many samples?" });
  document.blocks.push_back(
    report::Paragraph{ "Random subsets of the first capture, with fixed seeds, each judged on the whole "
                       "validation set; the median of their mean errors. "
                       "Subsets without a calibration count as the worst; sizes at which half of them are such are not drawn. "
                       "Three points fit up to four calibrations exactly, "
                       "so that no method has one answer for them. " +
      plateauWords(result.methods) });
  report::addPlot(document, plot, "Solid: methods with the ball; dashed: with a board.", draw);
  document.blocks.push_back(report::subsetsTable(result.methods));
}

void addRepeatability(report::ReportDocument& document, const ComparisonResult& result)
{
  report::Table table = report::repeatabilityTable(result.methods);
  if (!table.rows.empty())
  {
    document.blocks.push_back(report::Heading{ "Repeatability" });
    document.blocks.push_back(report::Paragraph{
      "How far calibrations of different data are from each other, root mean squares about their mean: the rotation, the "
      "translation, and "
      "where the balls of the validation set are put in the image. It needs no truth, and does not see what is wrong in all of "
      "them. "
      "Random halves of one capture have half the samples each: whole captures are about 1.4 times more alike." });
    document.blocks.push_back(std::move(table));
  }
}

}  // namespace

report::ReportDocument comparisonDocument(const ComparisonResult& result, const ComparisonReportInput& input)
{
  report::ReportDocument document;
  document.title = "Comparison of hand-eye calibrations";
  document.verdictText = result.message;
  document.verdict = result.ranking.empty() ? report::ReportDocument::Verdict::Poor
                                            : report::verdictOf(result.methods[std::size_t(result.ranking.front())].commonErrorPx);
  for (const std::string& fact : input.facts)
  {
    document.blocks.push_back(report::Paragraph{ fact });
  }
  document.blocks.push_back(report::Heading{ "Projection error" });
  document.blocks.push_back(report::methodsTable(result,
    "Distance (px) between where a calibration puts the tracked ball and where it is segmented, on the same " +
      std::to_string(result.validationCount) + " validation samples for every method, none of which was fitted"));
  report::addPlot(document, report::errorAgainstDistance(result.methods),
    "One colour and mark a method, a mark a validation sample.", input.drawPlot);
  report::addPlot(document, report::shareBelowError(result.methods),
    "Solid: methods with the ball; dashed: with a board. The further left, the better.", input.drawPlot);
  addPictures(document, result, input);
  addSubsets(document, result, input.drawPlot);
  addRepeatability(document, result);
  document.blocks.push_back(report::Heading{ "Captures" });
  document.blocks.push_back(capturesTable(result.methods));
  document.data = { { "methods.csv", "one line a method: projection errors (px), calibrations, time (s)", methodsCsv(result) },
    { "errors.csv", "one line a method, capture and validation sample: distance (mm), error, segmented and projected centre (px)",
      errorsCsv(result, input.validation) },
    { "subsets.csv", "one line a method and size of the random subsets: median, 10th and 90th percentile of the mean errors (px)",
      subsetsCsv(result) },
    { "repeatability.csv", "one line a method: spread of the calibrations (degrees, mm, px)", repeatabilityCsv(result) } };
  return document;
}

namespace report
{

std::vector<PredictedCenter> predictedCenters(const ComparisonResult& result, std::size_t sample)
{
  std::vector<PredictedCenter> predicted;
  const std::vector<int> shown = methodsToShow(result);
  for (std::size_t place = 0; place < shown.size(); ++place)
  {
    const MethodResult& method = result.methods[std::size_t(shown[place])];
    const auto capture = std::find_if(
      method.captures.begin(), method.captures.end(), [](const ComparedCapture& one) { return one.answer.isUsable(); });
    if (capture != method.captures.end() && capture->validation.samples[sample].status == CameraModel::Status::Ok)
    {
      predicted.push_back({ capture->validation.samples[sample].projected_Image, seriesColor(PictureColors[place]), method.name });
    }
  }
  return predicted;
}

}  // namespace report

void writeComparisonReport(const std::filesystem::path& folder, const ComparisonResult& result, const ComparisonReportInput& input)
{
  report::writeReport(folder, comparisonDocument(result, input));
}

}  // namespace handeye
