// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallColorLearning.h"
#include "CameraFileWriter.h"
#include "HandEyeWorkbench.h"
#include "JsonEigen.h"
#include "ResultFiles.h"
#include "SpinStep.h"
#include "WorkThread.h"

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
  emit cameraChanged();
  if (isCalibrationLoaded_ && isOtherLens)
  {
    // Nothing can be calibrated anew: it came without samples.
    isCalibrationLoaded_ = false;
    calibration_.reset();
    store("calibration", nlohmann::json());
    emit calibrationChanged();
    refuse(WizardStep::Camera, tr("The calibration that was loaded is of another lens and is not used any more."));
  }
  emit happened(tr("camera: %1").arg(origin));
  updateInputs();
}

void HandEyeWorkbench::takeRoomCamera()
{
  if (const simulation::RoomOptions* room = devices_->room())
  {
    const io::CameraFile file{ room->camera, {}, "simulated", {} };
    setCamera(file, tr("the simulated room's own camera"));
  }
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

void HandEyeWorkbench::spinStylus()
{
  if (!stylus_)
  {
    refuse(WizardStep::Stylus, tr("The shaft is looked for from the tip on: pivot the stylus, or load a stylus file, first."));
    return;
  }
  pivot_->cancel();
  spin_->start(devices_->setup().stylusToTracker, stylus_->tip_Stylus);
}

/// The same entries that `handeye spin` adds to a stylus' file.
void HandEyeWorkbench::takeSpin(const SpinStepResult& result)
{
  if (!stylus_ || !result.calibration.stylusTipToStylus.translation().isApprox(stylus_->tip_Stylus, 1e-9))
  {
    return;  // of a stylus that is not in use any more
  }
  Stylus spun = *stylus_;
  spun.document = spinJson(result, spun.document);
  spun.stylusTipToStylus = result.calibration.stylusTipToStylus;
  setStylus(spun, true);
}

QString HandEyeWorkbench::shaftWords() const
{
  if (!stylus_ || !stylus_->stylusTipToStylus)
  {
    return {};
  }
  const nlohmann::json::json_pointer words("/spin/message"), besideMm("/spin/tipToAxisMm");
  const nlohmann::json& document = stylus_->document;
  const bool hasWords = document.contains(words) && document[words].is_string();
  QString sentence = hasWords ? QString::fromStdString(document[words].get<std::string>()) : tr("known from the file");
  if (document.contains(besideMm) && document[besideMm].is_number())
  {
    sentence = tr("%1; the tip lies %2 mm beside it").arg(sentence).arg(document[besideMm].get<double>(), 0, 'f', 2);
  }
  return sentence;
}

void HandEyeWorkbench::loadStylus(const QString& path)
{
  pivot_->forget();
  spin_->cancel();
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

void HandEyeWorkbench::takeStylusTip(const Eigen::Vector3d& tip_Stylus, const QString& origin)
{
  pivot_->forget();
  spin_->cancel();
  Stylus stylus;
  stylus.tip_Stylus = tip_Stylus;
  stylus.message = tr("Tip %1, %2, %3 mm, %4; how exact it is, is not known.")
                     .arg(tip_Stylus.x(), 0, 'f', 2)
                     .arg(tip_Stylus.y(), 0, 'f', 2)
                     .arg(tip_Stylus.z(), 0, 'f', 2)
                     .arg(origin);
  stylus.document = tipDocument(tip_Stylus, stylus.message);
  setStylus(stylus, true);
}

nlohmann::json HandEyeWorkbench::tipDocument(const Eigen::Vector3d& tip_Stylus, const QString& message)
{
  return { { "schema", "handeye-stylus/1" }, { "status", "ok" }, { "tip_Stylus_Mm", toJson(tip_Stylus) },
    { "message", message.toStdString() } };
}

void HandEyeWorkbench::setStylus(const Stylus& stylus, bool isNew)
{
  if (stylus_ && stylus_->tip_Stylus != stylus.tip_Stylus)
  {
    spin_->cancel();
  }
  stylus_ = stylus;
  if (isNew)
  {
    store("stylus", stylus.document);
    emit happened(tr("stylus: %1").arg(stylus.message));
    if (const QString shaft = shaftWords(); !shaft.isEmpty())
    {
      emit happened(tr("stylus: %1").arg(shaft));
    }
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

QString HandEyeWorkbench::nameOf(const BallColor& color, bool isLearnt)
{
  return isLearnt ? tr("learnt: hue %1°").arg(color.hueDeg, 0, 'f', 0) : tr("any saturated red");
}

void HandEyeWorkbench::learnBallColor(const std::shared_ptr<const LiveView>& shown, const QPointF& point_Image)
{
  if (!shown || !camera_)
  {
    refuse(WizardStep::Ball, shown ? missingFor(WizardStep::Ball) : tr("There is no video to click on."));
    return;
  }
  beside(WizardStep::Ball,
    [this, shown, camera = camera_->file.camera, radiusMm = ball_.radiusMm,
      pixel = cv::Point(qRound(point_Image.x()), qRound(point_Image.y()))]
    {
      const cv::Mat& image = shown->image();
      const BallColorLearningResult learnt =
        handeye::learnBallColor(image, pixel, camera.withImageSize(image.cols, image.rows), radiusMm);
      tell(
        [this, learnt]
        {
          const QString message = QString::fromStdString(learnt.message);
          if (!learnt.isUsable())
          {
            refuse(WizardStep::Ball,
              tr("There is no ball at the place clicked: %1. The colour of before is kept (%2). Click on the middle of the ball.")
                .arg(message, nameOf(ball_.color, ball_.isColorLearnt)));
            return;
          }
          ball_.former = FormerColor{ ball_.color, ball_.isColorLearnt };
          setBallColor(learnt.color, true, message);
        });
    });
}

void HandEyeWorkbench::takeFormerBallColor()
{
  if (const std::optional<FormerColor> former = std::exchange(ball_.former, std::nullopt))
  {
    setBallColor(former->color, former->isLearnt, tr("the colour of before: %1").arg(nameOf(former->color, former->isLearnt)));
  }
}

void HandEyeWorkbench::forgetBallColor()
{
  ball_.former = FormerColor{ ball_.color, ball_.isColorLearnt };
  setBallColor({}, false, {});
}

void HandEyeWorkbench::setBallColor(const BallColor& color, bool isLearnt, const QString& message)
{
  ball_.color = color;
  ball_.isColorLearnt = isLearnt;
  ball_.wasSeen = false;
  ball_.message = message;
  storeBall();
  emit ballChanged();
  if (!message.isEmpty())
  {
    emit happened(tr("ball: %1").arg(message));
  }
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
