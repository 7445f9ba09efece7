// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayPresenter.h"

#include "EigenVtk.h"
#include "EightBitImage.h"
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
  , recording_(new OverlayRecordingTask(this))
{
  workbench.live().addListener(
    [queue = queue_](const devices::PairedFrame& frame, const std::optional<BallDetection>&) { queue->add(frame); });
  connect(&workbench, &HandEyeWorkbench::modelChanged, this,
    [this]
    {
      view_.pipeline()->SetPreparedModel(workbench_.overlayMesh());
      view_.rightPipeline()->SetPreparedModel(workbench_.overlayMesh());
      view_.requestRender();
    });
  // What was seen belongs to the devices, the calibration and the registration of its time.
  connect(&workbench.devices(), &DeviceHub::connectionChanged, this, &OverlayPresenter::forget);
  connect(&workbench, &HandEyeWorkbench::registrationChanged, this, &OverlayPresenter::forget);
  connect(&workbench, &HandEyeWorkbench::calibrationChanged, this, &OverlayPresenter::applyCalibration);
  connect(&workbench, &HandEyeWorkbench::stylusChanged, this, &OverlayPresenter::applyCalibration);
  connect(&workbench, &HandEyeWorkbench::ballChanged, this, &OverlayPresenter::applyCalibration);
  connect(&workbench, &HandEyeWorkbench::stepEntered, this, &OverlayPresenter::applyLook);
  connect(&workbench, &HandEyeWorkbench::sessionOpened, this, &OverlayPresenter::stopRecording);
  connect(&view, &VideoView::rendered, this, &OverlayPresenter::record);
  connect(recording_, &OverlayRecordingTask::changed, this, &OverlayPresenter::recordingChanged);
  for (vtkHandEyeOverlayPipeline* pipeline : { view_.pipeline(), view_.rightPipeline() })
  {
    pipeline->SetModelVisible(false);
    pipeline->SetModelOpacity(opacity_);
  }
}

bool OverlayPresenter::isWanted() const
{
  return workbench_.step() == WizardStep::Overlay || workbench_.step() == WizardStep::Finish;
}

void OverlayPresenter::forget()
{
  live_.reset();
  rightLive_.reset();
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
  const std::optional<CalibratedEye> right = workbench_.rightEye();
  view_.rightPipeline()->SetStylusShape(shape);
  view_.rightPipeline()->SetCalibrationCovariance(right ? right->covariance : std::nullopt);
  if (right)
  {
    view_.rightPipeline()->SetCameraModel(right->camera);
  }
}

void OverlayPresenter::hide(const QString& problem)
{
  for (vtkHandEyeOverlayPipeline* pipeline : { view_.pipeline(), view_.rightPipeline() })
  {
    pipeline->SetModelVisible(false);
    pipeline->SetNotice({});
    pipeline->SetFade(1);
    pipeline->SetStylusTipToCamera(nullptr);
  }
  OverlayState state;
  state.problem = problem;
  state.hasHalo = workbench_.calibrationCovariance().has_value();
  const std::shared_ptr<const LiveView> shown = workbench_.live().newest();
  state.stereoProblem = shown ? stereoProblem(*shown) : tr("There is no video.");
  if (!shown)
  {
    view_.setStereo({});
  }
  emit stateChanged(state);
}

/// All poses since the last frame. Where their time goes back (a recording that begins anew) so does what was seen.
void OverlayPresenter::feed(const OverlayTransforms& transforms)
{
  const DeviceSetup& setup = workbench_.devices().setup();
  const std::string marker = setup.markerToTracker.toStdString(), phantom = setup.phantomToTracker.toStdString();
  const std::optional<CalibratedEye> right = workbench_.rightEye();
  for (const Poses& poses : queue_->take())
  {
    if (!live_ || poses.timeSec < newestSec_)
    {
      LiveOverlayOptions options;
      options.smooth = smooth_;
      live_ = std::make_unique<LiveOverlay>(transforms, options);
      const OverlayTransforms rightTransforms{ right ? right->markerToCamera : transforms.markerToCamera,
        transforms.modelToPhantom };
      rightLive_ = right ? std::make_unique<LiveOverlay>(rightTransforms, options) : nullptr;
    }
    newestSec_ = poses.timeSec;
    const auto poseOf = [&](const std::string& name)
    {
      const auto pose = poses.byTool.find(name);
      return pose == poses.byTool.end() ? PoseAtTime() : pose->second;
    };
    const PoseAtTime markerPose = poseOf(marker), phantomPose = poseOf(phantom);
    for (LiveOverlay* live : { live_.get(), rightLive_.get() })
    {
      if (live)
      {
        live->addMarker(poses.timeSec, markerPose.transform, markerPose.isUsable());
        live->addPhantom(poses.timeSec, phantomPose.transform, phantomPose.isUsable());
      }
    }
  }
}

