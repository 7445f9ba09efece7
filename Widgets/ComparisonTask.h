// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SessionComparison.h"

#include <QObject>
#include <QString>

#include <atomic>
#include <functional>
#include <memory>

namespace handeye
{

class WorkThread;

/// The comparison of all methods on a session's samples, and its report. It takes seconds to minutes, and has a thread of its own:
/// live video, captures and results that are stored do not wait for it.
///
/// Belongs to the thread of the user interface.
class ComparisonTask : public QObject
{
  Q_OBJECT

public:
  explicit ComparisonTask(QObject* parent = nullptr);
  ~ComparisonTask() override;

  /// finished() follows, or refused(); or neither, after cancel(). Nothing happens while it works.
  void start(const SessionComparisonInput& input);
  /// Gives it up at its next step; the result of before stays.
  void cancel();
  /// Gives it up and forgets the result.
  void clear();
  /// report.html, report.pdf and the data into a folder: reportWritten() follows, or refused(). Needs a result.
  void writeReport(const QString& folder);

  bool isWorking() const { return isWorking_; }
  bool isCancelling() const { return isWorking_ && *isCancelled_; }
  /// The last one that came to its end, and what it was made from; null if there is none.
  std::shared_ptr<const SessionComparison> result() const { return result_; }
  const SessionComparisonInput& input() const { return input_; }

signals:
  void progressed(const QString& what, int done, int total);
  /// Working began or ended, or the result is another.
  void changed();
  void finished();
  void reportWritten(const QString& path);
  void refused(const QString& message);

private:
  using Flag = std::shared_ptr<std::atomic<bool>>;

  void work(const SessionComparisonInput& input, const Flag& isCancelled, const WorkThread& thread);
  void begin();
  void end();
  void tell(std::function<void()> news);

  SessionComparisonInput input_;
  std::shared_ptr<const SessionComparison> result_;
  bool isWorking_ = false;
  Flag isCancelled_;
  std::unique_ptr<WorkThread> work_;
};

}  // namespace handeye
