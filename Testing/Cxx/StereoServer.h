// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OpenIGTLinkMessage.h"
#include "OpenIGTLinkServer.h"

#include <Eigen/Geometry>
#include <QObject>
#include <QTimer>
#include <opencv2/core.hpp>

#include <memory>

/// An OpenIGTLink server with the marker of a stereo rig, a phantom, and a video of one grey for each eye.
class StereoServer : public QObject
{
public:
  static constexpr int LeftGrey = 90, RightGrey = 150;

  StereoServer()
  {
    handeye::devices::OpenIGTLinkServerOptions options;
    options.port = 0;
    server_ = std::make_unique<handeye::devices::OpenIGTLinkServer>(options);
    connect(&timer_, &QTimer::timeout, this, [this] { send(); });
    timer_.start(40);
  }

  int port() const { return server_->port(); }
  void setPoses(const Eigen::Isometry3d& markerToTracker, const Eigen::Isometry3d& phantomToTracker)
  {
    markerToTracker_ = markerToTracker;
    phantomToTracker_ = phantomToTracker;
  }
  void setRightSent(bool sent) { isRightSent_ = sent; }

private:
  void send()
  {
    const double timeSec = handeye::devices::systemTimeSec();
    ++count_;
    const auto sendPose = [&](const char* name, const Eigen::Isometry3d& transform)
    {
      Eigen::Matrix4d pose = transform.matrix();
      pose(0, 3) += 0.001 * (count_ % 7);  // never the same bits: a tracker's noise
      server_->send(handeye::devices::packTransform(name, timeSec, pose, { { "TransformStatus", "OK" } }));
    };
    sendPose("MarkerToTracker", markerToTracker_);
    sendPose("PhantomToTracker", phantomToTracker_);
    server_->send(handeye::devices::packImage("LeftVideo", timeSec, cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(LeftGrey))));
    if (isRightSent_)
    {
      server_->send(handeye::devices::packImage("RightVideo", timeSec, cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(RightGrey))));
    }
  }

  std::unique_ptr<handeye::devices::OpenIGTLinkServer> server_;
  QTimer timer_;
  Eigen::Isometry3d markerToTracker_ = Eigen::Isometry3d::Identity(), phantomToTracker_ = Eigen::Isometry3d::Identity();
  bool isRightSent_ = true;
  int count_ = 0;
};
