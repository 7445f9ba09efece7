// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ResultFiles.h"

#include "AtomicFile.h"
#include "HandEyePrediction.h"
#include "JsonEigen.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace handeye
{

namespace
{

using nlohmann::json;

json result(const char* kind, const std::string& status, const std::string& message)
{
  return { { "schema", std::string("handeye-") + kind + "/1" }, { "status", status }, { "message", message } };
}

json cameraJson(const CameraModel& camera)
{
  return { { "width", camera.width() }, { "height", camera.height() }, { "cameraMatrix", toJson(camera.cameraMatrix()) },
    { "distortionCoefficients", camera.distortionCoefficients() } };
}

/// Why a sample was left out.
std::string disagreement(const CalibratedFrame& frame)
{
  char text[160];
  std::snprintf(text, sizeof(text), "disagrees with the others by %.1f px, %.1f mm: %.0f times what its noise explains",
    frame.residualPx, frame.residualMm, frame.deviation);
  return text;
}

/// What is known of the ball in a frame.
void addBall(const CapturedFrame& captured, json& row)
{
  if (captured.ball.isFound())
  {
    row["ball_Image_Px"] = toJson(captured.ball.ball_Image);
    row["ballCovariance_Px2"] = toJson(captured.ball.covariance_Image);
  }
}

json predictedJson(const PredictedError& predicted)
{
  return { { "mean", predicted.meanPx }, { "max", predicted.maximumPx }, { "nearestMm", predicted.nearestMm },
    { "furthestMm", predicted.furthestMm } };
}

/// Both predicted errors at three by three pixels and three depths.
json predictedGrid(const HandEyeCalibrationResult& calibration, const CameraModel& camera)
{
  json rows = json::array();
  const PredictedError& volume = calibration.predicted;
  for (int k = 0; k < 27 && camera.hasImageSize(); ++k)
  {
    const Eigen::Vector2d pixel((camera.width() - 1) * (k % 3) / 2.0, (camera.height() - 1) * (k / 3 % 3) / 2.0);
    const double depth = volume.nearestMm + (volume.furthestMm - volume.nearestMm) * (k / 9) / 2.0;
    const std::optional<double> px = predictProjectionErrorPx(calibration.covariance, { camera }, pixel, depth);
    if (px)
    {
      const Eigen::Vector3d point_Camera = *pointSeenAt({ camera }, pixel, depth);
      rows.push_back({ { "point_Image_Px", toJson(pixel) }, { "depthMm", depth }, { "errorPx", *px },
        { "errorMm", predictTargetErrorMm(calibration.covariance, point_Camera) } });
    }
  }
  return rows;
}

json guidanceJson(const HandEyeGuidance& guidance)
{
  json object = { { "status", toString(guidance.status) }, { "message", guidance.message },
    { "worthwhile", guidance.isWorthwhile() } };
  if (guidance.status != HandEyeGuidance::Status::NoPlace)
  {
    object["ball_Image_Px"] = toJson(guidance.ball_Image);
    object["depthMm"] = guidance.ball_Camera.z();
    object["gain"] = guidance.gain;
  }
  if (guidance.maximumPx > 0 && std::isfinite(guidance.maximumPx))
  {
    object["maximumErrorPx"] = guidance.maximumPx;
    object["maximumErrorAfterPx"] = guidance.maximumAfterPx;
  }
  return object;
}

json sampleRows(const std::vector<CalibratedFrame>& frames, bool hasResiduals)
{
  json rows = json::array();
  for (const CalibratedFrame& frame : frames)
  {
    json row = { { "frame", frame.captured.frame }, { "status", frame.status }, { "used", frame.used } };
    addBall(frame.captured, row);
    if (frame.captured.tip_Marker)
    {
      row["tip_Marker_Mm"] = toJson(*frame.captured.tip_Marker);
    }
    if (hasResiduals && frame.captured.isSample())
    {
      row["residualPx"] = frame.residualPx;
      row["residualMm"] = frame.residualMm;
      row["deviation"] = frame.deviation;
    }
    if (frame.status == "disagrees")
    {
      row["message"] = disagreement(frame);
    }
    if (frame.status != "ok" && frame.status != "disagrees")
    {
      row["message"] = frame.captured.message;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void addSolution(const HandEyeCalibrationResult& calibration, json& object)
{
  object["covariance"] = toJson(calibration.covariance);
  object["reprojectionRmsPx"] = calibration.reprojectionRmsPx;
  object["pointToLineRmsMm"] = calibration.pointToLineRmsMm;
  object["usedSamples"] = calibration.usedCount;
  object["conditionNumber"] = calibration.conditionNumber;
  object["rank"] = calibration.rank;
  object["weakestFreedom"] = calibration.weakestFreedom;
  object["iterations"] = calibration.iterations;
  object["noise"] = { { "trackingSigmaMm", calibration.trackingSigmaMm },
    { "segmentationSigmaPx", calibration.segmentationSigmaPx } };
  object["predictedErrorPx"] = predictedJson(calibration.predicted);
  object["predictedErrorMm"] = { { "mean", calibration.predicted.meanMm }, { "max", calibration.predicted.maximumMm },
    { "nearestMm", calibration.predicted.nearestMm }, { "furthestMm", calibration.predicted.furthestMm } };
  if (!calibration.tipMessage.empty())
  {
    object["tipRefinement"] = { { "refined", calibration.tipCorrection_Stylus.has_value() },
      { "message", calibration.tipMessage } };
  }
  if (calibration.tipCorrection_Stylus)
  {
    object["tipRefinement"]["correction_Stylus_Mm"] = toJson(*calibration.tipCorrection_Stylus);
    object["tipRefinement"]["tipCovariance_Mm2"] = toJson(calibration.refinedTipCovariance_Stylus);
  }
}

/// One row a frame: whether it was used, why not, and its residual.
json pivotRows(const PivotStepResult& step)
{
  json rows = json::array();
  std::size_t invalid = 0, rejection = 0;
  const auto addInvalidBefore = [&](int frame)
  {
    for (; invalid < step.invalidFrames.size() && step.invalidFrames[invalid] < frame; ++invalid)
    {
      rows.push_back({ { "frame", step.invalidFrames[invalid] }, { "status", "not_tracked" }, { "used", false } });
    }
  };
  const PivotCalibrationResult& calibration = step.calibration;
  for (std::size_t i = 0; i < step.poseFrames.size() && i < calibration.residualsMm.size(); ++i)
  {
    addInvalidBefore(step.poseFrames[i]);
    const bool isRejected = rejection < calibration.rejections.size() && calibration.rejections[rejection].index == int(i);
    rows.push_back(
      { { "frame", step.poseFrames[i] }, { "status", isRejected ? toString(calibration.rejections[rejection].reason) : "ok" },
        { "used", !isRejected }, { "residualMm", calibration.residualsMm[i] } });
    rejection += isRejected ? 1 : 0;
  }
  addInvalidBefore(std::numeric_limits<int>::max());
  return rows;
}

}  // namespace

json stylusJson(const PivotStepResult& step)
{
  const PivotCalibrationResult& calibration = step.calibration;
  json object = result("stylus", toString(calibration.status), calibration.message);
  object["method"] = toString(calibration.method);
  object["usedFrames"] = calibration.used.size();
  object["rejectedFrames"] = step.rejectedFrames;
  object["invalidFrames"] = step.invalidFrames;
  object["repeatedFrames"] = step.repeatedFrames;
  object["samples"] = pivotRows(step);
  if (calibration.isUsable())
  {
    object["tip_Stylus_Mm"] = toJson(calibration.tip_Stylus);
    object["pivot_Tracker_Mm"] = toJson(calibration.pivot_Tracker);
    object["rmsMm"] = calibration.rmsMm;
    object["meanMm"] = calibration.meanMm;
    object["maxMm"] = calibration.maximumMm;
    object["noiseFactor"] = calibration.noiseFactor;
    object["tipCovariance_Mm2"] = toJson(calibration.tipCovariance);
    object["rotationSpread_Rad"] = toJson(calibration.rotationSpread);
    object["angularRange_Rad"] = toJson(calibration.angularRange);
  }
  return object;
}

json calibrationJson(const CalibrationStepResult& step)
{
  const HandEyeCalibrationResult& decisive = step.decisive();
  json object = result("calibration", toString(decisive.status), decisive.message);
  object["camera"] = cameraJson(step.camera);
  object["tip_Stylus_Mm"] = toJson(step.tip_Stylus);
  object["ballRadiusMm"] = step.ballRadiusMm;
  object["stylusTransform"] = step.tools.stylusToTracker;
  object["markerTransform"] = step.tools.markerToTracker;
  object["latencySec"] = step.tools.latencySec;
  object["samples"] = sampleRows(step.frames, step.calibration.isUsable());
  if (step.isUsable())
  {
    object["markerToCamera"] = toJson(step.calibration.markerToCamera);
    addSolution(step.calibration, object);
    object["predictedErrors"] = predictedGrid(step.calibration, step.camera);
    if (step.calibration.predictedByEye.size() > 1)
    {
      object["rightPredictedErrorPx"] = predictedJson(step.calibration.predictedByEye[1]);
    }
  }
  else
  {
    object["rank"] = step.calibration.rank;
    object["conditionNumber"] = std::isfinite(step.calibration.conditionNumber) ? json(step.calibration.conditionNumber) : json();
    object["weakestFreedom"] = step.calibration.weakestFreedom;
  }
  if (step.guidance)
  {
    object["nextPlacement"] = guidanceJson(*step.guidance);
  }
  if (step.right)
  {
    object["rightCamera"] = cameraJson(step.right->camera);
    object["rightSamples"] = sampleRows(step.right->frames, step.isUsable());
    if (step.isUsable())
    {
      object["markerToRightCamera"] = toJson(step.right->markerToRightCamera);
    }
    if (step.right->calibration && step.isUsable())
    {
      json right = result("calibration", toString(step.right->calibration->status), step.right->calibration->message);
      addSolution(*step.right->calibration, right);
      object["right"] = std::move(right);
    }
  }
  return object;
}

json validationJson(const ValidationStepResult& step)
{
  json object = result("validation", step.isUsable() ? "ok" : "no_samples", step.message);
  if (step.isUsable())
  {
    const Summary& error = step.projectionErrorPx;
    object["projectionErrorPx"] = { { "mean", error.mean }, { "std", error.standardDeviation }, { "min", error.minimum },
      { "max", error.maximum }, { "rms", error.rms }, { "count", error.count } };
  }
  object["samples"] = json::array();
  for (const ValidatedFrame& frame : step.frames)
  {
    json row = { { "frame", frame.captured.frame }, { "status", frame.status } };
    addBall(frame.captured, row);
    if (frame.validated)
    {
      row["distanceMm"] = frame.validated->distanceMm;
      if (frame.validated->status == CameraModel::Status::Ok)
      {
        row["projected_Image_Px"] = toJson(frame.validated->projected_Image);
        row["errorPx"] = frame.validated->errorPx;
      }
    }
    object["samples"].push_back(std::move(row));
  }
  return object;
}

json phantomJson(const LandmarkRegistrationResult& registration)
{
  json object = result("phantom", toString(registration.status), registration.message);
  if (registration.isUsable())
  {
    object["modelToPhantom"] = toJson(registration.modelToPhantom);
    object["rmsMm"] = registration.rmsMm;
    object["residualsMm"] = registration.residualsMm;
    object["localizationErrorMm"] = registration.localizationErrorMm;
    object["landmarkTreMm"] = registration.landmarkTreMm;
    object["targetTreMm"] = registration.targetTreMm;
  }
  if (registration.worst >= 0)
  {
    object["worstLandmark"] = registration.worst + 1;
    object["leftOut"] = json::array();
    for (const LandmarkLeftOut& leftOut : registration.leftOut)
    {
      object["leftOut"].push_back({ { "rmsMm", leftOut.rmsMm }, { "missMm", leftOut.missMm } });
    }
  }
  if (!registration.suggestedOrder.empty())
  {
    json order = json::array();
    for (int touched : registration.suggestedOrder)
    {
      order.push_back(touched + 1);
    }
    object["suggestedOrder"] = order;
    object["suggestedRmsMm"] = registration.suggestedRmsMm;
  }
  return object;
}

json detectionJson(const std::vector<CapturedFrame>& frames)
{
  int found = 0;
  json rows = json::array();
  for (const CapturedFrame& captured : frames)
  {
    json row = { { "frame", captured.frame }, { "status", captured.status } };
    addBall(captured, row);
    if (captured.ball.isFound())
    {
      ++found;
      row["radiusPx"] = captured.ball.radiusPx;
      row["distanceMm"] = captured.ball.distanceMm;
      row["visibleShare"] = captured.ball.visibleShare;
      row["confidence"] = captured.ball.confidence;
    }
    else
    {
      row["message"] = captured.message;
    }
    rows.push_back(std::move(row));
  }
  json object = result("detection", found > 0 ? "ok" : "not_found",
    "ball found in " + std::to_string(found) + " of " + std::to_string(frames.size()) + " frames");
  object["frames"] = std::move(rows);
  return object;
}

json registrationJson(const PointLineResult& registration)
{
  json object = result("registration", toString(registration.status), registration.message);
  if (registration.isUsable())
  {
    object["pointsToLines"] = toJson(registration.pointsToLines);
    object["rmsMm"] = registration.rmsMm;
    object["residualsMm"] = registration.residualsMm;
    object["rejected"] = registration.rejected;
    object["iterations"] = registration.iterations;
    object["conditionNumber"] = registration.conditionNumber;
    object["rank"] = registration.rank;
  }
  if (registration.isUsable() && !registration.covariance.isZero(0))
  {
    object["covariance"] = toJson(registration.covariance);
    object["noise"] = { { "sigmaMm", registration.sigmaMm }, { "sigmaRad", registration.sigmaRad } };
  }
  for (const Eigen::Isometry3d& solution : registration.solutions)
  {
    object["solutions"].push_back(toJson(solution));
  }
  return object;
}

void writeJson(const std::filesystem::path& path, const json& object)
{
  io::writeFileAtomically(path, object.dump(2) + "\n");
}

}  // namespace handeye
