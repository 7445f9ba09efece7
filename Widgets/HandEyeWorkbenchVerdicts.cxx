// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

namespace handeye
{

QString HandEyeWorkbench::missingFor(WizardStep step) const
{
  if (step == WizardStep::Devices || step == WizardStep::Camera || step == WizardStep::Stylus)
  {
    return {};
  }
  if (!camera_)
  {
    return tr("The camera's lens is not known: load a camera file on the page Camera.");
  }
  if (step == WizardStep::Ball)
  {
    return {};
  }
  if (!stylus_)
  {
    return tr("The stylus is not calibrated: pivot it, or load a stylus file, on the page Stylus.");
  }
  if (step == WizardStep::Capture)
  {
    return {};
  }
  if (step == WizardStep::Comparison)
  {
    return missingForComparison();
  }
  if (!calibration_ || !calibration_->isUsable())
  {
    return tr("There is no calibration yet: collect placements of the ball on the page Capture.");
  }
  return {};
}

bool HandEyeWorkbench::isDone(WizardStep step) const
{
  switch (step)
  {
    case WizardStep::Comparison:
      return comparison_->result() != nullptr;
    case WizardStep::Finish:
      return !exportedFolder().isEmpty();
    default:
      return problemOf(step).isEmpty();
  }
}

QString HandEyeWorkbench::problemOf(WizardStep step) const
{
  if (step == WizardStep::Comparison)
  {
    return {};  // can be left out
  }
  const QString missing = missingFor(step);
  if (!missing.isEmpty())
  {
    return missing;
  }
  switch (step)
  {
    case WizardStep::Devices:
      return devices_->missing(true);
    case WizardStep::Camera:
      return camera_ ? QString() : tr("Load a camera file, or calibrate the lens with a board.");
    case WizardStep::Stylus:
      return pivot_->isCollecting() ? tr("The pivoting is still under way.")
        : stylus_                   ? QString()
                                    : tr("Pivot the stylus, or load a stylus file.");
    case WizardStep::Ball:
      return ball_.wasSeen || !capture_->samples().isEmpty()
        ? QString()
        : tr("The ball has not been found yet: hold it into the view, and click on it if it is not marked.");
    case WizardStep::Capture:
      if (capture_->isBusy())
      {
        return tr("The samples are being looked at.");
      }
      if (capture_->isBroken())
      {
        return tr("The stored samples have not been looked at to the end: press Look again.");
      }
      return calibration_ && calibration_->isUsable() ? QString()
        : calibration_                                ? QString::fromStdString(calibration_->decisive().message)
                                                      : tr("There are no samples yet.");
    case WizardStep::Validation:
      if (validationCapture_->isBroken())
      {
        return tr("The stored placements have not been looked at to the end: press Look again.");
      }
      return validation_ && validation_->isUsable()
        ? QString()
        : tr("Hold the ball at a few other places, so that the calibration is tested on them.");
    case WizardStep::Overlay:
      return !model_.mesh                   ? tr("Load a model.")
        : isRegisteredForAnotherModel()     ? tr("Register the phantom for this mesh, or keep the registration there is.")
        : modelToPhantom_                   ? QString()
        : registration_ && !isTouchingAnew_ ? QString::fromStdString(registration_->message)
                                            : tr("The phantom is not registered.");
    case WizardStep::Comparison:
    case WizardStep::Finish:
      return {};
  }
  return {};
}

Level HandEyeWorkbench::levelOf(WizardStep step) const
{
  if (step == WizardStep::Capture && calibration_)
  {
    // Of one that was loaded the file does not say how good it is here.
    return isCalibrationLoaded_ ? Level::Info : errorLevel(calibration_->calibration.predicted.meanPx);
  }
  if (step == WizardStep::Validation && validation_)
  {
    // Few frames say little, however good they look; the verdict's own words ask for five.
    constexpr int EnoughFrames = 5;
    const Level level = errorLevel(validation_->projectionErrorPx.mean);
    return level == Level::Good && validation_->projectionErrorPx.count < EnoughFrames ? Level::Warning : level;
  }
  return step == WizardStep::Overlay && isTouchingAnew_ ? Level::Warning : Level::Good;
}

QString HandEyeWorkbench::verdictOf(WizardStep step) const
{
  switch (step)
  {
    case WizardStep::Devices:
      return devices_->missing(true).isEmpty() ? tr("Stylus, camera marker and video arrive.") : QString();
    case WizardStep::Camera:
      return camera_ ? tr("The lens is known.") : QString();
    case WizardStep::Stylus:
      return stylus_ ? stylus_->message : QString();
    case WizardStep::Ball:
      return ball_.wasSeen ? tr("The ball has been found with this radius and colour.") : QString();
    case WizardStep::Capture:
      return calibration_ && calibration_->isUsable() ? QString::fromStdString(calibration_->calibration.message) : QString();
    case WizardStep::Validation:
      return validation_ ? QString::fromStdString(validation_->message) : QString();
    case WizardStep::Overlay:
      return isTouchingAnew_ && modelToPhantom_      ? tr("The registration of before stays in use until 3 landmarks are touched.")
        : registration_ && registration_->isUsable() ? QString::fromStdString(registration_->message)
        : modelToPhantom_ ? tr("The phantom is registered, by a file or by the session as it was opened.")
                          : QString();
    case WizardStep::Comparison:
    case WizardStep::Finish:
      break;
  }
  return {};
}

}  // namespace handeye
