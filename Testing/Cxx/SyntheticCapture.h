// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "PivotSimulation.h"
#include "SequenceMetafileWriter.h"
#include "Simulation.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace handeye::test
{

/// Small recordings of a tracked ball before a tracked camera, with all that a user's recordings have wrong in them; the same
/// numbers at every run.
struct SyntheticCapture
{
  CameraModel camera = makeCamera(320, 240, 301.3, 302.1, 158.4, 121.7, { 0.04, -0.1, -0.0007, 0.0011, 0.02 });
  Eigen::Isometry3d markerToCamera = typicalMarkerToCamera();
  PivotSimulation stylus;
  double ballRadiusMm = 12;
  double trackingSigmaMm = 0.1;  ///< at the tip

  int frameCount = 14;
  std::vector<int> withoutBall;              ///< frames in which it is out of view
  std::vector<int> stylusInvalid;            ///< frames in which the tracker has lost the stylus
  std::map<int, Eigen::Vector3d> displaced;  ///< mm, by which the tracked tip is wrong
  bool isTracked = true;                     ///< otherwise the recording has no transforms
  std::string stylusTransform = "StylusToTracker";
  std::string markerTransform = "MarkerToTracker";

  /// An OpenCV camera file.
  void writeCamera(const std::filesystem::path& path) const
  {
    std::ofstream file(path);
    file << "%YAML:1.0\n---\nimage_width: " << camera.width() << "\nimage_height: " << camera.height()
         << "\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ " << camera.fx() << ", 0., "
         << camera.cx() << ", 0., " << camera.fy() << ", " << camera.cy() << ", 0., 0., 1. ]\n"
         << "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: " << camera.distortionCoefficients().size()
         << "\n   dt: d\n   data: [ ";
    for (std::size_t i = 0; i < camera.distortionCoefficients().size(); ++i)
    {
      file << (i > 0 ? ", " : "") << camera.distortionCoefficients()[i];
    }
    file << " ]\n";
  }

  /// The stylus pivoting about its tip; transforms only.
  void writePivot(const std::filesystem::path& path, unsigned seed, int poseCount = 80) const
  {
    Random random(seed);
    io::SequenceMetafileWriter writer(path, { false, true, {} });
    for (const Eigen::Isometry3d& pose : stylus.recordPivoting(poseCount, 45 * Degree, random))
    {
      io::SequenceFrame frame;
      frame.transforms[stylusTransform] = { pose.matrix(), "OK" };
      writer.append(frame);
    }
    writer.close();
  }

  /// The ball at random places in view of the camera, whose marker moves about, too.
  void writeBalls(const std::filesystem::path& path, unsigned seed) const
  {
    Random random(seed);
    io::SequenceMetafileWriter writer(path);
    for (int frame = 0; frame < frameCount; ++frame)
    {
      const Eigen::Vector3d ball_Camera = randomPointInView(camera, { 120, 330, 0.15, 0, 0 }, random);
      SphereScene scene(camera);
      if (!has(withoutBall, frame))
      {
        scene.add({ ball_Camera, ballRadiusMm });
      }
      writer.append(track(frame, ball_Camera, random), scene.photograph());
    }
    writer.close();
  }

private:
  static bool has(const std::vector<int>& frames, int frame) { return std::count(frames.begin(), frames.end(), frame) > 0; }

  io::SequenceFrame track(int frame, const Eigen::Vector3d& ball_Camera, Random& random) const
  {
    const Eigen::Isometry3d markerToTracker =
      makeRigid(random.uniform3(0.3), Eigen::Vector3d(20, -40, -1400) + random.uniform3(30));
    Eigen::Vector3d tip_Marker = markerToCamera.inverse() * ball_Camera + random.normal3(trackingSigmaMm);
    if (displaced.count(frame) > 0)
    {
      tip_Marker += displaced.at(frame);
    }
    Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
    stylusToTracker.linear() = random.rotation();
    stylusToTracker.translation() = markerToTracker * tip_Marker - stylusToTracker.linear() * stylus.tip_Stylus;
    io::SequenceFrame tracked;
    if (isTracked)
    {
      tracked.transforms[markerTransform] = { markerToTracker.matrix(), "OK" };
      tracked.transforms[stylusTransform] = { stylusToTracker.matrix(), has(stylusInvalid, frame) ? "INVALID" : "OK" };
    }
    return tracked;
  }
};

}  // namespace handeye::test
