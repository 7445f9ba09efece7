// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetector.h"
#include "Capture.h"
#include "FramePairing.h"

#include <nlohmann/json.hpp>

#include <Eigen/Core>
#include <QImage>
#include <QMap>
#include <QObject>
#include <QString>
#include <QStringList>
#include <QTimer>
#include <QVector>

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace handeye
{

class WorkThread;

/// What it takes to make a sample of a frame.
struct CaptureInputs
{
  CameraModel camera;
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();  ///< mm
  double ballRadiusMm = 0;
  BallDetectionOptions detection;
  ToolNames tools;

  bool operator==(const CaptureInputs& other) const;
};

/// One accepted sample: it is on the disk.
struct CaptureSample
{
  int id = -1;
  QImage thumbnail;
  CapturedFrame captured;
  bool isExcluded = false;
  bool isDeleted = false;  ///< out of sight, but on the disk, and can be brought back

  bool takesPart() const { return !isExcluded && !isDeleted; }
};

/// Collects placements of the ball into a session's folder (io::Session): hands-free when the ball is held still
/// (devices::LiveCapture), when asked to, or from a recording. A sample is announced once it is on the disk. All work is done
/// beside the window.
///
/// Belongs to the thread of the user interface; onFrame() to the work's.
class CaptureTask : public QObject
{
  Q_OBJECT

public:
  explicit CaptureTask(WorkThread& work, QObject* parent = nullptr);
  ~CaptureTask() override;

  /// Opens a session's folder, or makes one; opened() follows, or notOpened(). The samples come when there are inputs.
  void openFolder(const QString& folder);
  /// Lets go of the folder.
  void close();
  bool isOpen() const { return isOpen_; }
  QString folder() const { return folder_; }
  /// How many samples the folder held when it was opened, deleted ones left out, whether they have been looked at or not.
  int storedSampleCount() const { return storedSampleCount_; }

  /// Samples that there are already are evaluated anew where the inputs are others. Nothing: no capture.
  void setInputs(const std::optional<CaptureInputs>& inputs);
  const std::optional<CaptureInputs>& inputs() const { return inputs_; }

  void setHandsFree(bool isHandsFree);
  /// The same in two seconds: who passes through a page takes nothing.
  void beginHandsFree();
  bool isHandsFree() const { return isHandsFree_; }
  /// The next frame becomes a sample, if there is a ball in it and the tracker sees both tools.
  void takeNow();

  void setExcluded(const QVector<int>& ids, bool isExcluded);
  void setDeleted(const QVector<int>& ids, bool isDeleted);

  /// Each frame of a recording in which the ball is found becomes a sample; progress() and imported() tell. Deleting those takes the
  /// import back.
  void importRecording(const QString& path);
  bool isBusy() const { return isBusy_; }
  /// The samples are those of other inputs: they are being evaluated anew, or could not be.
  bool isStale() const { return evaluations_ > 0 || isBroken_; }
  /// Looking at them anew ended early: it failed, or was cancelled.
  bool isBroken() const { return isBroken_ && evaluations_ == 0; }
  /// Looks at the stored samples again, with the inputs as they are.
  void evaluateAgain();

  /// Stores a result or settings with the session.
  void setDocument(const std::string& name, const nlohmann::json& document);

  const QMap<int, CaptureSample>& samples() const { return samples_; }
  /// The samples that take part.
  std::vector<CapturedFrame> frames() const;
  /// What hands-free capturing waits for, or why there was no sample: a sentence.
  QString hint() const { return hint_; }

  /// A frame of the live video, in the work's thread.
  void onFrame(const devices::PairedFrame& frame);

signals:
  /// The folder is open; with its documents, and sentences about what is damaged.
  void opened(const std::map<std::string, nlohmann::json>& documents, const QStringList& problems);
  /// The folder could not be opened: there is no session.
  void notOpened(const QString& message);
  void accepted(int id);
  void samplesChanged();
  void hintChanged();
  void progress(int done, int total, const QString& what);
  void busyChanged();
  /// @param reason why the first frame was refused, if any was
  void imported(const QVector<int>& ids, int refused, const QString& reason);
  void failed(const QString& message);

private:
  struct Work;
  void post(std::function<void(Work&)> step);
  /// From the work's thread; news of a session that is not the open one any more are dropped.
  void tell(std::function<void(CaptureTask&)> news);
  /// In the work's thread: nobody waits for what is being done.
  bool isOutdated(const Work& work) const;
  void setBusy(bool isBusy);
  void setHint(const QString& hint);
  void addSample(const CaptureSample& sample, bool isNew);
  void storeDeleted();
  void evaluateAll(Work& work);
  void endEvaluation(bool isGood);
  void readRecording(Work& work, const std::string& path, const ToolNames& tools);
  void take(Work& work, const devices::PairedFrame& frame);

  WorkThread& thread_;
  std::shared_ptr<Work> work_;
  std::optional<CaptureInputs> inputs_;
  QMap<int, CaptureSample> samples_;
  QString folder_, hint_;
  int storedSampleCount_ = 0;
  bool isOpen_ = false, isHandsFree_ = false, isBusy_ = false;
  QTimer begin_;                   ///< of hands-free taking
  std::atomic<int> session_{ 0 };  ///< counts the folders that were opened or let go of
  int evaluations_ = 0;            ///< under way, after inputs were changed
  bool isBroken_ = false;          ///< the last one failed
};

}  // namespace handeye
