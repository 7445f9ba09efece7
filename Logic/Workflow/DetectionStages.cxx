// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DetectionStages.h"

#include "BallStages.h"
#include "FileError.h"
#include "ImageFile.h"

#include <cstdio>
#include <system_error>

namespace handeye
{

void writeDetectionStages(const std::filesystem::path& folder, const io::Recording& recording, const CameraModel& camera,
  double ballRadiusMm, const BallDetectionOptions& options, const std::vector<CapturedFrame>& frames)
{
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
  {
    throw io::FileError(folder, "the folder cannot be made: " + failed.message());
  }
  for (const CapturedFrame& captured : frames)
  {
    if (!recording.hasImage(captured.frame))
    {
      continue;
    }
    const BallStages stages = drawBallStages(recording.image(captured.frame), captured.ball, camera, ballRadiusMm, options);
    char number[16];
    std::snprintf(number, sizeof number, "%04d", captured.frame);
    const auto write = [&](const char* name, const cv::Mat& picture)
    { io::writePng(folder / (std::string(number) + name), picture); };
    write("-1-mask.png", stages.mask);
    write("-2-smoothed.png", stages.smoothed);
    write("-3-edges.png", stages.edges);
    write("-4-outline.png", stages.outline);
  }
}

}  // namespace handeye
