// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceSample.h"
#include "SpinStep.h"

#include <Eigen/Core>
#include <QObject>
#include <QString>
#include <QTimer>

#include <mutex>
#include <string>
#include <vector>

namespace handeye
{

class WorkThread;

/// Spin calibration of the stylus, live: the direction of its shaft, from poses while it is turned about it; see calibrateSpin().
/// It ends by itself once the shaft is known well enough.
///
/// Belongs to the thread of the user interface; onSample() to the sources'.
class SpinTask : public QObject
{
  Q_OBJECT

public:
  /// With so many poses, spun by so much (rad, RMS) and known to so much (rad), it is enough.
  static constexpr int EnoughPoses = 300;
  static constexpr double EnoughSpin = 0.5, EnoughSigma = 0.005;

  /// How the spinning stands.
  struct State
  {
    int poses = 0;   ///< that were collected
    int hidden = 0;  ///< the tracker did not see the stylus
    SpinCalibrationResult estimate;

    /// What is there of what is enough, 0 to 1.
    double share() const;
    bool isEnough() const;
  };

  explicit SpinTask(WorkThread& work, QObject* parent = nullptr);

  /// Collects from now on the poses of this name. @param tip_Stylus mm
  void start(const QString& stylusToTracker, const Eigen::Vector3d& tip_Stylus);
  /// Ends it and calibrates with what there is: calibrated() or refused() follow.
  void finish();
  /// Ends it without a result.
  void cancel();
  bool isCollecting() const { return isCollecting_; }
  const State& state() const { return state_; }

  /// A sample of the live sources, in their thread.
  void onSample(const devices::DeviceSample& sample);

signals:
  /// A few times a second while it collects.
  void progressed();
  void collectingChanged();
  void calibrated(const handeye::SpinStepResult& result);
  /// No usable result, in words.
  void refused(const QString& message);

private:
  /// What came, in its order: frame i is the i-th pose that came, seen or not.
  struct Collection
  {
    std::vector<Eigen::Isometry3d> stylusToTracker;
    std::vector<int> frames, invalidFrames;
    int next = 0;
    int each = 1;  ///< every so many-th is kept: memory does not grow with time
  };
  static SpinStepResult calibrate(const Collection& collection, const Eigen::Vector3d& tip_Stylus);
  void poll();
  void end();

  WorkThread& work_;
  bool isCollecting_ = false, isEstimating_ = false;
  int run_ = 0;  ///< counts the starts: what an earlier one found late is nobody's
  Eigen::Vector3d tip_Stylus_ = Eigen::Vector3d::Zero();
  State state_;
  QTimer timer_;

  std::mutex mutex_;  ///< of what follows
  Collection collection_;
  std::string name_;  ///< empty while nothing is collected
};

}  // namespace handeye
