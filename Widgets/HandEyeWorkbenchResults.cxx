// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include "PaintedPlot.h"
#include "ResultFiles.h"
#include "ValidationReport.h"
#include "WorkThread.h"

#include <QFileInfo>

#include <algorithm>
#include <cmath>
#include <utility>

namespace handeye
{

/// Once for many changes, and not while one is under way.
void HandEyeWorkbench::recalibrate()
{
  emit stateChanged();
  if (capture_->isBusy() || std::exchange(isCalibrationAsked_, true))
  {
    return;
  }
  QTimer::singleShot(0, this,
    [this]
    {
      isCalibrationAsked_ = false;
      calibrateNow();
    });
}

void HandEyeWorkbench::calibrateNow()
{
  if (isCalibrating_)
  {
    isCalibrationStale_ = true;  // asked for again when that is done
    return;
  }
  const std::vector<CapturedFrame> frames = capture_->frames();
  const std::optional<CaptureInputs>& inputs = capture_->inputs();
  if (isCalibrationLoaded_ && capture_->samples().isEmpty())
  {
    return;
  }
  isCalibrationLoaded_ = false;
  // Samples of another lens, tip or ball say nothing of this one: there is no calibration until they have been looked at again.
  if (!inputs || capture_->isStale())
  {
    calibration_.reset();
    emit calibrationChanged();
    return;
  }
  isCalibrating_ = true;
  HandEyeCalibrationOptions options;
  options.tipCovariance_Stylus = stylus_->tipCovariance;
  post(
    [this, frames, taken = *inputs, options, depths = DepthRange({ nearestMm_, furthestMm_ }), tip = stylus_->tip_Stylus]
    {
      std::optional<CalibrationStepResult> step;
      try
      {
        step = calibrateCapture({ taken.camera, frames }, options);
        step->tip_Stylus = tip;
        step->ballRadiusMm = taken.ballRadiusMm;
        step->tools = taken.tools;
        addGuidance(*step, options, depths);
      }
      catch (const std::exception& error)
      {
        tell([this, message = QString::fromUtf8(error.what())] { refuse(WizardStep::Capture, message); });
      }
      tell(
        [this, step]
        {
          isCalibrating_ = false;
          if (step)
          {
            takeCalibration(*step);
          }
          if (std::exchange(isCalibrationStale_, false))
          {
            recalibrate();
          }
        });
    });
}

void HandEyeWorkbench::takeCalibration(const CalibrationStepResult& result)
{
  calibration_ = result;
  if (!capture_->samples().isEmpty())
  {
    store("calibration", calibrationJson(result));
  }
  emit calibrationChanged();
  revalidate();
}

void HandEyeWorkbench::loadCalibration(const QString& path)
{
  if (!capture_->samples().isEmpty())
  {
    refuse(WizardStep::Capture, tr("This session has samples of its own. Begin a new session to load a calibration."));
    return;
  }
  beside(WizardStep::Capture,
    [this, path]
    {
      const std::filesystem::path file = path.toStdString();
      const StoredCalibration stored = readCalibration(file);
      nlohmann::json document = readResult(file, "markerToCamera");
      const auto covariance = readCalibrationCovariance(file);
      const std::optional<CalibratedEye> right = readRightEye(file);
      tell(
        [this, stored, document, covariance, right, path]
        {
          rightEye_ = right;
          CalibrationStepResult loaded{ {}, stored.camera, {}, stored.tools, stored.tip_Stylus, stored.ballRadiusMm, {}, {} };
          loaded.calibration.status = HandEyeCalibrationResult::Status::Ok;
          loaded.calibration.markerToCamera = stored.markerToCamera;
          loaded.calibration.covariance = covariance.value_or(Eigen::Matrix<double, 6, 6>::Zero());
          loaded.calibration.message = tr("loaded from %1").arg(path).toStdString();
          isCalibrationLoaded_ = true;
          calibration_ = loaded;
          store("calibration", document);
          ball_.radiusMm = stored.ballRadiusMm;
          storeBall();
          const QString ofThat = tr("The tip is that of the calibration %1").arg(path);
          spin_->cancel();
          stylus_ = Stylus{ stored.tip_Stylus, Eigen::Matrix3d::Zero(), 0, ofThat, tipDocument(stored.tip_Stylus, ofThat) };
          emit stylusChanged();
          emit ballChanged();
          setCamera({ stored.camera, stored.markerToCamera, "calibration.json", {} }, path);
          emit calibrationChanged();
          revalidate();
        });
    });
}

void HandEyeWorkbench::revalidate()
{
  const std::vector<CapturedFrame> frames = validationCapture_->frames();
  validation_.reset();
  // Samples of another lens, tip or ball say nothing of this one, until they have been looked at again.
  if (!frames.empty() && !validationCapture_->isStale() && calibration_ && calibration_->isUsable())
  {
    validation_ = validateCapture(frames, calibration_->camera, calibration_->calibration.markerToCamera);
    validation_->subject.ballRadiusMm = ball_.radiusMm;
    store("validation", validationJson(*validation_));
  }
  else if (frames.empty() && !validationCapture_->samples().isEmpty() && !validationCapture_->isStale())
  {
    store("validation", nlohmann::json());  // all were set aside
  }
  emit validationChanged();
  emit stateChanged();
}

void HandEyeWorkbench::setWorkingDepths(double nearestMm, double furthestMm)
{
  if (nearestMm > 0 && nearestMm < furthestMm)
  {
    nearestMm_ = nearestMm;
    furthestMm_ = furthestMm;
    storeBall();
    recalibrate();
  }
}

void HandEyeWorkbench::setEnoughPx(double px)
{
  enoughPx_ = px;
  storeBall();
  emit calibrationChanged();
  emit stateChanged();
}

bool HandEyeWorkbench::isEnough() const
{
  return calibration_ && calibration_->isUsable() && calibration_->calibration.predicted.maximumPx <= enoughPx_;
}

void HandEyeWorkbench::writeReport(const QString& folder)
{
  if (!validation_)
  {
    refuse(WizardStep::Finish, tr("The report is one of the validation, which is still to be done."));
    return;
  }
  const std::filesystem::path recording = validationCapture_->folder().toStdString();
  beside(WizardStep::Finish,
    [this, folder, recording, validation = *validation_, thread = work_.get()]
    {
      writeValidationReport(
        folder.toStdString(), validation, io::Recording::open(recording), paintUnless([thread] { return thread->isEnding(); }));
      tell(
        [this, file = folder + QStringLiteral("/report.html"), errors = validation.projectionErrorPx]
        {
          report_ = { { "file", file.toStdString() }, { "meanPx", errors.mean }, { "count", errors.count } };
          store("report", report_);
          emit reportWritten(file);
        });
    });
}

QString HandEyeWorkbench::reportFile() const
{
  constexpr double SamePx = 1e-6;
  if (!validation_ || !report_.is_object() || report_.value("count", nlohmann::json()) != validation_->projectionErrorPx.count)
  {
    return {};
  }
  const nlohmann::json file = report_.value("file", nlohmann::json()), meanPx = report_.value("meanPx", nlohmann::json());
  const bool isIts =
    file.is_string() && meanPx.is_number() && std::abs(meanPx.get<double>() - validation_->projectionErrorPx.mean) < SamePx;
  const QString path = isIts ? QString::fromStdString(file.get<std::string>()) : QString();
  return QFileInfo::exists(path) ? path : QString();
}

/// All of what exports are made of.
std::vector<double> HandEyeWorkbench::exportedNumbers() const
{
  std::vector<double> numbers;
  const auto add = [&numbers](const auto& matrix) { numbers.insert(numbers.end(), matrix.data(), matrix.data() + matrix.size()); };
  if (!calibration_ || !calibration_->isUsable())
  {
    return numbers;
  }
  add(calibration_->calibration.markerToCamera.matrix());
  add(calibration_->camera.cameraMatrix());
  const std::vector<double> distortion = calibration_->camera.distortionCoefficients();
  numbers.insert(numbers.end(), distortion.begin(), distortion.end());
  if (stylus_)
  {
    add(stylus_->tip_Stylus);
    if (stylus_->stylusTipToStylus)
    {
      add(stylus_->stylusTipToStylus->matrix());
    }
  }
  if (const std::optional<Eigen::Isometry3d> modelToPhantom = registrationOfModel())
  {
    add(modelToPhantom->matrix());
  }
  return numbers;
}

void HandEyeWorkbench::setExported(const QString& folder)
{
  if (calibration_ && calibration_->isUsable())
  {
    exported_ = ExportDocument{ folder, exportedNumbers() };
    store("export", exportJson(*exported_));
    emit stateChanged();
  }
}

QString HandEyeWorkbench::exportedFolder() const
{
  // Far below what any tracker or program tells apart, and far above what a calibration made anew differs by.
  constexpr double Same = 1e-6;
  const std::vector<double> numbers = exported_ ? exportedNumbers() : std::vector<double>();
  const bool isSame = !numbers.empty() && numbers.size() == exported_->numbers.size() &&
    std::equal(numbers.begin(), numbers.end(), exported_->numbers.begin(),
      [](double a, double b) { return std::abs(a - b) <= Same * std::max(1.0, std::abs(a)); });
  return isSame ? exported_->folder : QString();
}

}  // namespace handeye
