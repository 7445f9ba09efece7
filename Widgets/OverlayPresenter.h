// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeWorkbench.h"
#include "LiveOverlay.h"
#include "OverlayLook.h"
#include "OverlayRecordingTask.h"
#include "VideoView.h"

#include <QObject>

#include <memory>
#include <optional>
#include <vector>

namespace handeye
{

/// What a person is told about the overlay as it was last drawn.
struct OverlayState
{
  QString problem;  ///< why the model is not drawn, or fades, a sentence; empty if all is well
  bool isDrawn = false;
  double delaySec = 0;   ///< of the smoothing
  bool hasHalo = false;  ///< the calibration's covariance is known
  std::optional<double> predictedErrorPx;
  QString stereoProblem;  ///< why there is no picture for two eyes, a sentence; empty if there can be one
};

/// How the picture is given to one or two eyes.
struct OverlayStereo
{
  std::optional<vtkHandEyeStereoOverlay::Layout> layout;  ///< nothing: the left (or only) eye alone
  bool isSwapped = false;
};

/// The model on the live video: its place comes from LiveOverlay, so that it fades, and says which tool is hidden, and never stays
/// where it was. On the pages Overlay and Finish; elsewhere the video is plain.
///
/// The poses of every frame go in, valid or not; they have the latency in them already (devices::FramePairing), it is not applied
/// again.
///
/// With a stereo rig's calibration and the right eye's video, both eyes are drawn, each with its own lens and hand-eye. What is
/// shown can be recorded; that ends when another page than these is entered.
class OverlayPresenter : public QObject
{
  Q_OBJECT

public:
  OverlayPresenter(HandEyeWorkbench& workbench, VideoView& view, QObject* parent = nullptr);

  /// The frame that the view has now.
  void show(const LiveView& shown);

  /// No picture has come for so long: a model on one that stands still looks right and is not.
  void leaveOldPicture(int silentMs);

  void setLook(const OverlayLook& look);
  const OverlayLook& look() const { return look_; }
  /// 0 to 1
  void setOpacity(double opacity);
  double opacity() const { return opacity_; }
  void setSmoothing(bool smooth);

  /// What is wanted; it takes effect while there are two eyes.
  void setStereo(const OverlayStereo& stereo);
  const OverlayStereo& stereo() const { return stereo_; }

  /// A video of what is shown, in the session's folder. @param ending ".mp4" or ".avi"
  void startRecording(const QString& ending);
  void stopRecording() { recording_->stop(); }
  const OverlayRecordingTask& recording() const { return *recording_; }

  /// A key (Qt::Key) that was pressed in the video. @return whether it meant something
  bool handleKey(int key);
  /// What the view shows now becomes a picture of the session.
  void takeSnapshot();

  /// Takes the model out of the view. @param problem why, a sentence; may be empty
  void hide(const QString& problem);

signals:
  void stateChanged(const handeye::OverlayState& state);
  /// A key changed the look, the opacity or what two eyes see.
  void lookChanged();
  void recordingChanged(const handeye::OverlayRecordingState& state);

private:
  struct Poses
  {
    double timeSec = 0;
    std::map<std::string, PoseAtTime> byTool;
  };
  struct Queue;  ///< filled in the work's thread
  /// A picture that is recorded once it has been rendered.
  struct NextPicture
  {
    double timeSec = 0;
    OverlayTransformSet transforms;
  };

  bool isWanted() const;
  void forget();
  void draw(const LiveView& shown, OverlayTransformSet& transforms);
  void feed(const OverlayTransforms& transforms);
  LiveOverlayPose place(LiveOverlay& live, double timeSec, vtkHandEyeOverlayPipeline* pipeline);
  QString showRight(const LiveView& shown, OverlayTransformSet& transforms);
  QString stereoProblem(const LiveView& shown) const;
  void showStylus(vtkHandEyeOverlayPipeline* pipeline, const std::optional<Eigen::Isometry3d>& stylusTipToCamera,
    std::optional<Eigen::Isometry3d>& kept);
  void applyLook();
  void applyCalibration();
  void record();
  bool handleStereoKey(int key);

  HandEyeWorkbench& workbench_;
  VideoView& view_;
  std::shared_ptr<Queue> queue_;
  std::unique_ptr<LiveOverlay> live_, rightLive_;
  double newestSec_ = 0;  ///< of the poses in it
  OverlayLook look_;
  double opacity_ = 0.65;
  bool smooth_ = false;
  OverlayStereo stereo_;
  OverlayRecordingTask* recording_;
  std::optional<NextPicture> next_;
};

}  // namespace handeye
