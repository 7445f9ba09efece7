// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "BallStages.h"
#include "BallTracker.h"
#include "CameraModel.h"
#include "FramePairing.h"

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <QTimer>

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace handeye
{

class WorkThread;

/// A frame of the live video with what was found in it.
struct LiveView
{
  devices::PairedFrame frame;
  std::optional<devices::PairedFrame> right;  ///< of a stereo rig's right eye, the nearest in time
  std::optional<BallDetection> ball;          ///< if the ball was looked for
  std::optional<BallStages> stages;           ///< if the pictures were asked for, a few times a second
  QString problem;                            ///< why the ball could not be looked for, a sentence

  const cv::Mat& image() const { return frame.image.frame()->image; }
};

/// What happens to each frame of the live video beside the window: the ball is looked for, who listens is told (captures, a
/// measurement of the latency), and the frame is handed to the window. Frames that come too fast are left out, in the work as in
/// the window; the last one that came is shown in any case, if a moment later.
///
/// Belongs to the thread of the user interface; take() may be called from any.
class LivePipeline : public QObject
{
  Q_OBJECT

public:
  struct Settings
  {
    std::optional<CameraModel> camera;  ///< without it the ball is not looked for
    double ballRadiusMm = 0;
    BallDetectionOptions detection;
    bool detects = false;
    bool drawsStages = false;
  };
  /// Called for each frame in the work's thread.
  using Listener = std::function<void(const devices::PairedFrame&, const std::optional<BallDetection>&)>;

  explicit LivePipeline(WorkThread& work, QObject* parent = nullptr);

  void setSettings(const Settings& settings);
  const Settings& settings() const { return settings_; }

  /// To be called before frames come.
  void addListener(Listener listener) { listeners_.push_back(std::move(listener)); }

  /// A frame of the video, from whatever thread.
  void take(const devices::PairedFrame& frame);
  /// A frame of a stereo rig's right eye, from whatever thread; it is shown with the left eye's frame of its moment.
  void takeRight(const devices::PairedFrame& frame);

  /// The newest frame that was shown; null before the first.
  std::shared_ptr<const LiveView> newest() const { return newest_; }
  void clear();

signals:
  /// A frame is to be shown; at most 30 a second.
  void shown();

private:
  void process(const devices::PairedFrame& frame);
  void lookForBall(LiveView& view);
  std::optional<devices::PairedFrame> rightAt(double timeSec);
  void publish(const std::shared_ptr<LiveView>& view);
  void show();

  WorkThread& work_;
  Settings settings_;
  std::vector<Listener> listeners_;
  std::shared_ptr<const LiveView> newest_;
  QElapsedTimer sinceShown_;
  QTimer nextShowing_;  ///< runs while a frame waits for its turn

  // Of the work's thread
  Settings active_;
  std::unique_ptr<BallTracker> tracker_;
  QElapsedTimer sinceStages_;

  std::mutex mutex_;
  std::shared_ptr<LiveView> pending_;       ///< on its way to the window
  std::deque<devices::PairedFrame> right_;  ///< the newest few
};

}  // namespace handeye
