// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeWorkbench.h"
#include "LiveOverlay.h"
#include "OverlayLook.h"
#include "VideoView.h"

#include <QObject>
#include <QTimer>

#include <memory>
#include <optional>
#include <vector>

namespace handeye
{

/// What a person is told about the overlay as it was last drawn.
struct OverlayState
{
  QString problem;       ///< why the model is not drawn, or fades, a sentence; empty if all is well
  double delaySec = 0;   ///< of the smoothing
  bool hasHalo = false;  ///< the calibration's covariance is known
  std::optional<double> predictedErrorPx;
};

/// The model on the live video: its place comes from LiveOverlay, so that it fades, and says which tool is hidden, and never stays
/// where it was. On the pages Overlay and Finish; elsewhere the video is plain.
///
/// The poses of every frame go in, valid or not; they have the latency in them already (devices::FramePairing), it is not applied
/// again.
class OverlayPresenter : public QObject
{
  Q_OBJECT

public:
  OverlayPresenter(HandEyeWorkbench& workbench, VideoView& view, QObject* parent = nullptr);

  /// The frame that the view has now.
  void show(const LiveView& shown);

  void setLook(const OverlayLook& look);
  const OverlayLook& look() const { return look_; }
  /// 0 to 1
  void setOpacity(double opacity);
  double opacity() const { return opacity_; }
  void setSmoothing(bool smooth);

  /// A key (Qt::Key) that was pressed in the video. @return whether it meant something
  bool handleKey(int key);
  /// What the view shows now becomes a picture of the session.
  void takeSnapshot();

  /// Takes the model out of the view. @param problem why, a sentence; may be empty
  void hide(const QString& problem);

signals:
  void stateChanged(const handeye::OverlayState& state);
  /// A key changed the look or the opacity.
  void lookChanged();

private:
  struct Poses
  {
    double timeSec = 0;
    std::map<std::string, PoseAtTime> byTool;
  };
  struct Queue;  ///< filled in the work's thread

  bool isWanted() const;
  void forget();
  void feed(const OverlayTransforms& transforms);
  void showStylus(const devices::PairedFrame& frame);
  void applyLook();
  void applyCalibration();

  HandEyeWorkbench& workbench_;
  VideoView& view_;
  std::shared_ptr<Queue> queue_;
  std::unique_ptr<LiveOverlay> live_;
  double newestSec_ = 0;  ///< of the poses in it
  OverlayLook look_;
  double opacity_ = 0.65;
  bool smooth_ = false;
  QTimer silence_;  ///< runs out when no picture comes any more
};

}  // namespace handeye
