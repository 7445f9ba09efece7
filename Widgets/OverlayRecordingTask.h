// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LiveOverlayRecorder.h"

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <QTimer>

#include <memory>

namespace handeye
{

/// What a person is told about the video that is being recorded, or was recorded last.
struct OverlayRecordingState
{
  enum class Phase
  {
    Idle,
    Recording,
    Finishing,  ///< the last pictures are being written
    Stored,
    Failed
  };
  Phase phase = Phase::Idle;
  double elapsedSec = 0;  ///< since it was begun, by the clock
  int pictureCount = 0;
  int leftOutCount = 0;
  QString message;  ///< a sentence: what was left out and why, or why it failed; may be empty
  QString path;     ///< of the video
};

/// Records the overlay as it is shown: a video, and the transforms of its frames beside it (LiveOverlayRecorder). Encoding and
/// writing are done in a thread beside the window; what was taken when the window closes is written before it is gone.
///
/// Belongs to the thread of the user interface.
class OverlayRecordingTask : public QObject
{
  Q_OBJECT

public:
  explicit OverlayRecordingTask(QObject* parent = nullptr);

  /// Begins a video in this folder (of the session; empty: none is open), which is made. @param ending ".mp4" or ".avi"
  /// @param note a sentence for the state's message while nothing else is to be said
  /// @return false where that is not possible: the state says why
  bool start(const QString& folder, const QString& ending, const QString& note = {});
  void stop();
  bool isRecording() const { return state_.phase == OverlayRecordingState::Phase::Recording; }

  /// A picture as it is shown; without effect while nothing is recorded. @param timeSec as its source says
  void add(const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms);

  const OverlayRecordingState& state() const { return state_; }

signals:
  /// Four times a second while something is recorded, and when it is stored.
  void changed(const handeye::OverlayRecordingState& state);

private:
  void poll();
  void fail(const QString& message);

  std::unique_ptr<LiveOverlayRecorder> recorder_;
  OverlayRecordingState state_;
  QString note_;
  QElapsedTimer clock_;
  QTimer timer_;
};

}  // namespace handeye
