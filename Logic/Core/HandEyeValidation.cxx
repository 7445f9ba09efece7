// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeValidation.h"

namespace handeye
{

HandEyeValidationResult validateHandEye(
  const std::vector<HandEyeSample>& samples, const CameraModel& camera, const Eigen::Isometry3d& markerToCamera)
{
  HandEyeValidationResult result;
  std::vector<double> errors;
  for (const HandEyeSample& sample : samples)
  {
    const Eigen::Vector3d tip_Camera = markerToCamera * sample.tip_Marker;
    const CameraModel::Projection projection = camera.project(tip_Camera);
    HandEyeValidationSample validated;
    validated.frame = sample.frame;
    validated.status = projection.status;
    validated.distanceMm = tip_Camera.norm();
    if (projection.isUsable())
    {
      validated.projected_Image = projection.point_Image;
      validated.errorPx = (projection.point_Image - sample.ball_Image).norm();
      errors.push_back(validated.errorPx);
    }
    result.samples.push_back(validated);
  }
  result.projectionErrorPx = summarize(errors);
  return result;
}

}  // namespace handeye
