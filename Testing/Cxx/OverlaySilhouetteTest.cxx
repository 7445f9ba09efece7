// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Path-traced pictures of a phantom, with true transforms and masks: the overlay's silhouette against the rendered one. The poses
// of the recordings carry the tracker's noise (0.12 mm, 0.025 deg on each of two markers), which moves a silhouette as a whole.
#include "CameraFile.h"
#include "OverlayPose.h"
#include "OverlayTestScene.h"
#include "Recording.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <fstream>
#include <iostream>

namespace
{

using namespace handeye::test;

std::string demo(const std::string& name)
{
  return std::string(HANDEYE_RESOURCES_DIR) + "/Demo/" + name;
}

Eigen::Isometry3d transformOf(const nlohmann::json& rows)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      transform.matrix()(row, column) = rows.at(std::size_t(row)).at(std::size_t(column)).get<double>();
    }
  }
  return transform;
}

using Contour = std::vector<cv::Point2d>;

/// The outline of a mask to a fraction of a pixel: where its blurred edge is half way, on the lines between pixel centres.
Contour contourOf(const cv::Mat& mask)
{
  cv::Mat smooth;
  mask.convertTo(smooth, CV_32F, 1 / 255.0);
  cv::GaussianBlur(smooth, smooth, {}, 1.0);
  Contour contour;
  const auto add = [&](int u, int v, int du, int dv)
  {
    const float here = smooth.at<float>(v, u) - 0.5f, there = smooth.at<float>(v + dv, u + du) - 0.5f;
    if ((here < 0) != (there < 0))
    {
      const double share = double(here) / (double(here) - there);
      contour.emplace_back(u + share * du, v + share * dv);
    }
  };
  for (int v = 0; v + 1 < mask.rows; ++v)
  {
    for (int u = 0; u + 1 < mask.cols; ++u)
    {
      add(u, v, 1, 0);
      add(u, v, 0, 1);
    }
  }
  return contour;
}

std::vector<double> distances(const Contour& from, const Contour& to)
{
  std::vector<double> result;
  for (const cv::Point2d& point : from)
  {
    double nearest = 1e9;
    for (const cv::Point2d& other : to)
    {
      nearest = std::min(nearest, cv::norm(point - other));
    }
    result.push_back(nearest);
  }
  return result;
}

struct EdgeDistance
{
  double meanPx = 0, maxPx = 0;
};

EdgeDistance edgeDistance(const cv::Mat& ours, const cv::Mat& truth)
{
  const Contour a = contourOf(ours), b = contourOf(truth);
  std::vector<double> all = distances(a, b);
  const std::vector<double> back = distances(b, a);
  all.insert(all.end(), back.begin(), back.end());
  EdgeDistance result;
  for (const double distance : all)
  {
    result.meanPx += distance / double(all.size());
    result.maxPx = std::max(result.maxPx, distance);
  }
  return result;
}

}  // namespace

TEST(OverlaySilhouette, OfTheDemosPhantom_IsTheRenderedOne)
{
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(demo("truth.json")));
  const handeye::OverlayTransforms transforms{ transformOf(truth.at("markerToCamera")), transformOf(truth.at("modelToPhantom")) };
  const Pipeline pipeline = fieldPipeline(handeye::io::readCameraFile(demo("camera.yml")).camera);
  pipeline->SetVideoFrame({});
  double sumPx = 0;
  int frames = 0;
  for (const std::string capture : { "calibration", "validation" })
  {
    const handeye::io::Recording recording = handeye::io::Recording::open(demo(capture));
    for (int frame = 0; frame < recording.frameCount(); ++frame)
    {
      const handeye::OverlayPose pose = handeye::overlayPose(recording, frame, "MarkerToTracker", "PhantomToTracker", transforms);
      ASSERT_TRUE(pose.isUsable()) << pose.message;
      pipeline->SetModelToCamera(handeye::toVtk(*pose.modelToCamera));
      char name[32];
      std::snprintf(name, sizeof(name), "/mask/%04d.png", frame);
      // 255: seen; 128: something stands before it. The silhouette is both.
      const cv::Mat mask = cv::imread(demo(capture) + name, cv::IMREAD_GRAYSCALE) > 0;
      ASSERT_FALSE(mask.empty()) << name;
      const EdgeDistance off = edgeDistance(renderedMask(pipeline), mask);
      std::cout << capture << " frame " << frame << ": edges " << off.meanPx << " px apart, at most " << off.maxPx << " px\n";
      EXPECT_LT(off.meanPx, 1.5) << capture << " frame " << frame;  // one frame's noise alone; the mean below is what counts
      sumPx += off.meanPx;
      ++frames;
    }
  }
  ASSERT_EQ(frames, 23);
  std::cout << "mean over " << frames << " frames: " << sumPx / frames << " px\n";
  EXPECT_LE(sumPx / frames, 0.7);
}
