// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SecondLook.h"

#include "BallDetector.h"

namespace handeye
{

std::vector<int> lookAgain(const io::Recording& recording, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options, const Eigen::Isometry3d& markerToCamera, double sigmaPx, std::vector<CapturedFrame>& frames)
{
  const BallDetector detector(camera, ballRadiusMm, options);
  std::vector<int> decided;
  for (CapturedFrame& captured : frames)
  {
    if (captured.ball.status != BallDetection::Status::SeveralBalls || !captured.tip_Marker)
    {
      continue;
    }
    const BallPrediction prediction{ markerToCamera * *captured.tip_Marker, sigmaPx };
    const BallDetection again = detector.detect(recording.image(captured.frame), prediction);
    if (again.isFound())
    {
      captured.ball = again;
      captured.status = toString(again.status);
      captured.message = "several things looked like the ball, one of them where the tracker puts it";
      decided.push_back(captured.frame);
    }
  }
  return decided;
}

}  // namespace handeye
