// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonFiles.h"

#include "JsonEigen.h"

#include <charconv>
#include <cmath>

namespace handeye
{

namespace
{

using Fields = std::vector<std::string>;

std::string line(const Fields& fields)
{
  std::string text;
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    text += (i > 0 ? "," : "") + csvField(fields[i]);
  }
  return text + "\r\n";
}

nlohmann::json summaryJson(const Summary& summary)
{
  return { { "mean", summary.mean }, { "std", summary.standardDeviation }, { "min", summary.minimum }, { "max", summary.maximum },
    { "rms", summary.rms }, { "count", summary.count } };
}

nlohmann::json captureJson(const ComparedCapture& capture)
{
  const MethodAnswer& answer = capture.answer;
  nlohmann::json json = { { "status", answer.status }, { "message", answer.message }, { "samples", answer.sampleCount },
    { "usedSamples", answer.usedCount }, { "seconds", answer.seconds } };
  if (answer.gap)
  {
    json["gap"] = *answer.gap;
  }
  if (answer.isUsable())
  {
    json["markerToCamera"] = toJson(*answer.markerToCamera);
    json["projectionErrorPx"] = summaryJson(capture.validation.projectionErrorPx);
  }
  return json;
}

nlohmann::json methodJson(const MethodResult& method)
{
  nlohmann::json json = { { "name", method.name }, { "title", method.title }, { "reference", method.reference },
    { "target", toString(method.target) }, { "status", method.status }, { "message", method.message },
    { "captures", nlohmann::json::array() }, { "subsets", nlohmann::json::array() } };
  if (method.isUsable())
  {
    json["projectionErrorPx"] = summaryJson(method.errorPx);
    json["successShare"] = method.successShare;
    if (method.commonErrorPx.count > 0)
    {
      json["commonProjectionErrorPx"] = summaryJson(method.commonErrorPx);
    }
  }
  for (const ComparedCapture& capture : method.captures)
  {
    json["captures"].push_back(captureJson(capture));
  }
  for (const SubsetErrors& subset : method.subsets)
  {
    nlohmann::json one = { { "samples", subset.sampleCount }, { "repetitions", subset.repetitions }, { "usable", subset.usable } };
    const std::pair<const char*, double> percentiles[] = { { "medianPx", subset.medianPx }, { "percentile10Px", subset.lowestPx },
      { "percentile90Px", subset.highestPx } };
    for (const auto& [key, value] : percentiles)
    {
      if (std::isfinite(value))
      {
        one[key] = value;
      }
    }
    json["subsets"].push_back(one);
  }
  const Repeatability& spread = method.repeatability;
  if (spread.calibrations > 1)
  {
    json["repeatability"] = { { "calibrations", spread.calibrations }, { "attempts", spread.attempts },
      { "ofHalves", spread.areHalves }, { "rotationDeg", spread.rotationDeg }, { "translationMm", spread.translationMm },
      { "projectionPx", spread.projectionPx }, { "worstPx", spread.worstPx } };
  }
  return json;
}

}  // namespace

std::string csvField(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
  {
    return text;
  }
  std::string quoted = "\"";
  for (const char letter : text)
  {
    quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  }
  return quoted + "\"";
}

std::string csvNumber(double value)
{
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, end.ptr);
}

nlohmann::json comparisonJson(const ComparisonResult& result)
{
  nlohmann::json json = { { "schema", "handeye-comparison/1" }, { "status", result.status }, { "message", result.message },
    { "validationSamples", result.validationCount }, { "ranking", nlohmann::json::array() },
    { "incomplete", nlohmann::json::array() }, { "notToldApartFromBest", nlohmann::json::array() },
    { "methods", nlohmann::json::array() } };
  const std::pair<const char*, const std::vector<int>*> lists[] = { { "ranking", &result.ranking },
    { "incomplete", &result.incomplete }, { "notToldApartFromBest", &result.notToldApart } };
  for (const auto& [key, indices] : lists)
  {
    for (const int index : *indices)
    {
      json[key].push_back(result.methods[std::size_t(index)].name);
    }
  }
  for (const MethodResult& method : result.methods)
  {
    json["methods"].push_back(methodJson(method));
  }
  return json;
}

