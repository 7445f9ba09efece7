// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ResultFiles.h"

#include "AtomicFile.h"
#include "JsonEigen.h"

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

/// What is known of the ball in a frame.
void addBall(const CapturedFrame& captured, json& row)
{
  if (captured.ball.isFound())
  {
    row["ball_Image_Px"] = toJson(captured.ball.ball_Image);
    row["ballCovariance_Px2"] = toJson(captured.ball.covariance_Image);
  }
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
  object["iterations"] = calibration.iterations;
  object["predictedErrorPx"] = { { "mean", calibration.predicted.meanPx }, { "max", calibration.predicted.maximumPx },
    { "nearestMm", calibration.predicted.nearestMm }, { "furthestMm", calibration.predicted.furthestMm } };
}

}  // namespace

json stylusJson(const PivotStepResult& step)
{
  const PivotCalibrationResult& calibration = step.calibration;
  json object = result("stylus", toString(calibration.status), calibration.message);
  object["usedFrames"] = calibration.used.size();
  object["rejectedFrames"] = step.rejectedFrames;
  object["invalidFrames"] = step.invalidFrames;
  if (calibration.isUsable())
  {
    object["tip_Stylus_Mm"] = toJson(calibration.tip_Stylus);
    object["pivot_Tracker_Mm"] = toJson(calibration.pivot_Tracker);
    object["rmsMm"] = calibration.rmsMm;
    object["maxMm"] = calibration.maximumMm;
    object["tipCovariance_Mm2"] = toJson(calibration.tipCovariance);
    object["rotationSpread_Rad"] = toJson(calibration.rotationSpread);
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
    object["iterations"] = registration.iterations;
    object["conditionNumber"] = registration.conditionNumber;
  }
  return object;
}

void writeJson(const std::filesystem::path& path, const json& object)
{
  io::writeFileAtomically(path, object.dump(2) + "\n");
}

}  // namespace handeye
