// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationStep.h"

#include "HandEyeUncertainty.h"

#include <algorithm>
#include <numeric>

namespace handeye
{

namespace
{

/// Frames with what the calibration says of their samples, which are in the same order, from `firstSample` on.
std::vector<CalibratedFrame> toFrames(
  const std::vector<CapturedFrame>& captured, const HandEyeCalibrationResult& calibration, std::size_t firstSample)
{
  std::vector<CalibratedFrame> frames;
  std::size_t next = firstSample;
  for (const CapturedFrame& capturedFrame : captured)
  {
    CalibratedFrame frame;
    frame.captured = capturedFrame;
    frame.status = capturedFrame.status;
    if (capturedFrame.isSample())
    {
      const HandEyeCalibrationResult::Sample& sample = calibration.samples[next++];
      frame.used = sample.used;
      frame.residualPx = sample.residualPx;
      frame.residualMm = sample.residualMm;
      frame.deviation = sample.deviation;
      if (calibration.tipCorrection_Stylus)
      {
        frame.captured.tip_Marker = *capturedFrame.tip_Marker + capturedFrame.stylusToMarker * *calibration.tipCorrection_Stylus;
      }
      if (calibration.isUsable() && !sample.used)
      {
        frame.status = "disagrees";
      }
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// More placements help; where samples contradict each other they do not.
bool isPlanned(HandEyeCalibrationResult::Status status)
{
  using Status = HandEyeCalibrationResult::Status;
  return status == Status::Ok || status == Status::TooFewSamples || status == Status::NotObservable ||
    status == Status::Ambiguous || status == Status::TooUncertain;
}

/// Where the balls of the usable (or, if there is none, of all) samples were; once for each place of a ball that was held still, as the
/// verdict counts them.
std::vector<Eigen::Vector3d> ballPlaces(const CalibrationStepResult& result)
{
  std::vector<Eigen::Vector3d> balls_Camera;
  HandEyeSamples samples;
  for (const CalibratedFrame& frame : result.frames)
  {
    const CapturedFrame& captured = frame.captured;
    if (!captured.isSample() || (result.calibration.isUsable() && !frame.used))
    {
      continue;
    }
    const Eigen::Vector3d byTracking = result.calibration.markerToCamera * *captured.tip_Marker;
    const Eigen::Vector3d bySize = captured.ball.ray_Camera * captured.ball.distanceMm;
    balls_Camera.push_back(result.calibration.isUsable() ? byTracking : bySize);
    samples.emplace_back();
    samples.back().tip_Marker = *captured.tip_Marker;
  }
  std::vector<int> all(samples.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> firsts = placesOf(samples, all);
  std::vector<Eigen::Vector3d> places;
  for (int i : all)
  {
    if (firsts[std::size_t(i)] == i && balls_Camera[std::size_t(i)].z() > 0)
    {
      places.push_back(balls_Camera[std::size_t(i)]);
    }
  }
  return places;
}

}  // namespace

void addGuidance(CalibrationStepResult& result, const HandEyeCalibrationOptions& options, const DepthRange& depthsMm)
{
  // A working volume of no depth would ask for all balls at one distance.
  constexpr double leastDepthRatio = 1.5;
  if (!isPlanned(result.calibration.status) || result.calibration.isLensSuspect)
  {
    return;
  }
  const std::vector<Eigen::Vector3d> places = ballPlaces(result);
  HandEyeGuidanceOptions guidance;
  guidance.ballRadiusMm = result.ballRadiusMm;
  guidance.trackingSigmaMm = options.trackingSigmaMm;
  guidance.segmentationSigmaPx = options.segmentationSigmaPx;
  if (result.calibration.isUsable())
  {
    guidance.trackingSigmaMm = result.calibration.trackingSigmaMm;
    guidance.segmentationSigmaPx = result.calibration.segmentationSigmaPx;
  }
  if (depthsMm)
  {
    guidance.nearestMm = depthsMm->first;
    guidance.furthestMm = depthsMm->second;
  }
  else if (!places.empty())
  {
    const auto byDepth = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); };
    const auto extremes = std::minmax_element(places.begin(), places.end(), byDepth);
    guidance.nearestMm = extremes.first->z();
    guidance.furthestMm = std::max(extremes.second->z(), leastDepthRatio * guidance.nearestMm);
  }
  result.guidance = suggestPlacement(places, { result.camera }, guidance);
}

void moveTips(std::vector<CapturedFrame>& frames, const Eigen::Vector3d& correction_Stylus)
{
  for (CapturedFrame& captured : frames)
  {
    if (captured.tip_Marker)
    {
      *captured.tip_Marker += captured.stylusToMarker * correction_Stylus;
    }
  }
}

const HandEyeCalibrationResult& CalibrationStepResult::decisive() const
{
  const bool isRightAmiss = right && right->calibration && !right->calibration->isUsable();
  return calibration.isUsable() && isRightAmiss ? *right->calibration : calibration;
}

CalibrationStepResult calibrateCapture(const EyeCapture& capture, const HandEyeCalibrationOptions& options)
{
  const HandEyeCalibrationResult calibration = calibrateHandEye(toSamples(capture.frames), { { capture.camera } }, options);
  return { calibration, capture.camera, toFrames(capture.frames, calibration, 0), {}, {}, 0, {}, {} };
}

CalibrationStepResult calibrateStereoCapture(const EyeCapture& left, const EyeCapture& right,
  const std::optional<Eigen::Isometry3d>& leftToRight, const HandEyeCalibrationOptions& options)
{
  if (!leftToRight)
  {
    CalibrationStepResult result = calibrateCapture(left, options);
    // One stylus has one tip: the right eye takes the tip that the left eye's samples were refined to.
    HandEyeCalibrationOptions rightOptions = options;
    rightOptions.refineTip = false;
    EyeCapture rightCapture = right;
    if (result.calibration.tipCorrection_Stylus)
    {
      rightOptions.tipCovariance_Stylus = result.calibration.refinedTipCovariance_Stylus;
      moveTips(rightCapture.frames, *result.calibration.tipCorrection_Stylus);
    }
    const CalibrationStepResult other = calibrateCapture(rightCapture, rightOptions);
    result.right = { right.camera, other.frames, other.calibration.markerToCamera, other.calibration };
    return result;
  }
  std::vector<HandEyeSample> samples = toSamples(left.frames, 0);
  const std::size_t leftCount = samples.size();
  const std::vector<HandEyeSample> rightSamples = toSamples(right.frames, 1);
  samples.insert(samples.end(), rightSamples.begin(), rightSamples.end());
  const HandEyeCalibrationResult calibration =
    calibrateHandEye(samples, { { left.camera }, { right.camera, *leftToRight } }, options);
  CalibrationStepResult result{ calibration, left.camera, toFrames(left.frames, calibration, 0), {}, {}, 0, {}, {} };
  result.right = { right.camera, toFrames(right.frames, calibration, leftCount), *leftToRight * calibration.markerToCamera, {} };
  return result;
}

}  // namespace handeye
