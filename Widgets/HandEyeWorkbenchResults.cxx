// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include "MeshReader.h"
#include "OverlayPose.h"
#include "ResultFiles.h"
#include "ValidationReport.h"
#include "WindowPlots.h"
#include "WorkThread.h"

#include <QCoreApplication>
#include <QFileInfo>

#include <dlfcn.h>
#include <fstream>
#include <utility>

namespace handeye
{

namespace
{

/// The folder of the file that this code is a part of: the plugin, wherever it was installed, or a program.
QString ownFolder()
{
  Dl_info info{};
  const bool isKnown = dladdr(reinterpret_cast<const void*>(&ownFolder), &info) != 0 && info.dli_fname;
  return isKnown ? QFileInfo(QString::fromLocal8Bit(info.dli_fname)).absolutePath() : QCoreApplication::applicationDirPath();
}

/// A file that is installed with the plugin, or lies in the source folder that it was built from.
QString meshFile(const char* name)
{
  for (const QString& folder : { ownFolder() + QStringLiteral("/" HANDEYE_MESHES_FROM_MODULE), QStringLiteral(HANDEYE_MESHES_DIR) })
  {
    const QString file = folder + QLatin1Char('/') + QString::fromLatin1(name);
    if (QFileInfo::exists(file))
    {
      return file;
    }
  }
  return {};
}

/// A result file that was read already by the reader of its kind.
nlohmann::json readDocument(const std::filesystem::path& path)
{
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

}  // namespace

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
      nlohmann::json document = readDocument(file);
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
          stylus_ =
            Stylus{ stored.tip_Stylus, Eigen::Matrix3d::Zero(), 0, tr("The tip is that of the calibration %1").arg(path), {} };
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
  const report::PlotDrawer draw = drawInWindowThread(*this, [thread = work_.get()] { return thread->isEnding(); });
  beside(WizardStep::Finish,
    [this, folder, recording, draw, validation = *validation_]
    {
      writeValidationReport(folder.toStdString(), validation, io::Recording::open(recording), draw);
      tell([this, folder] { emit reportWritten(folder + QStringLiteral("/report.html")); });
    });
}

QString HandEyeWorkbench::ownModel()
{
  return meshFile("Vertebra.ply");
}

QString HandEyeWorkbench::ownLandmarks()
{
  return meshFile("VertebraLandmarks.txt");
}

void HandEyeWorkbench::loadModel(const QString& path)
{
  wantedModelPath_ = path;
  beside(WizardStep::Overlay,
    [this, path]
    {
      const OverlayMesh mesh = prepareOverlayMesh(readMesh(path.toStdString()));
      tell(
        [this, mesh, path]
        {
          if (path != wantedModelPath_)
          {
            return;  // another one was asked for meanwhile
          }
          model_ = mesh;
          modelPath_ = path;
          registeredModelPath_ = registeredModelPath_.isEmpty() ? path : registeredModelPath_;
          storeModel();
          emit modelChanged();
          emit registrationChanged();
          emit stateChanged();
        });
    });
}

void HandEyeWorkbench::storeModel()
{
  store("model", { { "file", modelPath_.toStdString() }, { "registeredFile", registeredModelPath_.toStdString() } });
}

void HandEyeWorkbench::setModelToPhantom(const std::optional<Eigen::Isometry3d>& modelToPhantom, const QString& madeForModel)
{
  modelToPhantom_ = modelToPhantom;
  isTouchingAnew_ = false;
  registeredModelPath_ = madeForModel.isEmpty() ? modelPath_ : madeForModel;
  if (!modelPath_.isEmpty())
  {
    storeModel();
  }
  emit registrationChanged();
  emit stateChanged();
}

bool HandEyeWorkbench::isRegisteredForAnotherModel() const
{
  return modelToPhantom_ && !modelPath_.isEmpty() && registeredModelPath_ != modelPath_;
}

void HandEyeWorkbench::keepRegistration()
{
  setModelToPhantom(modelToPhantom_, modelPath_);
}

void HandEyeWorkbench::registerLandmarks(
  const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom)
{
  beside(WizardStep::Overlay,
    [this, points_Model, points_Phantom, touchedModel = modelPath_]
    {
      const LandmarkRegistrationResult result = handeye::registerLandmarks(points_Model, points_Phantom);
      tell(
        [this, result, touchedModel]
        {
          registration_ = result;
          // One that was refused does not come back with the session.
          store("phantom", result.isUsable() ? phantomJson(result) : nlohmann::json());
          setModelToPhantom(result.isUsable() ? std::optional(result.modelToPhantom) : std::nullopt, touchedModel);
        });
    });
}

void HandEyeWorkbench::setTouchingAnew(bool isAnew)
{
  if (isTouchingAnew_ != isAnew)
  {
    isTouchingAnew_ = isAnew;
    emit stateChanged();
  }
}

void HandEyeWorkbench::loadRegistration(const QString& path, const QString& madeForModel)
{
  beside(WizardStep::Overlay,
    [this, path, madeForModel]
    {
      const Eigen::Isometry3d modelToPhantom = readPhantomRegistration(path.toStdString());
      tell(
        [this, modelToPhantom, madeForModel, document = readDocument(path.toStdString())]
        {
          store("phantom", document);
          registration_.reset();
          setModelToPhantom(modelToPhantom, madeForModel);
        });
    });
}

void HandEyeWorkbench::saveRegistration(const QString& path)
{
  if (registration_ && registration_->isUsable())
  {
    beside(WizardStep::Overlay, [path, document = phantomJson(*registration_)] { writeJson(path.toStdString(), document); });
  }
}

}  // namespace handeye
