// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include "BallColorLearning.h"
#include "CameraFileWriter.h"
#include "JsonEigen.h"
#include "LandmarkFiles.h"
#include "ResultFiles.h"
#include "WorkThread.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <QFileInfo>

#include <utility>

namespace handeye
{

namespace
{

nlohmann::json cameraDocument(const HandEyeWorkbench::Camera& camera)
{
  const CameraModel& lens = camera.file.camera;
  return { { "schema", "handeye-camera/1" }, { "origin", camera.origin.toStdString() },
    { "camera",
      { { "width", lens.width() }, { "height", lens.height() }, { "cameraMatrix", toJson(lens.cameraMatrix()) },
        { "distortionCoefficients", lens.distortionCoefficients() } } } };
}

}  // namespace

HandEyeWorkbench::HandEyeWorkbench(vtkSlicerHandEyeCalibrationLogic* logic, QObject* parent)
  : QObject(parent)
  , logic_(logic)
  , work_(std::make_unique<WorkThread>(
      [this](const char* message) { tell([this, text = QString::fromUtf8(message)] { emit happened(text); }); }))
  , devices_(new DeviceHub(this))
  , live_(new LivePipeline(*work_, this))
  , lens_(new LensTask(*work_, this))
  , pivot_(new PivotTask(*work_, this))
  , latency_(new LatencyTask(*work_, this))
  , capture_(new CaptureTask(*work_, this))
  , validationCapture_(new CaptureTask(*work_, this))
{
  connectTasks();
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
  connect(pivot_, &PivotTask::calibrated, this,
    [this](const PivotStepResult& result)
    {
      const PivotCalibrationResult& calibration = result.calibration;
      setStylus({ calibration.tip_Stylus, calibration.tipCovariance, calibration.rmsMm, QString::fromStdString(calibration.message),
                  stylusJson(result) },
        true);
    });
  connect(pivot_, &PivotTask::refused, this, [this](const QString& message) { refuse(WizardStep::Stylus, message); });
  connect(pivot_, &PivotTask::collectingChanged, this, &HandEyeWorkbench::stateChanged);
  connect(latency_, &LatencyTask::measured, this,
    [this](const TemporalCalibrationResult& result)
    {
      devices_->setLatency(result.latencySec);
      storeDevices();
      updateInputs();
      emit latencyChanged(QString::fromStdString(result.message));
    });
  connect(latency_, &LatencyTask::refused, this, [this](const QString& message) { refuse(WizardStep::Ball, message); });
  connect(latency_, &LatencyTask::runningChanged, this,
    [this]
    {
      enterStep(step_);
      emit stateChanged();
    });
  connect(capture_, &CaptureTask::opened, this, &HandEyeWorkbench::takeDocuments);
  connect(capture_, &CaptureTask::failed, this, [this](const QString& message) { refuse(WizardStep::Capture, message); });
  connect(
    validationCapture_, &CaptureTask::failed, this, [this](const QString& message) { refuse(WizardStep::Validation, message); });
  connect(capture_, &CaptureTask::samplesChanged, this, &HandEyeWorkbench::recalibrate);
  connect(capture_, &CaptureTask::busyChanged, this, &HandEyeWorkbench::recalibrate);
  connect(validationCapture_, &CaptureTask::samplesChanged, this, &HandEyeWorkbench::revalidate);
  connect(validationCapture_, &CaptureTask::busyChanged, this, &HandEyeWorkbench::stateChanged);
}

void HandEyeWorkbench::onSample(const devices::DeviceSample& sample)
{
  pivot_->onSample(sample);
  latency_->onSample(sample);
}

void HandEyeWorkbench::onFrame(const devices::PairedFrame& frame)
{
  live_->take(frame);
}

void HandEyeWorkbench::tell(std::function<void()> news)
{
  QMetaObject::invokeMethod(this, std::move(news), Qt::QueuedConnection);
}

void HandEyeWorkbench::beside(WizardStep step, std::function<void()> work)
{
  work_->post(
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
  if (devices_->room() && !camera_)
  {
    io::CameraFile file{ devices_->room()->camera, {}, "simulated", {} };
    setCamera(file, tr("the simulated room's own camera"));
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
  step_ = step;
  const bool isMeasuring = latency_->isRunning();
  static const std::map<WizardStep, RoomScene> scenes = { { WizardStep::Stylus, RoomScene::Pivot },
    { WizardStep::Capture, RoomScene::Placements }, { WizardStep::Validation, RoomScene::OtherPlacements },
    { WizardStep::Overlay, RoomScene::Landmarks } };
  const auto scene = scenes.find(step);
  devices_->playRoom(isMeasuring || scene == scenes.end() ? RoomScene::Free : scene->second);
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
  }
  updateLive();
  emit stepEntered();
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

/// Captures take the camera, the stylus and the ball as they are now.
void HandEyeWorkbench::updateInputs()
{
  std::optional<CaptureInputs> inputs;
  if (camera_ && stylus_ && ball_.radiusMm > 0)
  {
    CaptureInputs found{ camera_->file.camera, stylus_->tip_Stylus, ball_.radiusMm, {}, {} };
    found.detection.color = ball_.color;
    const DeviceSetup& setup = devices_->setup();
    found.tools.stylusToTracker = setup.stylusToTracker.toStdString();
    found.tools.markerToTracker = setup.markerToTracker.toStdString();
    found.tools.latencySec = setup.latencySec;
    inputs = found;
  }
  capture_->setInputs(inputs);
  validationCapture_->setInputs(inputs);
  updateLive();
  recalibrate();
}

void HandEyeWorkbench::loadCamera(const QString& path)
{
  beside(WizardStep::Camera,
    [this, path]
    {
      const io::CameraFile file = io::readCameraFile(path.toStdString());
      tell([this, file, path] { setCamera(file, path); });
    });
}

void HandEyeWorkbench::setCamera(const io::CameraFile& file, const QString& origin)
{
  const bool isOtherLens = calibration_ &&
    (!calibration_->camera.cameraMatrix().isApprox(file.camera.cameraMatrix()) ||
      calibration_->camera.distortionCoefficients() != file.camera.distortionCoefficients());
  camera_ = Camera{ file, origin };
  store("camera", cameraDocument(*camera_));
  if (isCalibrationLoaded_ && isOtherLens)
  {
    // Nothing can be calibrated anew: it came without samples.
    isCalibrationLoaded_ = false;
    calibration_.reset();
    emit calibrationChanged();
    refuse(WizardStep::Camera, tr("The calibration that was loaded is of another lens and is not used any more."));
  }
  emit cameraChanged();
  emit happened(tr("camera: %1").arg(origin));
  updateInputs();
}

void HandEyeWorkbench::useCalibratedLens()
{
  const std::optional<LensTask::Result>& result = lens_->result();
  if (!result || !result->calibration.isUsable())
  {
    refuse(WizardStep::Camera, tr("No lens has been calibrated yet."));
    return;
  }
  const QString board = QString::fromStdString(toString(result->board));
  const io::CameraFile file{ *result->calibration.camera, std::nullopt, "OpenCV", {} };
  setCamera(file, tr("the calibration with the board %1").arg(board));
  if (capture_->isOpen())
  {
    beside(WizardStep::Camera,
      [file, path = sessionFolder() + QStringLiteral("/camera.yml"), rmsPx = result->calibration.rmsPx]
      {
        std::vector<std::string> warnings;
        io::CameraFileExtras extras;
        extras.reprojectionErrorPx = rmsPx;
        io::writeCameraFile(path.toStdString(), file, io::CameraFormat::OpenCV, warnings, extras);
      });
  }
}

void HandEyeWorkbench::loadStylus(const QString& path)
{
  beside(WizardStep::Stylus,
    [this, path]
    {
      const std::filesystem::path file = path.toStdString();
      Stylus stylus{ readStylusTip(file), readStylusTipCovariance(file), 0, {}, readStylus(file), readStylusTipFrame(file) };
      const nlohmann::json rms = stylus.document.value("rmsMm", nlohmann::json());
      stylus.rmsMm = rms.is_number() ? rms.get<double>() : 0;
      stylus.message = QString::fromStdString(stylus.document.value("message", std::string()));
      tell([this, stylus] { setStylus(stylus, true); });
    });
}

void HandEyeWorkbench::setStylus(const Stylus& stylus, bool isNew)
{
  stylus_ = stylus;
  if (isNew)
  {
    store("stylus", stylus.document);
    emit happened(tr("stylus: %1").arg(stylus.message));
  }
  if (logic_)
  {
    logic_->SetStylusTip(stylus.tip_Stylus.x(), stylus.tip_Stylus.y(), stylus.tip_Stylus.z());
  }
  emit stylusChanged();
  updateInputs();
}

void HandEyeWorkbench::setBallRadius(double radiusMm)
{
  if (radiusMm != ball_.radiusMm)
  {
    ball_.radiusMm = radiusMm;
    ball_.wasSeen = false;
    storeBall();
    emit ballChanged();
    updateInputs();
  }
}

void HandEyeWorkbench::learnBallColor(const QPointF& point_Image)
{
  const std::shared_ptr<const LiveView> view = live_->newest();
  if (!view)
  {
    refuse(WizardStep::Ball, tr("There is no video to click on."));
    return;
  }
  beside(WizardStep::Ball,
    [this, view, pixel = cv::Point(qRound(point_Image.x()), qRound(point_Image.y()))]
    {
      const BallColorLearningResult learnt = handeye::learnBallColor(view->image(), pixel);
      tell(
        [this, learnt]
        {
          const QString message = QString::fromStdString(learnt.message);
          if (!learnt.isUsable())
          {
            refuse(WizardStep::Ball, message);
            return;
          }
          ball_.color = learnt.color;
          ball_.isColorLearnt = true;
          ball_.wasSeen = false;
          ball_.message = message;
          storeBall();
          emit ballChanged();
          emit happened(tr("ball: %1").arg(message));
          updateInputs();
        });
    });
}

void HandEyeWorkbench::forgetBallColor()
{
  ball_.color = {};
  ball_.isColorLearnt = ball_.wasSeen = false;
  ball_.message.clear();
  storeBall();
  emit ballChanged();
  updateInputs();
}

void HandEyeWorkbench::measureLatency()
{
  if (!camera_ || !stylus_)
  {
    refuse(WizardStep::Ball, tr("The latency is measured with a camera and a calibrated stylus; both are needed first."));
    return;
  }
  const DeviceSetup& setup = devices_->setup();
  latency_->start(camera_->file.camera, stylus_->tip_Stylus, setup.markerToTracker, setup.stylusToTracker);
}

}  // namespace handeye
