// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "ExportPanel.h"
#include "LandmarkFiles.h"
#include "LandmarkPanel.h"
#include "ResultFiles.h"
#include "SampleTable.h"
#include "WidgetTestSupport.h"
#include "WizardDemo.h"
#include "WizardDriver.h"
#include "WizardPage.h"
#include "WizardStepBar.h"

#include <QCheckBox>
#include <QLineEdit>
#include <QProcess>
#include <QRadioButton>
#include <QTableView>
#include <QTemporaryDir>
#include <QToolButton>
#include <QUndoStack>

#include <csignal>
#include <fstream>

using handeye::HandEyeWorkbench;
using handeye::WizardStep;

namespace
{

Eigen::Isometry3d trueMarkerToCamera()
{
  std::ifstream file(demo("truth.json").toStdString());
  const nlohmann::json rows = nlohmann::json::parse(file).at("markerToCamera");
  Eigen::Isometry3d markerToCamera;
  for (int i = 0; i < 16; ++i)
  {
    markerToCamera.matrix()(i / 4, i % 4) = rows[std::size_t(i / 4)][std::size_t(i % 4)].get<double>();
  }
  return markerToCamera;
}

void expectTruth(const HandEyeWorkbench& workbench)
{
  const Eigen::Isometry3d cameraToMarker = trueMarkerToCamera().inverse();
  const Eigen::Isometry3d error = workbench.calibration()->calibration.markerToCamera * cameraToMarker;
  const Eigen::AngleAxisd turn(error.linear());
  Eigen::Matrix<double, 6, 1> motion;
  motion << turn.angle() * turn.axis(), error.translation();
  const double mahalanobis = std::sqrt(motion.dot(workbench.calibration()->calibration.covariance.ldlt().solve(motion)));
  qInfo(
    "off the truth by %.3f deg, %.2f mm, %.1f sigma (6 freedoms)", turn.angle() * 57.2958, error.translation().norm(), mahalanobis);
  QVERIFY(mahalanobis < 4.5);  // the 99.7 % quantile of chi with 6 degrees of freedom, what 3 sigma are for one
  QVERIFY(turn.angle() < 0.5 / 57.2958);
  QVERIFY(error.translation().norm() < 3);
}

/// Collects samples and dies of SIGKILL in the middle.
int captureAndDie(const QString& folder)
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  printRefusals(panel);
  panel.workbench().openSession(folder);
  loadInputs(panel);
  QObject::connect(&panel.workbench().capture(), &handeye::CaptureTask::samplesChanged,
    [&panel]
    {
      if (panel.workbench().capture().samples().size() >= 7)
      {
        printf("announced %d\n", panel.workbench().capture().samples().size());
        fflush(stdout);
        raise(SIGKILL);
      }
    });
  panel.openFile(demo("calibration"));
  QTest::qWait(20000);
  return 1;
}

}  // namespace

/// The wizard with recordings instead of live devices; what is done to samples; what comes back.
class WizardRecordingTest : public QObject
{
  Q_OBJECT

private slots:
  void recording_FromFirstPageToLast();
  void samples_ExcludeDeleteUndoRedo();
  void session_ReopenedBringsEverythingBack();
  void session_KilledKeepsWhatWasAnnounced();
  void calibrationOfAnotherTime_IsValidated();
  void evaluation_CancelledIsSaidAndMadeUpFor();
  void sessionOpenedDuringWork_KeepsItsOwnSamples();
  void anotherSession_HasNothingOfTheOneBefore();
};