void OverlayPresenter::show(const LiveView& shown)
{
  OverlayTransformSet transforms{ { "ModelToCamera", std::nullopt } };
  const bool isStereo = isWanted() && stereo_.layout && stereoProblem(shown).isEmpty();
  view_.setStereo(isStereo ? stereo_.layout : std::nullopt, stereo_.isSwapped);
  draw(shown, transforms);
  next_.reset();
  if (recording_->isRecording())
  {
    next_ = NextPicture{ shown.frame.image.timeSec, transforms };
  }
}

void OverlayPresenter::leaveOldPicture(int silentMs)
{
  if (isWanted())
  {
    forget();
    hide(tr("No new picture has come for %1 s: the model is not drawn on an old one.").arg(silentMs / 1000.0, 0, 'f', 1));
    view_.requestRender();
  }
}

void OverlayPresenter::draw(const LiveView& shown, OverlayTransformSet& transforms)
{
  if (!isWanted())
  {
    forget();
    hide({});
    return;
  }
  if (!workbench_.model())
  {
    forget();
    hide(tr("There is no mesh yet."));
    return;
  }
  QString problem;
  const std::optional<OverlayTransforms> placing = workbench_.overlayTransforms(problem);
  if (!placing)
  {
    forget();
    hide(problem);
    return;
  }
  feed(*placing);
  if (!live_)
  {
    hide({});
    return;
  }
  vtkHandEyeOverlayPipeline* pipeline = view_.pipeline();
  const LiveOverlayPose pose = place(*live_, shown.frame.poseTimeSec, pipeline);
  transforms["ModelToCamera"] = pose.modelToCamera;
  showStylus(pipeline, workbench_.stylusTipToCamera(shown.frame), transforms["StylusTipToCamera"]);
  OverlayState state;
  state.problem = QString::fromStdString(pose.isUsable() && pose.message.empty() ? pipeline->GetProblem() : pose.message);
  state.isDrawn = pose.isUsable();
  state.delaySec = pose.delaySec;
  state.hasHalo = workbench_.calibrationCovariance().has_value();
  state.stereoProblem = stereoProblem(shown);
  if (state.hasHalo && look_.errorHalo && pose.isUsable())
  {
    state.predictedErrorPx = pipeline->GetPredictedErrorPx();
  }
  if (view_.stereo())
  {
    const QString right = showRight(shown, transforms);
    state.problem = state.problem.isEmpty() && !right.isEmpty() ? tr("Right eye: %1").arg(right) : state.problem;
  }
  emit stateChanged(state);
}

LiveOverlayPose OverlayPresenter::place(LiveOverlay& live, double timeSec, vtkHandEyeOverlayPipeline* pipeline)
{
  const LiveOverlayPose pose = live.at(timeSec);
  if (pose.modelToCamera)
  {
    pipeline->SetModelToCamera(toVtk(*pose.modelToCamera));
  }
  pipeline->SetModelVisible(pose.isUsable());
  pipeline->SetFade(pose.opacity);
  pipeline->SetNotice(pose.message);
  return pose;
}

/// Why two eyes cannot be shown.
QString OverlayPresenter::stereoProblem(const LiveView& shown) const
{
  const DeviceSetup& setup = workbench_.devices().setup();
  if (!workbench_.rightEye())
  {
    return tr(
      "One eye: the calibration is of one camera. Load one of a stereo rig on the page Capture (handeye calibrate --right).");
  }
  if (setup.rightImage.isEmpty() && !shown.right)
  {
    return tr("One eye: choose the right eye's video on the page Devices.");
  }
  return shown.right ? QString() : tr("One eye: no picture comes from the right eye's video '%1'.").arg(setup.rightImage);
}