std::string methodsCsv(const ComparisonResult& result)
{
  std::string text = line({ "method", "target", "status", "mean_px", "std_px", "min_px", "max_px", "rms_px", "errors",
    "calibrations", "captures", "median_seconds", "common_mean_px", "common_errors", "title", "reference", "message" });
  for (const MethodResult& method : result.methods)
  {
    const Summary& error = method.errorPx;
    const bool ok = method.isUsable();
    const auto number = [&](double value) { return ok ? csvNumber(value) : std::string(); };
    text += line({ method.name, toString(method.target), method.status, number(error.mean), number(error.standardDeviation),
      number(error.minimum), number(error.maximum), number(error.rms), std::to_string(error.count),
      std::to_string(method.usableCount()), std::to_string(method.captures.size()), csvNumber(method.medianSeconds()),
      method.commonErrorPx.count > 0 ? csvNumber(method.commonErrorPx.mean) : std::string(),
      std::to_string(method.commonErrorPx.count), method.title, method.reference, method.message });
  }
  return text;
}

std::string errorsCsv(const ComparisonResult& result, const std::vector<HandEyeSample>& validation)
{
  std::string text = line({ "method", "capture", "frame", "status", "distance_mm", "error_px", "segmented_u_px", "segmented_v_px",
    "projected_u_px", "projected_v_px" });
  for (const MethodResult& method : result.methods)
  {
    for (std::size_t capture = 0; capture < method.captures.size(); ++capture)
    {
      const std::vector<HandEyeValidationSample>& samples = method.captures[capture].validation.samples;
      for (std::size_t i = 0; i < samples.size() && i < validation.size(); ++i)
      {
        const HandEyeValidationSample& sample = samples[i];
        const bool ok = sample.status == CameraModel::Status::Ok;
        const auto number = [&](double value) { return ok ? csvNumber(value) : std::string(); };
        const Eigen::Vector2d& seen = validation[i].ball_Image;
        text += line({ method.name, std::to_string(capture), std::to_string(sample.frame), toString(sample.status),
          number(sample.distanceMm), number(sample.errorPx), csvNumber(seen.x()), csvNumber(seen.y()),
          number(sample.projected_Image.x()), number(sample.projected_Image.y()) });
      }
    }
  }
  return text;
}

std::string subsetsCsv(const ComparisonResult& result)
{
  std::string text = line({ "method", "samples", "repetitions", "usable", "median_px", "percentile10_px", "percentile90_px" });
  for (const MethodResult& method : result.methods)
  {
    for (const SubsetErrors& subset : method.subsets)
    {
      const auto number = [&](double value) { return std::isfinite(value) ? csvNumber(value) : std::string(); };
      text += line({ method.name, std::to_string(subset.sampleCount), std::to_string(subset.repetitions),
        std::to_string(subset.usable), number(subset.medianPx), number(subset.lowestPx), number(subset.highestPx) });
    }
  }
  return text;
}

std::string repeatabilityCsv(const ComparisonResult& result)
{
  std::string text =
    line({ "method", "of", "attempts", "calibrations", "rotation_deg", "translation_mm", "projection_px", "worst_projection_px" });
  for (const MethodResult& method : result.methods)
  {
    const Repeatability& spread = method.repeatability;
    const auto number = [&](double value) { return spread.calibrations > 1 ? csvNumber(value) : std::string(); };
    text += line(
      { method.name, spread.areHalves ? "halves" : "captures", std::to_string(spread.attempts), std::to_string(spread.calibrations),
        number(spread.rotationDeg), number(spread.translationMm), number(spread.projectionPx), number(spread.worstPx) });
  }
  return text;
}

}  // namespace handeye
