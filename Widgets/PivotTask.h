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

/// Pivot calibration of the stylus, live or from a recording; see PivotCollector and pivotFromRecording(). Live it ends by itself
/// once the tip is known well enough and enough directions are covered.
///
/// Belongs to the thread of the user interface; onSample() to the sources'.
class PivotTask : public QObject
{
  Q_OBJECT

public:
  enum class End
  {
    None,     ///< under way, or there was no pivoting
    Enough,   ///< by itself
    ByPerson  ///< finish() was asked for before
  };

  /// How the pivoting stands; once it has ended, what its result rests on.
  struct State
  {
    PivotCollector::Counts counts;  ///< `kept` are the poses used
    PivotCalibrationResult estimate;
    DomeCoverage coverage;
    double predictedTipErrorMm = 0;
    bool hasTipMoved = false;
    bool isExact = false;  ///< the tip is known well enough
    End end = End::None;
  };
  /// The tip's predicted error that is looked for, mm.
  static double enoughTipErrorMm() { return PivotCollectorOptions().enoughTipErrorMm; }
  /// "290 used of 300: 6 hidden, 4 disagree": of the poses that came, the same wherever it stands.
  static QString wordsOf(const PivotCollector::Counts& counts);

  explicit PivotTask(WorkThread& work, QObject* parent = nullptr);

  /// Collects from now on the poses of this name.
  void start(const QString& stylusToTracker);
  /// Ends it and calibrates with what there is: calibrated() or refused() follow.
  void finish();
  /// Ends it without a result.
  void cancel();
  /// The same, and what was pivoted before is not the stylus of now.
  void forget();
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
  void finishAs(End end);
  void tell(const PivotStepResult& result, int run);

  WorkThread& work_;
  bool isCollecting_ = false;
  int run_ = 0;  ///< counts the starts: what an earlier one found late is nobody's
  State state_;
  QTimer timer_;

  std::mutex mutex_;                           ///< of what follows
  std::shared_ptr<PivotCollector> collector_;  ///< null while nothing is collected
  std::string name_;
};

}  // namespace handeye
