// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "FramePairing.h"
#include "LensCalibration.h"

#include <Eigen/Core>
#include <QObject>
#include <QString>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace handeye
{

class WorkThread;

/// Calibration of the lens, from live video or from a recording of a board; see LensViewCollector and calibrateLens().
///
/// Live, views are taken hands-free: start(), show the board, calibrate(). The board is looked for in the work's thread; pictures that
/// come while it is busy are left out. cancel() stops a recording between two pictures; a fit under way runs to its end beside the
/// window, and its result is thrown away.
///
/// Belongs to the thread of the user interface; onFrame() to the work's.
class LensTask : public QObject
{
  Q_OBJECT

public:
  /// How the collecting stands.
  struct State
  {
    int width = 0, height = 0;  ///< of the pictures, px; 0 before the first
    int pictures = 0, withBoard = 0, views = 0;
    Eigen::MatrixXi coverage;                   ///< points seen per cell, rows from the top
    std::vector<Eigen::Vector2d> points_Image;  ///< of the views, px
    double coverageShare = 0;
    double completeness = 0;  ///< 0 to 1, see LensViewCollector
    bool wasTaken = false;    ///< the newest picture
    QString seen;             ///< what became of the newest picture
    QString hint;             ///< what to do next
  };
  struct Result
  {
    BoardDescription board;
    LensCalibrationResult calibration;
  };

  explicit LensTask(WorkThread& work, QObject* parent = nullptr);
  ~LensTask() override;

  /// Takes views of this board from now on; goes on where it was if it is the board of before.
  void start(const BoardDescription& board);
  /// Takes no more; the views stay.
  void stop();
  /// Forgets the views, and the result.
  void clear();
  /// From the views taken, in the work's thread: calibrated() or refused() follow.
  void calibrate();
  /// Views of all pictures of a recording, and the lens from them.
  void calibrateRecording(const QString& path, const BoardDescription& board);
  /// Gives up a calibration under way; the views that were taken stay.
  void cancel();

  bool isCollecting() const { return isCollecting_; }
  bool isWorking() const { return isWorking_; }
  bool isCancelling() const { return isWorking_ && *isCancelled_; }
  const State& state() const { return state_; }
  /// The last that was tried, usable or not.
  const std::optional<Result>& result() const { return result_; }

  /// A frame of the live video, in the work's thread.
  void onFrame(const devices::PairedFrame& frame);

signals:
  /// After each picture.
  void progressed();
  /// Of a recording: pictures done, and how many there are.
  void worked(int done, int total);
  /// Collecting or working began or ended, or the views or the result are others.
  void changed();
  void calibrated();
  /// No usable result, in words.
  void refused(const QString& message);

private:
  struct Collection;
  using Flag = std::shared_ptr<std::atomic<bool>>;

  void setLive(const std::shared_ptr<Collection>& collection);
  void publish(const std::shared_ptr<Collection>& collection);
  Flag beginWork();
  void tell(std::function<void()> news);
  bool readRecording(const QString& path, const std::shared_ptr<Collection>& collection, const Flag& isCancelled);
  void work(const std::shared_ptr<Collection>& collection, const Flag& isCancelled, const std::function<bool()>& prepare);
  static QString refusal(const Collection& collection, const LensCalibrationResult& result);

  WorkThread& work_;
  bool isCollecting_ = false, isWorking_ = false;
  Flag isCancelled_;
  State state_;
  std::optional<Result> result_;
  std::shared_ptr<Collection> collection_;  ///< its contents belong to the work's thread

  std::mutex mutex_;                  ///< of what follows
  std::shared_ptr<Collection> live_;  ///< null while nothing is collected
};

}  // namespace handeye