/// Another radius asks for the stored samples to be looked at again; as long as that is not done, nothing is calibrated from them.
void WizardRecordingTest::evaluation_CancelledIsSaidAndMadeUpFor()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  loadInputs(panel);
  importCapture(panel);
  WizardDriver driver(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  QVERIFY(!driver.onPage("againButton")->isVisible());
  workbench.setBallRadius(15.2);
  QTRY_VERIFY_WITH_TIMEOUT(driver.find("cancelButton")->isVisible(), PatienceMs);
  driver.click(driver.find("cancelButton"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.capture().isBroken(), PatienceMs);
  QVERIFY2(driver.message().contains(QStringLiteral("cancelled")), qPrintable(driver.message()));
  QVERIFY2(driver.reason().contains(QStringLiteral("Look again")), qPrintable(driver.reason()));
  QVERIFY(!driver.canGoNext());
  QTRY_VERIFY(!workbench.calibration());
  QVERIFY(driver.onPage("againButton")->isVisible());
  driver.click(driver.onPage("againButton"));
  QTRY_VERIFY_WITH_TIMEOUT(
    !workbench.capture().isBusy() && workbench.calibration() && workbench.calibration()->isUsable(), PatienceMs);
  QCOMPARE(workbench.calibration()->ballRadiusMm, 15.2);
  QVERIFY(!driver.onPage("againButton")->isVisible());
  QVERIFY2(!driver.message().contains(QStringLiteral("cancelled")), qPrintable(driver.message()));
}

/// Samples that are being looked at while another session is opened stay those of their session.
void WizardRecordingTest::sessionOpenedDuringWork_KeepsItsOwnSamples()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  loadInputs(panel);
  importCapture(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  workbench.setBallRadius(15.2);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.capture().isBusy(), PatienceMs);
  QVERIFY(workbench.capture().isStale());
  const QTemporaryDir folder;
  workbench.loadModel(HandEyeWorkbench::ownModel());
  workbench.openSession(folder.filePath(QStringLiteral("another")));
  QVERIFY(!workbench.capture().isBusy() && !workbench.capture().isStale());
  bool isThrough = false;
  workbench.afterStoring([&isThrough] { isThrough = true; });
  QTRY_VERIFY_WITH_TIMEOUT(isThrough, PatienceMs);
  QTest::qWait(300);
  QVERIFY(workbench.capture().samples().isEmpty());
  QVERIFY(!workbench.calibration() && !workbench.model());
  QVERIFY(!workbench.capture().isBusy() && !workbench.capture().isStale());
  // And it works.
  loadInputs(panel);
  importCapture(panel);
  QVERIFY(workbench.calibration()->isUsable());
}

void WizardRecordingTest::anotherSession_HasNothingOfTheOneBefore()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  loadInputs(panel);
  importCapture(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  panel.goTo(WizardStep::Finish);
  const auto exportFolder = [&panel] { return panel.findChild<handeye::ExportPanel*>()->folder(); };
  const QString before = exportFolder();
  panel.goTo(WizardStep::Overlay);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.model(), PatienceMs);
  const auto landmarks =
    handeye::readLandmarkLists(demo("phantom_model_points.txt").toStdString(), demo("phantom_touched_points.txt").toStdString());
  workbench.registerLandmarks(landmarks.points_Model, landmarks.points_Phantom);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.modelToPhantom(), PatienceMs);
  panel.goTo(WizardStep::Devices);
  QTemporaryDir folder;
  workbench.openSession(folder.filePath(QStringLiteral("another")));
  QVERIFY(!workbench.model() && workbench.modelPath().isEmpty() && !workbench.modelToPhantom() && !workbench.registration());
  QVERIFY(!workbench.camera() && !workbench.stylus());
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.calibration() && workbench.capture().samples().isEmpty(), PatienceMs);
  panel.goTo(WizardStep::Finish);
  QVERIFY(exportFolder() != before);
  QVERIFY2(exportFolder().startsWith(folder.path()), qPrintable(exportFolder()));
}

