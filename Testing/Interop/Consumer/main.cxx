// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <CameraFile.h>
#include <PointLineRegistration.h>
#include <ResultFiles.h>
#include <vtkHandEyeOverlayPipeline.h>
#include <vtkNew.h>

#include <cstdio>

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::fprintf(stderr, "usage: consumer CAMERA\n");
    return 2;
  }
  const handeye::io::CameraFile file = handeye::io::readCameraFile(argv[1]);
  vtkNew<vtkHandEyeOverlayPipeline> pipeline;
  pipeline->SetCameraModel(file.camera);
  const handeye::PointLineResult registration = handeye::registerPointsToLines({});
  std::printf("%s lens, fx %.1f px; %s\n", file.format.c_str(), file.camera.fx(), handeye::toString(registration.status).c_str());
  return file.camera.fx() > 0 && !registration.isUsable() ? 0 : 1;
}
