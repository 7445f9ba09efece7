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
#include <QTimer>

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
  static constexpr double DefaultSec = 6;

  explicit LatencyTask(WorkThread& work, QObject* parent = nullptr);

  /// Collects for some seconds; measured() or refused() follow, in any case: where the video stops for longer than the silence that
  /// is borne, the measurement ends with that reason.
  void start(const CameraModel& camera, const Eigen::Vector3d& tip_Stylus, const QString& markerToTracker,
    const QString& stylusToTracker, double seconds = DefaultSec);
  void cancel();
  bool isRunning() const { return isRunning_; }

  /// A usable result for a person: which of the two is late, by how much, how exact that is, and whether that is good enough. They are
  /// in time only where a difference as large as the measured one does not matter; that the noise hides it is not enough.
  static QString words(const TemporalCalibrationResult& result);

  /// 5 s unless set.
  void setLongestSilence(int milliseconds) { silence_.setInterval(milliseconds); }

  void onSample(const devices::DeviceSample& sample);
  void onFrame(const devices::PairedFrame& frame, const std::optional<BallDetection>& ball);

signals:
  void runningChanged();
  /// 0 to 1.
  void progressed(double share);
  void measured(const handeye::TemporalCalibrationResult& result);
  void refused(const QString& message);

private:
  void endInSilence();
  void evaluate(int run);

  struct Collection
  {
    CameraModel camera;
    Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
    std::string markerToTracker, stylusToTracker;
    PoseTrack marker, stylus;
    std::vector<BallSighting> sightings;
    double seconds = 0, beginSec = -1;
    int run = 0;  ///< whose it is
  };

  WorkThread& work_;
  bool isRunning_ = false;
  int run_ = 0;     ///< counts the starts: what an earlier one found late is nobody's
  QTimer silence_;  ///< runs while frames are waited for

  std::mutex mutex_;  ///< of what follows
  std::optional<Collection> collection_;
};

}  // namespace handeye
