// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonPage.h"
#include "DevicesPage.h"
#include "HandEyeCalibrationPanel.h"
#include "HandEyeWorkbench.h"

#include <QFileInfo>

using handeye::WizardStep;

bool HandEyeCalibrationPanel::openFile(const QString& path)
{
  const QFileInfo file(path);
  const QString ending = file.suffix().toLower();
  static const QStringList meshes = { QStringLiteral("stl"), QStringLiteral("ply"), QStringLiteral("obj"), QStringLiteral("vtp"),
    QStringLiteral("vtk") };
  static const QStringList cameras = { QStringLiteral("yml"), QStringLiteral("yaml"), QStringLiteral("xml"),
    QStringLiteral("txt") };
  if (!file.exists())
  {
    return false;
  }
  if (file.isDir() && QFileInfo::exists(path + QStringLiteral("/session.json")))
  {
    workbench().openSession(path);
    return true;
  }
  if (file.isDir() || ending == QStringLiteral("mha"))
  {
    if (currentStep() == WizardStep::Stylus)
    {
      workbench().pivot().calibrateRecording(path, workbench().devices().setup().stylusToTracker);
    }
    else if (currentStep() == WizardStep::Comparison)
    {
      static_cast<handeye::ComparisonPage*>(page(WizardStep::Comparison))->chooseBoardRecording(path);
    }
    else if (currentStep() == WizardStep::Capture || currentStep() == WizardStep::Validation)
    {
      (currentStep() == WizardStep::Capture ? workbench().capture() : workbench().validationCapture()).importRecording(path);
    }
    else
    {
      goTo(WizardStep::Devices);
      static_cast<handeye::DevicesPage*>(page(WizardStep::Devices))->chooseRecording(path);
    }
    return true;
  }
  if (meshes.contains(ending))
  {
    goTo(WizardStep::Overlay);
    workbench().loadModel(path);
    return true;
  }
  if (currentStep() == WizardStep::Stylus && ending == QStringLiteral("json"))
  {
    workbench().loadStylus(path);
    return true;
  }
  if (currentStep() == WizardStep::Capture && ending == QStringLiteral("json"))
  {
    workbench().loadCalibration(path);
    return true;
  }
  if (currentStep() == WizardStep::Overlay && ending == QStringLiteral("json"))
  {
    workbench().loadRegistration(path);
    return true;
  }
  if (cameras.contains(ending) || ending == QStringLiteral("json"))
  {
    goTo(WizardStep::Camera);
    workbench().loadCamera(path);
    return true;
  }
  return false;
}
