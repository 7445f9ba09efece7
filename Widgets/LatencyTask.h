// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CameraModel.h"
#include "FramePairing.h"
#include "PoseTrack.h"
#include "TemporalCalibration.h"

#include <Eigen/Core>
#include <QObject>
#include <QString>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

class WorkThread;

/// Measures how far video and tracker are apart in time, from some seconds of a ball that moves; see calibrateLatency().
///
/// Belongs to the thread of the user interface; onSample() to the sources' and onFrame() to the work's.
class LatencyTask : public QObject
{
  Q_OBJECT

public:
  explicit LatencyTask(WorkThread& work, QObject* parent = nullptr);

  /// Collects for some seconds; measured() or refused() follow.
  void start(const CameraModel& camera, const Eigen::Vector3d& tip_Stylus, const QString& markerToTracker,
    const QString& stylusToTracker, double seconds = 6);
  void cancel();
  bool isRunning() const { return isRunning_; }

  void onSample(const devices::DeviceSample& sample);
  void onFrame(const devices::PairedFrame& frame, const std::optional<BallDetection>& ball);

signals:
  void runningChanged();
  /// 0 to 1.
  void progressed(double share);
  void measured(const handeye::TemporalCalibrationResult& result);
  void refused(const QString& message);

private:
  void evaluate();

  struct Collection
  {
    std::string markerToTracker, stylusToTracker;
    PoseTrack marker, stylus;
    std::vector<BallSighting> sightings;
    double seconds = 0, beginSec = -1;
  };

  WorkThread& work_;
  bool isRunning_ = false;
  std::optional<CameraModel> camera_;
  Eigen::Vector3d tip_Stylus_ = Eigen::Vector3d::Zero();
  std::mutex mutex_;
  std::optional<Collection> collection_;
};

}  // namespace handeye