void WizardRecordingTest::recording_FromFirstPageToLast()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  printRefusals(panel);
  testing_widgets::show(panel, QSize(1280, 800));
  HandEyeWorkbench& workbench = panel.workbench();
  WizardDriver driver(panel);

  driver.check(driver.onPage<QRadioButton>("recordingButton"));
  driver.onPage<QLineEdit>("recordingEdit")->setText(demo("calibration"));
  driver.click(driver.onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  driver.click(driver.find("nextButton"));

  QCOMPARE(panel.currentStep(), WizardStep::Camera);
  QVERIFY(!driver.canGoNext());
  QVERIFY(panel.openFile(demo("camera.yml")));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  driver.click(driver.find("nextButton"));

  QVERIFY(!driver.canGoNext());
  QVERIFY(panel.openFile(demo("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  driver.click(driver.find("nextButton"));

  QCOMPARE(panel.currentStep(), WizardStep::Ball);
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  driver.click(driver.find("nextButton"));

  QCOMPARE(panel.currentStep(), WizardStep::Capture);
  driver.check(driver.onPage<QCheckBox>("handsFreeBox"));
  importCapture(panel);
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  expectTruth(workbench);
  driver.click(driver.find("nextButton"));

  QCOMPARE(panel.currentStep(), WizardStep::Validation);
  driver.check(driver.onPage<QCheckBox>("handsFreeBox"));
  QVERIFY(!driver.canGoNext());
  QVERIFY(panel.openFile(demo("validation")));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.validationCapture().isBusy(), PatienceMs);
  QVERIFY2(workbench.validation()->projectionErrorPx.mean < 3, qPrintable(driver.message()));
  driver.click(driver.find("nextButton"));

  // The comparison can be left out.
  QCOMPARE(panel.currentStep(), WizardStep::Comparison);
  QVERIFY(driver.canGoNext());
  driver.click(driver.find("nextButton"));

  QCOMPARE(panel.currentStep(), WizardStep::Overlay);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.model() != nullptr, PatienceMs);
  QVERIFY(!driver.canGoNext());
  QVERIFY2(driver.reason().contains(QStringLiteral("The phantom is not registered")), qPrintable(driver.reason()));
  const QTemporaryDir folder;
  const auto landmarks =
    handeye::readLandmarkLists(demo("phantom_model_points.txt").toStdString(), demo("phantom_touched_points.txt").toStdString());
  const QString phantom = folder.filePath(QStringLiteral("phantom.json"));
  handeye::writeJson(
    phantom.toStdString(), handeye::phantomJson(handeye::registerLandmarks(landmarks.points_Model, landmarks.points_Phantom)));
  QVERIFY(panel.openFile(phantom));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  driver.click(driver.find("nextButton"));
  QCOMPARE(panel.currentStep(), WizardStep::Finish);

  // Back loses nothing
  for (int i = 0; i < 8; ++i)
  {
    driver.click(driver.find("backButton"));
  }
  QCOMPARE(panel.currentStep(), WizardStep::Devices);
  QVERIFY(workbench.calibration()->isUsable() && workbench.validation() && workbench.modelToPhantom());

  // Result files go where they belong, whatever page is open when they are dropped.
  HandEyeCalibrationPanel other(nullptr, nullptr);
  testing_widgets::show(other, QSize(1280, 800));
  const Eigen::Isometry3d markerToCamera = workbench.calibration()->calibration.markerToCamera;
  for (const auto& [name, step] : { std::pair("stylus", WizardStep::Stylus), std::pair("calibration", WizardStep::Capture),
         std::pair("phantom", WizardStep::Overlay) })
  {
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(workbench.documentPath(QString::fromLatin1(name))), PatienceMs);
    QVERIFY(other.openFile(workbench.documentPath(QString::fromLatin1(name))));
    QCOMPARE(other.currentStep(), step);
  }
  QTRY_VERIFY_WITH_TIMEOUT(other.workbench().modelToPhantom().has_value(), PatienceMs);
  other.goTo(WizardStep::Camera);
  QVERIFY(other.openFile(demo("phantom_model_points.txt")));
  QCOMPARE(other.currentStep(), WizardStep::Overlay);
  QVERIFY(other.findChild<handeye::LandmarkPanel*>()->landmarks().size() >= 3);
  QVERIFY(other.workbench().stylus() && other.workbench().camera());
  QVERIFY(other.workbench().calibration()->calibration.markerToCamera.isApprox(markerToCamera, 1e-6));
}

void WizardRecordingTest::samples_ExcludeDeleteUndoRedo()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  printRefusals(panel);
  testing_widgets::show(panel, QSize(1280, 800));
  HandEyeWorkbench& workbench = panel.workbench();
  loadInputs(panel);
  importCapture(panel);
  const int all = workbench.calibration()->calibration.usedCount;
  auto* table = panel.page(WizardStep::Capture)->findChild<handeye::SampleTable*>();
  const int first = table->rows().first().id;
  const auto taking = [&] { return int(workbench.calibration()->frames.size()); };
  const int count = taking();

  table->selectSample(first);
  table->excludeSelected(true);
  QTRY_COMPARE_WITH_TIMEOUT(taking(), count - 1, PatienceMs);
  QVERIFY(workbench.calibration()->calibration.usedCount <= all);
  QVERIFY(workbench.capture().samples()[first].isExcluded);
  table->undo();
  QTRY_COMPARE_WITH_TIMEOUT(taking(), count, PatienceMs);
  table->redo();
  QTRY_COMPARE_WITH_TIMEOUT(taking(), count - 1, PatienceMs);
  table->undo();
  QTRY_COMPARE_WITH_TIMEOUT(taking(), count, PatienceMs);

  table->selectSample(first);
  table->deleteSelected();
  QTRY_COMPARE_WITH_TIMEOUT(taking(), count - 1, PatienceMs);
  QCOMPARE(table->rows().size(), count - 1);
  table->undo();
  QTRY_COMPARE_WITH_TIMEOUT(taking(), count, PatienceMs);
  QCOMPARE(table->rows().size(), count);
}