/// @return why the model is not drawn for the right eye, or fades
QString OverlayPresenter::showRight(const LiveView& shown, OverlayTransformSet& transforms)
{
  vtkHandEyeOverlayPipeline* pipeline = view_.rightPipeline();
  pipeline->SetVideoFrame(toEightBit(shown.right->image.frame()->image));
  pipeline->SetModelVisible(false);
  std::optional<Eigen::Isometry3d>& modelToRight = transforms["ModelToRightCamera"];
  showStylus(pipeline, workbench_.stylusTipToRightCamera(*shown.right), transforms["StylusTipToRightCamera"]);
  if (!rightLive_)
  {
    return tr("its place is not known.");
  }
  const LiveOverlayPose pose = place(*rightLive_, shown.right->poseTimeSec, pipeline);
  modelToRight = pose.modelToCamera;
  return QString::fromStdString(pose.message.empty() ? pipeline->GetProblem() : pose.message);
}

void OverlayPresenter::showStylus(vtkHandEyeOverlayPipeline* pipeline, const std::optional<Eigen::Isometry3d>& stylusTipToCamera,
  std::optional<Eigen::Isometry3d>& kept)
{
  kept = stylusTipToCamera;
  if (stylusTipToCamera)
  {
    pipeline->SetStylusTipToCamera(toVtk(*stylusTipToCamera));
    return;
  }
  pipeline->SetStylusTipToCamera(nullptr);
}

void OverlayPresenter::startRecording(const QString& ending)
{
  const QString folder = workbench_.capture().isOpen() ? workbench_.sessionFolder() + QStringLiteral("/videos") : QString();
  constexpr double sharpEnough = 0.95;
  const double scale = view_.shownScale();
  recording_->start(folder, ending,
    scale < sharpEnough ? tr("The view shows the video at %1 % of its size, and the recording is no sharper: enlarge the view.")
                            .arg(100 * scale, 0, 'f', 0)
                        : QString());
}

/// What was rendered of the frame that was shown last.
void OverlayPresenter::record()
{
  cv::Mat picture;
  if (next_ && recording_->isRecording() && view_.readShown(picture))
  {
    recording_->add(picture, next_->timeSec, next_->transforms);
  }
  next_.reset();
}

/// The other pages show the video as it is recorded.
void OverlayPresenter::applyLook()
{
  for (vtkHandEyeOverlayPipeline* pipeline : { view_.pipeline(), view_.rightPipeline() })
  {
    pipeline->SetLook(isWanted() ? look_ : OverlayLook());
    pipeline->SetModelOpacity(opacity_);
  }
  if (!isWanted())
  {
    recording_->stop();
    view_.setStereo({});
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
  applyLook();
}

void OverlayPresenter::setStereo(const OverlayStereo& stereo)
{
  // Pictures of another size do not go into the video that is being recorded.
  stereo_ = recording_->isRecording() ? stereo_ : stereo;
  if (const std::shared_ptr<const LiveView> shown = workbench_.live().newest())
  {
    const bool isStereo = isWanted() && stereo_.layout && stereoProblem(*shown).isEmpty();
    view_.setStereo(isStereo ? stereo_.layout : std::nullopt, stereo_.isSwapped);
  }
  view_.requestRender();
}

void OverlayPresenter::setSmoothing(bool smooth)
{
  smooth_ = smooth;
  for (LiveOverlay* live : { live_.get(), rightLive_.get() })
  {
    if (live)
    {
      live->setSmoothing(smooth);
    }
  }
}

bool OverlayPresenter::handleKey(int key)
{
  // Qt's keys of printable characters are their ASCII codes.
  const bool isCharacter = key > Qt::Key_Space && key <= Qt::Key_AsciiTilde;
  if (!isWanted() || !isCharacter)
  {
    return false;
  }
  if (view_.stereo() && handleStereoKey(key))
  {
    emit lookChanged();
    return true;
  }
  if (!view_.pipeline()->HandleKey(char(key)))
  {
    return false;
  }
  look_ = view_.pipeline()->GetLook();
  opacity_ = view_.pipeline()->GetModelOpacity();
  applyLook();
  emit lookChanged();
  return true;
}

/// As vtkHandEyeStereoOverlay has them: the next layout, and the eyes exchanged.
bool OverlayPresenter::handleStereoKey(int key)
{
  using Layout = vtkHandEyeStereoOverlay::Layout;
  OverlayStereo stereo = stereo_;
  switch (key)
  {
    case Qt::Key_S:
      stereo.layout = Layout((int(*stereo.layout) + 1) % (int(Layout::Anaglyph) + 1));
      break;
    case Qt::Key_E:
      stereo.isSwapped = !stereo.isSwapped;
      break;
    default:
      return false;
  }
  setStereo(stereo);
  return true;
}

void OverlayPresenter::takeSnapshot()
{
  workbench_.saveSnapshot(view_.hasFrame() ? view_.snapshot() : QImage());
}

}  // namespace handeye
