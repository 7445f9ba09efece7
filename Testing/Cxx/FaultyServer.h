// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OpenIGTLinkMessage.h"
#include "OpenIGTLinkServer.h"

#include <QObject>
#include <QTimer>

#include <memory>

/// An OpenIGTLink server with a stylus and a marker that lie still, and a grey video without a ball; whatever can go wrong, does
/// when told.
class FaultyServer : public QObject
{
public:
  FaultyServer()
  {
    handeye::devices::OpenIGTLinkServerOptions options;
    options.port = 0;
    server_ = std::make_unique<handeye::devices::OpenIGTLinkServer>(options);
    connect(&timer_, &QTimer::timeout, this, [this] { send(); });
    timer_.start(40);
  }

  int port() const { return server_->port(); }
  /// Whether the tracker sees the stylus.
  void setStylusSeen(bool seen) { isStylusSeen_ = seen; }
  void stop()
  {
    timer_.stop();
    server_.reset();
  }

private:
  void send()
  {
    const double timeSec = handeye::devices::systemTimeSec();
    ++count_;
    for (const char* name : { "MarkerToTracker", "StylusToTracker", "PhantomToTracker" })
    {
      Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
      pose(0, 3) = 0.01 * (count_ % 7);  // never the same bits: a tracker's noise
      const bool isSeen = isStylusSeen_ || name != std::string("StylusToTracker");
      server_->send(handeye::devices::packTransform(name, timeSec, pose, { { "TransformStatus", isSeen ? "OK" : "INVALID" } }));
    }
    server_->send(handeye::devices::packImage("Video", timeSec, cv::Mat(480, 640, CV_8UC3, cv::Scalar(120, 121, 119))));
  }

  std::unique_ptr<handeye::devices::OpenIGTLinkServer> server_;
  QTimer timer_;
  bool isStylusSeen_ = true;
  int count_ = 0;
};
