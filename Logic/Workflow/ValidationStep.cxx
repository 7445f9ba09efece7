// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationStep.h"

#include <cstdio>

namespace handeye
{

namespace
{

std::string describe(const Summary& errorPx, std::size_t frameCount)
{
  if (errorPx.count == 0)
  {
    return "the ball was found and tracked in none of the " + std::to_string(frameCount) + " frames: nothing could be validated";
  }
  const char* verdict = errorPx.mean < 1 ? "good"
    : errorPx.mean < 3                   ? "fair"
    : errorPx.mean < 20                  ? "poor"
                                         : "the calibration does not hold here";
  constexpr int EnoughFrames = 5;
  const bool isFew = errorPx.count < EnoughFrames;
  char text[200];
  std::snprintf(text, sizeof(text), "%s%s: projection error %.2f px mean, %.2f px RMS, %.2f px at most, over %d of %zu frames",
    verdict, isFew ? " so far" : "", errorPx.mean, errorPx.rms, errorPx.maximum, errorPx.count, frameCount);
  return text + std::string(isFew ? "; few to judge by, " + std::to_string(EnoughFrames) + " or more are wanted" : "");
}

}  // namespace

ValidationStepResult validateCapture(
  const std::vector<CapturedFrame>& frames, const CameraModel& camera, const Eigen::Isometry3d& markerToCamera)
{
  ValidationStepResult result;
  result.subject.camera = camera;
  const HandEyeValidationResult validation = validateHandEye(toSamples(frames), camera, markerToCamera);
  std::size_t next = 0;
  for (const CapturedFrame& captured : frames)
  {
    ValidatedFrame frame{ captured, captured.status, {} };
    if (captured.isSample())
    {
      frame.validated = validation.samples[next++];
      frame.status = toString(frame.validated->status);
    }
    result.frames.push_back(std::move(frame));
  }
  result.projectionErrorPx = validation.projectionErrorPx;
  result.message = describe(result.projectionErrorPx, frames.size());
  return result;
}

}  // namespace handeye
