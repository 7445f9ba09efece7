// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonPage.h"
#include "DevicesPage.h"
#include "HandEyeCalibrationPanel.h"
#include "HandEyeWorkbench.h"
#include "LandmarkFiles.h"
#include "LandmarkPanel.h"

#include <QFileInfo>

#include <QFile>
#include <QRegularExpression>

using handeye::WizardStep;

namespace
{

constexpr qint64 MostBytesOfAResult = 16 << 20;

/// What a result file says that it is: "stylus", "calibration", "phantom"...; empty for other files.
QString resultKind(const QString& path)
{
  constexpr int LongestEntry = 80;
  QFile file(path);
  const QByteArray bytes = file.open(QIODevice::ReadOnly) ? file.read(MostBytesOfAResult) : QByteArray();
  const int schema = bytes.indexOf("\"schema\"");  // the entry alone is decoded: this is the window's thread
  static const QRegularExpression entry(QStringLiteral(R"(^"schema"\s*:\s*"handeye-([a-z-]+)/)"));
  return schema < 0 ? QString() : entry.match(QString::fromUtf8(bytes.mid(schema, LongestEntry))).captured(1);
}

}  // namespace

/// A folder with frames, or a sequence metafile: what for, the page says.
void HandEyeCalibrationPanel::openRecording(const QString& path)
{
  switch (currentStep())
  {
    case WizardStep::Stylus:
      workbench().pivot().calibrateRecording(path, workbench().devices().setup().stylusToTracker);
      return;
    case WizardStep::Comparison:
      static_cast<handeye::ComparisonPage*>(page(WizardStep::Comparison))->chooseBoardRecording(path);
      return;
    case WizardStep::Capture:
      workbench().capture().importRecording(path);
      return;
    case WizardStep::Validation:
      workbench().validationCapture().importRecording(path);
      return;
    default:
      goTo(WizardStep::Devices);
      static_cast<handeye::DevicesPage*>(page(WizardStep::Devices))->chooseRecording(path);
  }
}

/// A JSON file goes where it belongs; one that does not say what it is, where the page would take it from a dialog.
void HandEyeCalibrationPanel::openResult(const QString& path)
{
  const QString kind = resultKind(path);
  if (kind == QStringLiteral("truth"))
  {
    workbench().refuse(currentStep(),
      tr("%1 is what is true in a simulation, to compare results with; it is no result to work with.")
        .arg(QFileInfo(path).fileName()));
    return;
  }
  const bool isForThisPage = kind.isEmpty();
  const WizardStep here = currentStep();
  if (kind == QStringLiteral("stylus") || (isForThisPage && here == WizardStep::Stylus))
  {
    goTo(WizardStep::Stylus);
    workbench().loadStylus(path);
  }
  else if (kind == QStringLiteral("phantom") || (isForThisPage && here == WizardStep::Overlay))
  {
    goTo(WizardStep::Overlay);
    workbench().loadRegistration(path);
  }
  else if ((kind == QStringLiteral("calibration") && here != WizardStep::Camera) || (isForThisPage && here == WizardStep::Capture))
  {
    goTo(WizardStep::Capture);
    workbench().loadCalibration(path);
  }
  else
  {
    goTo(WizardStep::Camera);
    workbench().loadCamera(path);
  }
}

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
  const bool isSession = file.fileName() == QStringLiteral("session.json");
  if (isSession || (file.isDir() && QFileInfo::exists(path + QStringLiteral("/session.json"))))
  {
    workbench().openSession(isSession ? file.path() : path);
  }
  else if (file.isDir() || ending == QStringLiteral("mha"))
  {
    openRecording(path);
  }
  else if (meshes.contains(ending))
  {
    goTo(WizardStep::Overlay);
    workbench().loadModel(path);
  }
  else if (ending == QStringLiteral("json"))
  {
    openResult(path);
  }
  else if (ending == QStringLiteral("txt") && handeye::isLandmarkText(path.toStdString()))
  {
    goTo(WizardStep::Overlay);
    page(WizardStep::Overlay)->findChild<handeye::LandmarkPanel*>()->loadModelLandmarks(path);
  }
  else if (cameras.contains(ending))
  {
    goTo(WizardStep::Camera);
    workbench().loadCamera(path);
  }
  else
  {
    return false;
  }
  return true;
}
