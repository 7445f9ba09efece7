// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardResultFiles.h"

#include "JsonEigen.h"

#include <map>

namespace handeye
{

namespace
{

using nlohmann::json;

json cameraJson(const CameraModel& camera)
{
  return { { "width", camera.width() }, { "height", camera.height() }, { "cameraMatrix", toJson(camera.cameraMatrix()) },
    { "distortionCoefficients", camera.distortionCoefficients() } };
}

/// One row a frame; the views that the solver had know more.
json lensRows(const LensCalibrationResult& result, const std::vector<BoardFrame>& frames)
{
  std::map<int, const LensCalibrationResult::View*> views;
  for (const LensCalibrationResult::View& view : result.views)
  {
    views[view.frame] = &view;
  }
  json rows = json::array();
  for (const BoardFrame& frame : frames)
  {
    json row = { { "frame", frame.frame }, { "status", frame.status }, { "used", false } };
    const auto found = views.find(frame.frame);
    if (frame.status == "ok" && found != views.end())
    {
      const LensCalibrationResult::View& view = *found->second;
      row["used"] = view.used && result.usedCount > 0;
      row["points"] = frame.detection.ids.size();
      row["edgeWidthPx"] = frame.detection.edgeWidthPx;
      if (result.usedCount > 0)
      {
        row["rmsPx"] = view.rmsPx;
        row["maxPx"] = view.maximumPx;
      }
      if (!view.used)
      {
        row["status"] = "disagrees";
        row["message"] = view.message;
      }
    }
    else
    {
      row["message"] = frame.message;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

json summaryJson(const Summary& summary)
{
  return { { "mean", summary.mean }, { "std", summary.standardDeviation }, { "min", summary.minimum }, { "max", summary.maximum } };
}

json branchAndBoundJson(const BranchAndBoundState& state)
{
  return { { "errorRad", state.bestErrorRad }, { "lowerBoundRad", state.lowerBoundRad }, { "gapRad", state.gapRad },
    { "proven", state.isProven }, { "cubes", state.cubes }, { "linearPrograms", state.linearPrograms },
    { "elapsedSec", state.elapsedSec } };
}

json sampleRows(const BoardCalibration& calibration)
{
  std::map<int, std::size_t> viewOf;
  for (std::size_t i = 0; i < calibration.viewFrames.size(); ++i)
  {
    viewOf[calibration.viewFrames[i]] = i;
  }
  json rows = json::array();
  for (const BoardFrame& frame : calibration.frames)
  {
    json row = { { "frame", frame.frame }, { "status", frame.status }, { "used", false } };
    const auto found = viewOf.find(frame.frame);
    const bool isView = found != viewOf.end() && found->second < calibration.result.views.size();
    if (isView && calibration.result.views[found->second].used)
    {
      const BoardHandEyeResult::View& view = calibration.result.views[found->second];
      row["used"] = calibration.result.isUsable();
      row["points"] = frame.detection.ids.size();
      row["boardToCamera"] = toJson(view.boardToCamera);
      row["residualPx"] = view.residualPx;
      row["residualMm"] = view.residualMm;
      row["residualDeg"] = view.residualRad * 180 / EIGEN_PI;
    }
    else if (isView)
    {
      row["status"] = "no_pose";
      row["message"] = calibration.result.views[found->second].message;
    }
    else
    {
      row["message"] = frame.message;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

json lensJson(const LensCalibrationResult& result, const BoardDescription& board, const std::vector<BoardFrame>& frames,
  const LensViewCollector* collector)
{
  json object = { { "schema", "handeye-lens/1" }, { "status", toString(result.status) }, { "message", result.message },
    { "board", toString(board) }, { "views", lensRows(result, frames) } };
  object["usedViews"] = result.usedCount;
  if (result.isUsable())
  {
    object["camera"] = cameraJson(*result.camera);
    object["reprojectionRmsPx"] = result.rmsPx;
    object["reprojectionMeanPx"] = result.meanPx;
    object["sigmas"] = { { "fx", result.cameraMatrixSigmas(0) }, { "fy", result.cameraMatrixSigmas(1) },
      { "cx", result.cameraMatrixSigmas(2) }, { "cy", result.cameraMatrixSigmas(3) },
      { "distortionCoefficients", result.coefficientSigmas } };
  }
  if (!result.models.empty())
  {
    object["modelHint"] = result.modelHint;
    object["supportedCoefficients"] = result.supportedCoefficients;
    object["models"] = json::array();
    for (const LensModelComparison& model : result.models)
    {
      object["models"].push_back({ { "coefficients", model.coefficients }, { "rmsPx", model.rmsPx }, { "focalPx", model.focalPx },
        { "informationCriterion", model.informationCriterion }, { "supported", model.isSupported } });
    }
  }
  if (collector != nullptr)
  {
    const LensViewCollector::Tilts tilts = collector->tilts();
    object["coverage"] = toJson(collector->coverage());
    object["coverageShare"] = collector->coverageShare();
    object["tilts"] = { { "square", tilts.square }, { "left", tilts.left }, { "right", tilts.right }, { "top", tilts.top },
      { "bottom", tilts.bottom } };
    object["hint"] = collector->hint();
  }
  return object;
}

json repetitionJson(const LensRepetition& repetition)
{
  json coefficients = json::array();
  for (const Summary& coefficient : repetition.coefficients)
  {
    coefficients.push_back(summaryJson(coefficient));
  }
  return { { "count", repetition.results.size() }, { "failed", repetition.failedCount }, { "fx", summaryJson(repetition.fx) },
    { "fy", summaryJson(repetition.fy) }, { "cx", summaryJson(repetition.cx) }, { "cy", summaryJson(repetition.cy) },
    { "distortionCoefficients", coefficients }, { "meanShiftPx", repetition.meanShiftPx },
    { "maxShiftPx", repetition.maximumShiftPx } };
}

json boardCalibrationJson(const BoardCalibration& calibration)
{
  const BoardHandEyeResult& result = calibration.result;
  json object = { { "schema", "handeye-calibration/1" }, { "status", toString(result.status) }, { "message", result.message },
    { "method", toString(calibration.method) }, { "board", toString(calibration.board) },
    { "camera", cameraJson(calibration.camera) }, { "markerTransform", calibration.tools.markerToTracker },
    { "stylusTransform", calibration.tools.stylusToTracker }, { "latencySec", calibration.tools.latencySec } };
  object["samples"] = sampleRows(calibration);
  if (calibration.tip_Stylus)
  {
    object["tip_Stylus_Mm"] = toJson(*calibration.tip_Stylus);
  }
  if (calibration.ballRadiusMm)
  {
    object["ballRadiusMm"] = *calibration.ballRadiusMm;
  }
  if (calibration.method == BoardHandEyeOptions::Method::BranchAndBound)
  {
    object["branchAndBound"] = branchAndBoundJson(result.branchAndBound);
  }
  if (result.isUsable())
  {
    object["markerToCamera"] = toJson(result.markerToCamera);
    object["boardToTracker"] = toJson(result.boardToTracker);
    object["reprojectionRmsPx"] = result.reprojectionRmsPx;
    object["rmsMm"] = result.rmsMm;
    object["rmsDeg"] = result.rmsRad * 180 / EIGEN_PI;
    object["usedSamples"] = result.usedCount;
    object["pairs"] = result.pairCount;
    if (result.covariance)
    {
      object["covariance"] = toJson(*result.covariance);
    }
  }
  return object;
}

}  // namespace handeye
