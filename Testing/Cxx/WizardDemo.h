// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibrationPanel.h"
#include "HandEyeWorkbench.h"
#include "WizardDriver.h"

#include <QString>
#include <QtTest>

/// A file or folder of the demo's recordings.
inline QString demo(const char* name)
{
  return QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/") + QString::fromLatin1(name);
}

/// Camera and stylus from files, so that captures can be taken.
inline void loadInputs(HandEyeCalibrationPanel& panel)
{
  QVERIFY(panel.openFile(demo("camera.yml")));
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().camera().has_value(), PatienceMs);
  panel.goTo(handeye::WizardStep::Stylus);
  QVERIFY(panel.openFile(demo("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().stylus().has_value(), PatienceMs);
  panel.goTo(handeye::WizardStep::Capture);
}

inline void importCapture(HandEyeCalibrationPanel& panel)
{
  QVERIFY(panel.openFile(demo("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(!panel.workbench().capture().isBusy() && panel.workbench().capture().samples().size() > 10, PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().calibration() && panel.workbench().calibration()->isUsable(), PatienceMs);
}
