// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayPresenter.h"

#include "EigenVtk.h"
#include "OverlayStylus.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <vtkMatrix4x4.h>

#include <mutex>
#include <utility>

namespace handeye
{

namespace
{

/// Frames whose poses wait for a frame to be shown; a window that shows none has no use for more.
constexpr std::size_t LongestQueue = 300;

}  // namespace

struct OverlayPresenter::Queue
{
  std::mutex mutex;
  std::vector<Poses> poses;

  void add(const devices::PairedFrame& frame)
  {
    const std::lock_guard lock(mutex);
    if (poses.size() >= LongestQueue)
    {
      poses.erase(poses.begin(), poses.begin() + LongestQueue / 2);
    }
    poses.push_back({ frame.poseTimeSec, frame.poses });
  }
  std::vector<Poses> take()
  {
    const std::lock_guard lock(mutex);
    return std::exchange(poses, {});
  }
};

OverlayPresenter::OverlayPresenter(HandEyeWorkbench& workbench, VideoView& view, QObject* parent)
  : QObject(parent)
  , workbench_(workbench)
  , view_(view)
  , queue_(std::make_shared<Queue>())
{
  workbench.live().addListener(
    [queue = queue_](const devices::PairedFrame& frame, const std::optional<BallDetection>&) { queue->add(frame); });
  connect(&workbench, &HandEyeWorkbench::modelChanged, this,
    [this]
    {
      view_.pipeline()->SetModel(workbench_.model());
      view_.requestRender();
    });
  // What was seen belongs to the devices, the calibration and the registration of its time.
  connect(&workbench.devices(), &DeviceHub::connectionChanged, this, &OverlayPresenter::forget);
  connect(&workbench, &HandEyeWorkbench::registrationChanged, this, &OverlayPresenter::forget);
  connect(&workbench, &HandEyeWorkbench::calibrationChanged, this, &OverlayPresenter::applyCalibration);
  connect(&workbench, &HandEyeWorkbench::stylusChanged, this, &OverlayPresenter::applyCalibration);
  connect(&workbench, &HandEyeWorkbench::ballChanged, this, &OverlayPresenter::applyCalibration);
  connect(&workbench, &HandEyeWorkbench::stepEntered, this, &OverlayPresenter::applyLook);
  // A model on a picture that stands still looks right and is not.
  silence_.setSingleShot(true);
  silence_.setInterval(1500);
  connect(&silence_, &QTimer::timeout, this,
    [this]
    {
      forget();
      hide(tr("No new picture has come for 1.5 s: the model is not drawn on an old one."));
      view_.requestRender();
    });
  view_.pipeline()->SetModelVisible(false);
  view_.pipeline()->SetModelOpacity(opacity_);
}

bool OverlayPresenter::isWanted() const
{
  return workbench_.step() == WizardStep::Overlay || workbench_.step() == WizardStep::Finish;
}

void OverlayPresenter::forget()
{
  live_.reset();
  queue_->take();
}

void OverlayPresenter::applyCalibration()
{
  forget();
  StylusShape shape;
  shape.ballRadiusMm = workbench_.ball().radiusMm;
  shape.hasShaft = workbench_.stylus() && workbench_.stylus()->stylusTipToStylus;
  view_.pipeline()->SetStylusShape(shape);
  view_.pipeline()->SetCalibrationCovariance(workbench_.calibrationCovariance());
}

void OverlayPresenter::hide(const QString& problem)
{
  view_.pipeline()->SetModelVisible(false);
  view_.pipeline()->SetNotice({});
  view_.pipeline()->SetFade(1);
  view_.pipeline()->SetStylusTipToCamera(nullptr);
  emit stateChanged({ problem, 0, workbench_.calibrationCovariance().has_value(), {} });
}

/// All poses since the last frame. Where their time goes back (a recording that begins anew) so does what was seen.
void OverlayPresenter::feed(const OverlayTransforms& transforms)
{
  const DeviceSetup& setup = workbench_.devices().setup();
  const std::string marker = setup.markerToTracker.toStdString(), phantom = setup.phantomToTracker.toStdString();
  for (const Poses& poses : queue_->take())
  {
    if (!live_ || poses.timeSec < newestSec_)
    {
      LiveOverlayOptions options;
      options.smooth = smooth_;
      live_ = std::make_unique<LiveOverlay>(transforms, options);
    }
    newestSec_ = poses.timeSec;
    const auto poseOf = [&](const std::string& name)
    {
      const auto pose = poses.byTool.find(name);
      return pose == poses.byTool.end() ? PoseAtTime() : pose->second;
    };
    const PoseAtTime markerPose = poseOf(marker), phantomPose = poseOf(phantom);
    live_->addMarker(poses.timeSec, markerPose.transform, markerPose.isUsable());
    live_->addPhantom(poses.timeSec, phantomPose.transform, phantomPose.isUsable());
  }
}

void OverlayPresenter::show(const LiveView& shown)
{
  if (!isWanted() || !workbench_.model())
  {
    forget();
    hide({});
    return;
  }
  QString problem;
  const std::optional<OverlayTransforms> transforms = workbench_.overlayTransforms(problem);
  if (!transforms)
  {
    forget();
    hide(problem);
    return;
  }
  silence_.start();
  feed(*transforms);
  if (!live_)
  {
    hide({});
    return;
  }
  vtkHandEyeOverlayPipeline* pipeline = view_.pipeline();
  const LiveOverlayPose pose = live_->at(shown.frame.poseTimeSec);
  if (pose.modelToCamera)
  {
    pipeline->SetModelToCamera(toVtk(*pose.modelToCamera));
  }
  pipeline->SetModelVisible(pose.isUsable());
  pipeline->SetFade(pose.opacity);
  pipeline->SetNotice(pose.message);
  showStylus(shown.frame);
  OverlayState state;
  state.problem = QString::fromStdString(pose.isUsable() && pose.message.empty() ? pipeline->GetProblem() : pose.message);
  state.delaySec = pose.delaySec;
  state.hasHalo = workbench_.calibrationCovariance().has_value();
  if (state.hasHalo && look_.errorHalo && pose.isUsable())
  {
    state.predictedErrorPx = pipeline->GetPredictedErrorPx();
  }
  emit stateChanged(state);
}

void OverlayPresenter::showStylus(const devices::PairedFrame& frame)
{
  const std::optional<Eigen::Isometry3d> stylusTipToCamera = workbench_.stylusTipToCamera(frame);
  if (stylusTipToCamera)
  {
    view_.pipeline()->SetStylusTipToCamera(toVtk(*stylusTipToCamera));
    return;
  }
  view_.pipeline()->SetStylusTipToCamera(nullptr);
}

/// The other pages show the video as it is recorded.
void OverlayPresenter::applyLook()
{
  view_.pipeline()->SetLook(isWanted() ? look_ : OverlayLook());
  if (!isWanted())
  {
    hide({});
  }
  view_.requestRender();
}

void OverlayPresenter::setLook(const OverlayLook& look)
{
  look_ = look;
  applyLook();
}

void OverlayPresenter::setOpacity(double opacity)
{
  opacity_ = opacity;
  view_.pipeline()->SetModelOpacity(opacity);
  view_.requestRender();
}

void OverlayPresenter::setSmoothing(bool smooth)
{
  smooth_ = smooth;
  if (live_)
  {
    live_->setSmoothing(smooth);
  }
}

bool OverlayPresenter::handleKey(int key)
{
  // Qt's keys of printable characters are their ASCII codes.
  const bool isCharacter = key > Qt::Key_Space && key <= Qt::Key_AsciiTilde;
  if (!isWanted() || !isCharacter || !view_.pipeline()->HandleKey(char(key)))
  {
    return false;
  }
  look_ = view_.pipeline()->GetLook();
  opacity_ = view_.pipeline()->GetModelOpacity();
  emit lookChanged();
  view_.requestRender();
  return true;
}

void OverlayPresenter::takeSnapshot()
{
  workbench_.saveSnapshot(view_.hasFrame() ? view_.snapshot() : QImage());
}

}  // namespace handeye
