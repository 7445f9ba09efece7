// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include "ComparisonFiles.h"
#include "LandmarkFiles.h"
#include "ResultFiles.h"
#include "WorkThread.h"

#include <cmath>
#include <utility>

namespace handeye
{

HandEyeWorkbench::HandEyeWorkbench(QObject* parent)
  : QObject(parent)
  , work_(std::make_unique<WorkThread>(
      [this](const char* message)
      {
        QMetaObject::invokeMethod(
          this, [this, text = QString::fromUtf8(message)] { emit happened(text); }, Qt::QueuedConnection);
      }))
  , devices_(new DeviceHub(this))
  , live_(new LivePipeline(*work_, this))
  , lens_(new LensTask(*work_, this))
  , pivot_(new PivotTask(*work_, this))
  , spin_(new SpinTask(*work_, this))
  , latency_(new LatencyTask(*work_, this))
  , touch_(std::make_unique<TouchTask>())
  , capture_(new CaptureTask(*work_, this))
  , validationCapture_(new CaptureTask(*work_, this))
  , comparison_(new ComparisonTask(this))
{
  connectTasks();
  devices_->setRoomPhantom(ownModel());
  try
  {
    simulation::RoomOptions room;
    room.landmarks_Model = readModelLandmarks(ownLandmarks().toStdString());
    devices_->setRoomOptions(room);
  }
  catch (const std::exception&)
  {
    // A room in which no landmarks are touched; the page Overlay says that the file is missing.
  }
}

HandEyeWorkbench::~HandEyeWorkbench()
{
  devices_->clearHandlers();
  work_.reset();
}

void HandEyeWorkbench::connectTasks()
{
  devices_->setHandlers([this](const devices::DeviceSample& sample) { onSample(sample); },
    [this](const devices::PairedFrame& frame) { onFrame(frame); });
  devices_->setRightFrameHandler([this](const devices::PairedFrame& frame) { live_->takeRight(frame); });
  live_->addListener(
    [this](const devices::PairedFrame& frame, const std::optional<BallDetection>& ball)
    {
      lens_->onFrame(frame);
      latency_->onFrame(frame, ball);
      capture_->onFrame(frame);
      validationCapture_->onFrame(frame);
    });
  connect(live_, &LivePipeline::shown, this,
    [this]
    {
      const std::shared_ptr<const LiveView> view = live_->newest();
      if (view && view->ball && view->ball->isFound() && !ball_.wasSeen)
      {
        ball_.wasSeen = true;
        emit stateChanged();
      }
    });
  connect(devices_, &DeviceHub::connectionChanged, this, &HandEyeWorkbench::stateChanged);
  connect(devices_, &DeviceHub::streamsChanged, this, &HandEyeWorkbench::stateChanged);
  connect(lens_, &LensTask::changed, this, &HandEyeWorkbench::stateChanged);
  connect(lens_, &LensTask::refused, this, [this](const QString& message) { refuse(WizardStep::Camera, message); });
  connect(devices_, &DeviceHub::connectionChanged, this, [this] { touch_->restart(); });
  connect(pivot_, &PivotTask::calibrated, this,
    [this](const PivotStepResult& result)
    {
      const PivotCalibrationResult& calibration = result.calibration;
      setStylus({ calibration.tip_Stylus, calibration.tipCovariance, calibration.rmsMm, QString::fromStdString(calibration.message),
                  stylusJson(result) },
        true);
    });
  connect(pivot_, &PivotTask::refused, this, [this](const QString& message) { refuse(WizardStep::Stylus, message); });
  connect(pivot_, &PivotTask::collectingChanged, this,
    [this]
    {
      if (pivot_->isCollecting())
      {
        spin_->cancel();
      }
      emit stateChanged();
    });
  connect(spin_, &SpinTask::calibrated, this, &HandEyeWorkbench::takeSpin);
  connect(spin_, &SpinTask::refused, this,
    [this](const QString& message) { refuse(WizardStep::Stylus, tr("The shaft: %1.").arg(message)); });
  connect(spin_, &SpinTask::collectingChanged, this,
    [this]
    {
      playRoom();
      emit stateChanged();
    });
  connect(latency_, &LatencyTask::measured, this,
    [this](const TemporalCalibrationResult& result)
    {
      // As it is shown: to 0.1 ms.
      devices_->setLatency(std::round(1e4 * result.latencySec) / 1e4);
      storeDevices();
      updateInputs();
      emit latencyChanged(LatencyTask::words(result));
    });
  connect(latency_, &LatencyTask::refused, this, [this](const QString& message) { refuse(WizardStep::Ball, message); });
  connect(latency_, &LatencyTask::runningChanged, this,
    [this]
    {
      enterStep(step_);
      emit stateChanged();
    });
  connect(capture_, &CaptureTask::opened, this, &HandEyeWorkbench::takeDocuments);
  connect(capture_, &CaptureTask::notOpened, this, &HandEyeWorkbench::openAnother);
  connect(validationCapture_, &CaptureTask::notOpened, this,
    [this](const QString& message)
    {
      if (capture_->isOpen())
      {
        refuse(WizardStep::Validation, message);
      }
    });
  connect(capture_, &CaptureTask::failed, this, [this](const QString& message) { refuse(WizardStep::Capture, message); });
  connect(
    validationCapture_, &CaptureTask::failed, this, [this](const QString& message) { refuse(WizardStep::Validation, message); });
  connect(comparison_, &ComparisonTask::changed, this, &HandEyeWorkbench::stateChanged);
  connect(comparison_, &ComparisonTask::refused, this, [this](const QString& message) { refuse(WizardStep::Comparison, message); });
  connect(comparison_, &ComparisonTask::finished, this,
    [this]
    {
      const ComparisonResult& result = comparison_->result()->result;
      store("comparison", comparisonJson(result));
      emit happened(tr("comparison: %1").arg(QString::fromStdString(result.message)));
    });
  connect(capture_, &CaptureTask::samplesChanged, this, &HandEyeWorkbench::recalibrate);
  connect(capture_, &CaptureTask::busyChanged, this, &HandEyeWorkbench::recalibrate);
  connect(validationCapture_, &CaptureTask::samplesChanged, this, &HandEyeWorkbench::revalidate);
  connect(validationCapture_, &CaptureTask::busyChanged, this, &HandEyeWorkbench::stateChanged);
}

void HandEyeWorkbench::onSample(const devices::DeviceSample& sample)
{
  pivot_->onSample(sample);
  spin_->onSample(sample);
  latency_->onSample(sample);
  touch_->onSample(sample);
}

void HandEyeWorkbench::onFrame(const devices::PairedFrame& frame)
{
  live_->take(frame);
}

void HandEyeWorkbench::tell(std::function<void()> news)
{
  QMetaObject::invokeMethod(
    this,
    [this, session = workSession_, told = std::move(news)]
    {
      if (session == session_)
      {
        told();
      }
    },
    Qt::QueuedConnection);
}

void HandEyeWorkbench::post(std::function<void()> work)
{
  work_->post(
    [this, session = session_, todo = std::move(work)]
    {
      workSession_ = session;
      todo();
    });
}

void HandEyeWorkbench::beside(WizardStep step, std::function<void()> work)
{
  post(
    [this, step, todo = std::move(work)]
    {
      try
      {
        todo();
      }
      catch (const std::exception& error)
      {
        tell([this, step, message = QString::fromUtf8(error.what())] { refuse(step, message); });
      }
    });
}

void HandEyeWorkbench::refuse(WizardStep step, const QString& message)
{
  emit refused(step, message);
  emit happened(message);
  emit stateChanged();
}

void HandEyeWorkbench::cancelWork()
{
  work_->cancel();
}

bool HandEyeWorkbench::connectDevices(const DeviceSetup& setup)
{
  live_->clear();
  const bool isGood = devices_->connectDevices(setup);
  if (!isGood)
  {
    refuse(WizardStep::Devices, devices_->problem());
    return false;
  }
  if (!camera_)
  {
    takeRoomCamera();
  }
  storeDevices();
  updateInputs();
  enterStep(step_);
  emit happened(tr("connected"));
  return true;
}

void HandEyeWorkbench::setStreamNames(const DeviceSetup& setup)
{
  devices_->setNames(setup);
  storeDevices();
  updateInputs();
}

void HandEyeWorkbench::enterStep(WizardStep step)
{
  if (std::exchange(step_, step) != step)
  {
    storeStep();
  }
  if (step != WizardStep::Capture)
  {
    capture_->setHandsFree(false);
  }
  if (step != WizardStep::Validation)
  {
    validationCapture_->setHandsFree(false);
  }
  if (step != WizardStep::Camera)
  {
    lens_->stop();
  }
  if (step != WizardStep::Stylus)
  {
    pivot_->cancel();
    spin_->cancel();
  }
  playRoom();
  updateLive();
  emit stepEntered();
}

/// What the people in the simulated room do for the page and its task.
void HandEyeWorkbench::playRoom()
{
  static const std::map<WizardStep, RoomScene> scenes = { { WizardStep::Stylus, RoomScene::Pivot },
    { WizardStep::Ball, RoomScene::Rest }, { WizardStep::Capture, RoomScene::Placements },
    { WizardStep::Validation, RoomScene::OtherPlacements }, { WizardStep::Overlay, RoomScene::Landmarks } };
  const auto scene = scenes.find(step_);
  const bool isFree = latency_->isRunning() || scene == scenes.end();
  devices_->playRoom(isFree ? RoomScene::Free : spin_->isCollecting() ? RoomScene::Spin : scene->second);
}

void HandEyeWorkbench::updateLive()
{
  LivePipeline::Settings settings;
  if (camera_)
  {
    settings.camera = camera_->file.camera;
  }
  settings.ballRadiusMm = ball_.radiusMm;
  settings.detection.color = ball_.color;
  settings.detects =
    step_ == WizardStep::Ball || step_ == WizardStep::Capture || step_ == WizardStep::Validation || latency_->isRunning();
  settings.drawsStages = step_ == WizardStep::Ball;
  live_->setSettings(settings);
}

}  // namespace handeye