void WizardRecordingTest::session_ReopenedBringsEverythingBack()
{
  const QTemporaryDir parent;
  const QString folder = parent.filePath(QStringLiteral("session"));
  Eigen::Isometry3d markerToCamera;
  int samples = 0, excluded = -1, deleted = -1, validated = 0;
  {
    HandEyeCalibrationPanel panel(nullptr, nullptr);
    printRefusals(panel);
    HandEyeWorkbench& workbench = panel.workbench();
    workbench.openSession(folder);
    QSignalSpy opened(&workbench, &HandEyeWorkbench::sessionOpened);
    QVERIFY(opened.wait(PatienceMs));
    loadInputs(panel);
    importCapture(panel);
    workbench.setBallRadius(15.0);
    excluded = workbench.capture().samples().keys()[2];
    deleted = workbench.capture().samples().keys()[4];
    samples = workbench.capture().samples().size();
    workbench.capture().setExcluded({ excluded }, true);
    workbench.capture().setDeleted({ deleted }, true);
    QTRY_COMPARE_WITH_TIMEOUT(int(workbench.calibration()->frames.size()), samples - 2, PatienceMs);
    panel.goTo(WizardStep::Validation);
    QVERIFY(panel.openFile(demo("validation")));
    QTRY_VERIFY_WITH_TIMEOUT(workbench.validation() && !workbench.validationCapture().isBusy(), PatienceMs);
    QTRY_COMPARE_WITH_TIMEOUT(
      workbench.validation()->projectionErrorPx.count, workbench.validationCapture().samples().size(), PatienceMs);
    validated = workbench.validation()->projectionErrorPx.count;
    markerToCamera = workbench.calibration()->calibration.markerToCamera;
  }
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  printRefusals(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  QVERIFY(panel.openFile(folder));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.validation() && workbench.validation()->projectionErrorPx.count == validated, PatienceMs);
  QCOMPARE(workbench.capture().samples().size(), samples);
  QVERIFY(workbench.capture().samples()[excluded].isExcluded);
  QVERIFY(workbench.capture().samples()[deleted].isDeleted);
  QVERIFY(workbench.camera()->origin.endsWith(QStringLiteral("camera.yml")));
  QVERIFY(workbench.calibration()->calibration.markerToCamera.isApprox(markerToCamera, 1e-9));
  for (const WizardStep step :
    { WizardStep::Camera, WizardStep::Stylus, WizardStep::Ball, WizardStep::Capture, WizardStep::Validation })
  {
    QVERIFY2(workbench.problemOf(step).isEmpty(), qPrintable(workbench.problemOf(step)));
  }
}

void WizardRecordingTest::session_KilledKeepsWhatWasAnnounced()
{
  const QTemporaryDir parent;
  const QString folder = parent.filePath(QStringLiteral("session"));
  QProcess child;
  child.start(QCoreApplication::applicationFilePath(), { QStringLiteral("--capture-and-die"), folder });
  QTRY_VERIFY_WITH_TIMEOUT(child.state() == QProcess::NotRunning, PatienceMs);
  QCOMPARE(child.exitStatus(), QProcess::CrashExit);
  const QByteArray output = child.readAllStandardOutput();
  QVERIFY2(output.contains("announced"), output);
  const int announced = output.mid(output.lastIndexOf("announced") + 10).trimmed().toInt();
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  printRefusals(panel);
  QVERIFY(panel.openFile(folder));
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().capture().samples().size() >= announced, PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().calibration() && panel.workbench().calibration()->isUsable(), PatienceMs);
}

void WizardRecordingTest::calibrationOfAnotherTime_IsValidated()
{
  const QTemporaryDir parent;
  const QString file = parent.filePath(QStringLiteral("calibration.json"));
  {
    HandEyeCalibrationPanel panel(nullptr, nullptr);
    loadInputs(panel);
    importCapture(panel);
    const QString stored = panel.workbench().documentPath(QStringLiteral("calibration"));
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(stored), PatienceMs);
    QVERIFY(QFile::copy(stored, file));
  }
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  WizardDriver driver(panel);
  panel.goTo(WizardStep::Capture);
  QVERIFY(!driver.canGoNext());
  QVERIFY(panel.openFile(file));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  driver.click(driver.find("nextButton"));
  QVERIFY(panel.openFile(demo("validation")));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext(), PatienceMs);
  QVERIFY(panel.workbench().validation()->projectionErrorPx.mean < 3);
}

int main(int argc, char** argv)
{
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
  QApplication application(argc, argv);
  QApplication::setStyle(QStringLiteral("Fusion"));
  const QStringList arguments = QApplication::arguments();
  if (arguments.size() == 3 && arguments[1] == QStringLiteral("--capture-and-die"))
  {
    return captureAndDie(arguments[2]);
  }
  WizardRecordingTest test;
  return QTest::qExec(&test, argc, argv);
}

#include "WizardRecordingTest.moc"
