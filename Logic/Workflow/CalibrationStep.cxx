// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationStep.h"

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
      if (calibration.isUsable() && !sample.used)
      {
        frame.status = "disagrees";
      }
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace

const HandEyeCalibrationResult& CalibrationStepResult::decisive() const
{
  return calibration.isUsable() && right && right->calibration ? *right->calibration : calibration;
}

CalibrationStepResult calibrateCapture(const EyeCapture& capture, const HandEyeCalibrationOptions& options)
{
  const HandEyeCalibrationResult calibration = calibrateHandEye(toSamples(capture.frames), { { capture.camera } }, options);
  return { calibration, capture.camera, toFrames(capture.frames, calibration, 0), {}, {}, 0, {} };
}

CalibrationStepResult calibrateStereoCapture(const EyeCapture& left, const EyeCapture& right,
  const std::optional<Eigen::Isometry3d>& leftToRight, const HandEyeCalibrationOptions& options)
{
  if (!leftToRight)
  {
    CalibrationStepResult result = calibrateCapture(left, options);
    const CalibrationStepResult other = calibrateCapture(right, options);
    result.right = { right.camera, other.frames, other.calibration.markerToCamera, other.calibration };
    return result;
  }
  std::vector<HandEyeSample> samples = toSamples(left.frames, 0);
  const std::size_t leftCount = samples.size();
  const std::vector<HandEyeSample> rightSamples = toSamples(right.frames, 1);
  samples.insert(samples.end(), rightSamples.begin(), rightSamples.end());
  const HandEyeCalibrationResult calibration =
    calibrateHandEye(samples, { { left.camera }, { right.camera, *leftToRight } }, options);
  CalibrationStepResult result{ calibration, left.camera, toFrames(left.frames, calibration, 0), {}, {}, 0, {} };
  result.right = { right.camera, toFrames(right.frames, calibration, leftCount), *leftToRight * calibration.markerToCamera, {} };
  return result;
}

}  // namespace handeye
