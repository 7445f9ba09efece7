// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceSample.h"
#include "PivotCollector.h"
#include "PivotStep.h"

#include <QObject>
#include <QString>
#include <QTimer>

#include <memory>
#include <mutex>
#include <string>

namespace handeye
{

class WorkThread;

/// Pivot calibration of the stylus, live or from a recording; see PivotCollector and pivotFromRecording().
///
/// Belongs to the thread of the user interface; onSample() to the sources'.
class PivotTask : public QObject
{
  Q_OBJECT

public:
  /// How the pivoting stands.
  struct State
  {
    PivotCollector::Counts counts;
    PivotCalibrationResult estimate;
    DomeCoverage coverage;
    double predictedTipErrorMm = 0;
    bool hasTipMoved = false, isEnough = false;
  };

  explicit PivotTask(WorkThread& work, QObject* parent = nullptr);

  /// Collects from now on the poses of this name.
  void start(const QString& stylusToTracker);
  /// Ends it and calibrates with what there is: calibrated() or refused() follow.
  void finish();
  /// Ends it without a result.
  void cancel();
  bool isCollecting() const { return isCollecting_; }
  const State& state() const { return state_; }

  void calibrateRecording(const QString& path, const QString& stylusToTracker);

  /// A sample of the live sources, in their thread.
  void onSample(const devices::DeviceSample& sample);

signals:
  /// Ten times a second while it collects.
  void progressed();
  void collectingChanged();
  void calibrated(const handeye::PivotStepResult& result);
  /// No usable result, in words.
  void refused(const QString& message);

private:
  void poll();
  void tell(const PivotStepResult& result);

  WorkThread& work_;
  bool isCollecting_ = false;
  State state_;
  QTimer timer_;

  std::mutex mutex_;                           ///< of what follows
  std::shared_ptr<PivotCollector> collector_;  ///< null while nothing is collected
  std::string name_;
};

}  // namespace handeye
