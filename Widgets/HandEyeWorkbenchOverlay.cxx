// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QSaveFile>

#include <stdexcept>

namespace handeye
{

namespace
{

using PoseMap = std::map<std::string, PoseAtTime>;

const PoseAtTime* usablePose(const PoseMap& poses, const QString& name)
{
  const auto pose = poses.find(name.toStdString());
  return pose != poses.end() && pose->second.isUsable() ? &pose->second : nullptr;
}

}  // namespace

std::optional<OverlayTransforms> HandEyeWorkbench::overlayTransforms(QString& reason) const
{
  if (!calibration_ || !calibration_->isUsable())
  {
    reason = tr("The camera is not calibrated yet.");
    return std::nullopt;
  }
  if (!modelToPhantom_)
  {
    reason = tr("The phantom is not registered yet: touch its landmarks, or load a registration.");
    return std::nullopt;
  }
  if (isRegisteredForAnotherModel())
  {
    reason = tr("The phantom was registered for %1, not for this mesh: touch its landmarks again, load a registration, or keep the "
                "one there is if both meshes lie in the same coordinates.")
               .arg(QFileInfo(registeredModelPath_).fileName());
    return std::nullopt;
  }
  return OverlayTransforms{ calibration_->calibration.markerToCamera, *modelToPhantom_ };
}

std::optional<Eigen::Isometry3d> HandEyeWorkbench::stylusTipTo(
  const Eigen::Isometry3d& markerToCamera, const devices::PairedFrame& frame) const
{
  const DeviceSetup& setup = devices_->setup();
  const PoseAtTime* marker = usablePose(frame.poses, setup.markerToTracker);
  const PoseAtTime* stylus = usablePose(frame.poses, setup.stylusToTracker);
  if (!stylus_ || !marker || !stylus)
  {
    return std::nullopt;
  }
  Eigen::Isometry3d tipAlone = Eigen::Isometry3d::Identity();
  tipAlone.translation() = stylus_->tip_Stylus;
  return toStylusTipToCamera(markerToCamera, marker->transform, stylus->transform, stylus_->stylusTipToStylus.value_or(tipAlone));
}

std::optional<Eigen::Isometry3d> HandEyeWorkbench::stylusTipToCamera(const devices::PairedFrame& frame) const
{
  const bool isKnown = calibration_ && calibration_->isUsable();
  return isKnown ? stylusTipTo(calibration_->calibration.markerToCamera, frame) : std::nullopt;
}

std::optional<Eigen::Isometry3d> HandEyeWorkbench::stylusTipToRightCamera(const devices::PairedFrame& frame) const
{
  const std::optional<CalibratedEye> eye = rightEye();
  return eye ? stylusTipTo(eye->markerToCamera, frame) : std::nullopt;
}

std::optional<Eigen::Matrix<double, 6, 6>> HandEyeWorkbench::calibrationCovariance() const
{
  const bool isKnown = calibration_ && calibration_->isUsable() && !calibration_->calibration.covariance.isZero(0) &&
    calibration_->calibration.covariance.allFinite();
  return isKnown ? std::optional(calibration_->calibration.covariance) : std::nullopt;
}

void HandEyeWorkbench::saveSnapshot(const QImage& picture)
{
  if (picture.isNull() || !capture_->isOpen())
  {
    refuse(WizardStep::Overlay, picture.isNull() ? tr("There is no video to take a picture of.") : tr("No session is open."));
    return;
  }
  const QString time = QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-HHmmss-zzz"));
  const QString path = capture_->folder() + QStringLiteral("/snapshots/overlay-%1.png").arg(time);
  beside(WizardStep::Overlay,
    [this, picture, path]
    {
      QSaveFile file(path);
      const bool isWritten =
        QDir().mkpath(QFileInfo(path).path()) && file.open(QIODevice::WriteOnly) && picture.save(&file, "PNG") && file.commit();
      if (!isWritten)
      {
        throw std::runtime_error(tr("%1 cannot be written: %2").arg(path, file.errorString()).toStdString());
      }
      tell(
        [this, path]
        {
          emit snapshotSaved(path);
          emit happened(tr("picture of the overlay: %1").arg(path));
        });
    });
}

}  // namespace handeye
