// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A session that is left and gone on with: where it was left, what was touched and exported, and what a wrong recording brought.
#include "ExportPanel.h"
#include "LandmarkFiles.h"
#include "LandmarkPanel.h"
#include "SampleTable.h"
#include "SessionMemory.h"
#include "WidgetTestSupport.h"
#include "WizardDemo.h"
#include "WizardPage.h"

#include <QCheckBox>
#include <QTemporaryDir>
#include <QUndoStack>

#include <utility>

using handeye::HandEyeWorkbench;
using handeye::LandmarkPanel;
using handeye::WizardStep;

namespace
{

QVector<LandmarkPanel::Landmark> demoLandmarks()
{
  const auto lists =
    handeye::readLandmarkLists(demo("phantom_model_points.txt").toStdString(), demo("phantom_touched_points.txt").toStdString());
  QVector<LandmarkPanel::Landmark> landmarks;
  for (std::size_t i = 0; i < lists.points_Model.size(); ++i)
  {
    landmarks.append({ QString(), lists.points_Model[i], lists.points_Phantom[i], false });
  }
  return landmarks;
}

}  // namespace

class WizardSessionTest : public QObject
{
  Q_OBJECT

private slots:
  void import_IsUndoneAndMadeAgain();
  void validation_StartsOverAndComesBack();
  void reopened_GoesOnWhereItWasLeft();
  void lastSession_IsOfferedUntilThisOneIsUsed();
  void devices_OfTheSessionStandThereAgain();
  void sessionThatCannotBeOpened_IsSaidAndReplaced();
  void resultOfAnotherSession_IsNobodys();
  void landmarksOfNoSuchMesh_AreRefused();
};

/// A wrong recording is mixed in at once, and taken out at once.
void WizardSessionTest::import_IsUndoneAndMadeAgain()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  loadInputs(panel);
  importCapture(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  auto* const table = panel.page(WizardStep::Capture)->findChild<handeye::SampleTable*>();
  QTRY_COMPARE_WITH_TIMEOUT(table->undoStack()->count(), 1, PatienceMs);
  const int good = table->rows().size();
  QSignalSpy imported(&workbench.capture(), &handeye::CaptureTask::imported);
  QVERIFY(panel.openFile(demo("validation")));
  QVERIFY(imported.wait(PatienceMs));
  QTRY_VERIFY_WITH_TIMEOUT(table->rows().size() > good, PatienceMs);
  const int both = table->rows().size();
  WizardDriver driver(panel);
  QVERIFY2(driver.onPage<QLabel>("hintLabel")->text().contains(QStringLiteral("Undo")), "said where to go back");
  table->undo();
  QTRY_COMPARE_WITH_TIMEOUT(table->rows().size(), good, PatienceMs);
  QTRY_COMPARE_WITH_TIMEOUT(int(workbench.calibration()->frames.size()), good, PatienceMs);
  table->redo();
  QTRY_COMPARE_WITH_TIMEOUT(table->rows().size(), both, PatienceMs);
  table->undo();
  table->undo();
  QTRY_VERIFY_WITH_TIMEOUT(table->rows().isEmpty() && !driver.canGoNext(), PatienceMs);
}

void WizardSessionTest::validation_StartsOverAndComesBack()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  loadInputs(panel);
  importCapture(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  panel.goTo(WizardStep::Validation);
  WizardDriver driver(panel);
  auto* const again = driver.onPage("startOverButton");
  auto* const back = driver.onPage("bringBackButton");
  QVERIFY(!again->isVisible());
  QVERIFY(panel.openFile(demo("validation")));
  QTRY_VERIFY_WITH_TIMEOUT(driver.canGoNext() && !workbench.validationCapture().isBusy(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(again->isVisible() && again->isEnabled(), PatienceMs);
  QTRY_COMPARE_WITH_TIMEOUT(
    workbench.validation()->projectionErrorPx.count, workbench.validationCapture().samples().size(), PatienceMs);
  const int count = workbench.validation()->projectionErrorPx.count;
  const auto* const table = driver.onPage<handeye::SampleTable>("table");
  driver.click(again);
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.validation() && !driver.canGoNext(), PatienceMs);
  QVERIFY(table->rows().isEmpty());
  waitUntilStored(workbench);
  QVERIFY2(!handeye::summarizeSession(workbench.sessionFolder()).isValidated, "what was set aside validates nothing");
  QVERIFY(!again->isVisible() && back->isVisible());
  QVERIFY2(!driver.onPage<QCheckBox>("handsFreeBox")->isChecked(), "the ball that rests there is not taken at once");
  // What is taken meanwhile does not take the way back.
  QVERIFY(panel.openFile(demo("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.validationCapture().isBusy() && !table->rows().isEmpty(), PatienceMs);
  const int others = table->rows().size();
  QVERIFY(back->isVisible());
  driver.click(back);
  QTRY_COMPARE_WITH_TIMEOUT(table->rows().size(), others + count, PatienceMs);
  QVERIFY(!back->isVisible());
}

void WizardSessionTest::reopened_GoesOnWhereItWasLeft()
{
  const QTemporaryDir parent;
  const QString folder = parent.filePath(QStringLiteral("session"));
  double rmsMm = 0;
  {
    HandEyeCalibrationPanel panel(nullptr, nullptr);
    HandEyeWorkbench& workbench = panel.workbench();
    workbench.openSession(folder);
    QSignalSpy opened(&workbench, &HandEyeWorkbench::sessionOpened);
    QVERIFY(opened.wait(PatienceMs));
    testing_widgets::show(panel, QSize(1280, 800));
    loadInputs(panel);
    importCapture(panel);
    panel.goTo(WizardStep::Overlay);
    QTRY_VERIFY_WITH_TIMEOUT(workbench.model(), PatienceMs);
    panel.findChild<LandmarkPanel*>()->setLandmarks(demoLandmarks());
    QTRY_VERIFY_WITH_TIMEOUT(workbench.registration() && workbench.registration()->isUsable(), PatienceMs);
    rmsMm = workbench.registration()->rmsMm;
    panel.goTo(WizardStep::Finish);
    auto* const exports = panel.findChild<handeye::ExportPanel*>();
    exports->setFormats({ QStringLiteral("text") });
    QVERIFY(!workbench.isDone(WizardStep::Finish));
    QVERIFY(exports->exportNow());
    QVERIFY(workbench.isDone(WizardStep::Finish));
    panel.goTo(WizardStep::Overlay);
  }
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  HandEyeWorkbench& workbench = panel.workbench();
  QVERIFY(panel.openFile(folder));
  QTRY_COMPARE_WITH_TIMEOUT(panel.currentStep(), WizardStep::Overlay, PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.registration(), PatienceMs);
  QCOMPARE(workbench.registration()->rmsMm, rmsMm);
  const auto* const landmarks = panel.findChild<LandmarkPanel*>();
  QCOMPARE(landmarks->pairs().landmarks.size(), demoLandmarks().size());
  QVERIFY(landmarks->result() && landmarks->result()->isUsable());
  QVERIFY(!workbench.isRegisteredForAnotherModel());
  QTRY_VERIFY_WITH_TIMEOUT(workbench.calibration() && workbench.calibration()->isUsable(), PatienceMs);
  QVERIFY(workbench.isDone(WizardStep::Finish));
  // Another stylus is in the exports, too.
  workbench.takeStylusTip(workbench.stylus()->tip_Stylus + Eigen::Vector3d(0.5, 0, 0), QStringLiteral("a test"));
  QVERIFY(!workbench.isDone(WizardStep::Finish));
  QVERIFY2(!panel.page(WizardStep::Capture)->findChild<QCheckBox*>(QStringLiteral("handsFreeBox"))->isChecked(),
    "a session with samples takes no others by itself");
  QVERIFY2(panel.page(WizardStep::Validation)->findChild<QCheckBox*>(QStringLiteral("handsFreeBox"))->isChecked(),
    "there is no validation yet");
}

void WizardSessionTest::lastSession_IsOfferedUntilThisOneIsUsed()
{
  const QTemporaryDir parent;
  const QString folder = parent.filePath(QStringLiteral("left"));
  {
    HandEyeCalibrationPanel panel(nullptr, nullptr);
    panel.workbench().openSession(folder);
    loadInputs(panel);
    importCapture(panel);
    waitUntilStored(panel.workbench());
  }
  const handeye::SessionSummary summary = handeye::summarizeSession(folder);
  QVERIFY(summary.isCalibrated && summary.hasStylus && !summary.isValidated && summary.sampleCount > 10);
  {
    // One that is looked at and left is not the last one.
    HandEyeCalibrationPanel panel(nullptr, nullptr);
    QVERIFY(!panel.workbench().isSessionUsed());
  }
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  WizardDriver driver(panel);
  auto* const button = driver.onPage("lastSessionButton");
  QVERIFY(button->isVisible());
  QVERIFY2(driver.visibleText("lastSessionLabel").contains(QStringLiteral("calibrated")),
    qPrintable(driver.visibleText("lastSessionLabel")));
  driver.click(button);
  QTRY_COMPARE_WITH_TIMEOUT(panel.currentStep(), WizardStep::Capture, PatienceMs);
  QCOMPARE(QDir(panel.workbench().sessionFolder()), QDir(folder));
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().calibration() && panel.workbench().calibration()->isUsable(), PatienceMs);
  panel.goTo(WizardStep::Devices);
  QVERIFY(!button->isVisible());
}

void WizardSessionTest::devices_OfTheSessionStandThereAgain()
{
  const QTemporaryDir parent;
  const QString folder = parent.filePath(QStringLiteral("session"));
  {
    HandEyeCalibrationPanel panel(nullptr, nullptr);
    panel.workbench().openSession(folder);
    handeye::DeviceSetup setup;
    setup.kind = handeye::DeviceSetup::Kind::Recording;
    setup.recording = demo("calibration");
    QVERIFY(panel.workbench().connectDevices(setup));
    waitUntilStored(panel.workbench());
  }
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  QSignalSpy opened(&panel.workbench(), &HandEyeWorkbench::sessionOpened);
  QVERIFY(panel.openFile(folder));
  QTRY_VERIFY_WITH_TIMEOUT(opened.count() > 0, PatienceMs);
  QCOMPARE(QDir(panel.workbench().sessionFolder()), QDir(folder));
  WizardDriver driver(panel);
  QTRY_VERIFY_WITH_TIMEOUT(driver.onPage<QAbstractButton>("recordingButton")->isChecked(), PatienceMs);
  driver.click(driver.onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(panel.workbench().devices().isConnected(), PatienceMs);
  QCOMPARE(panel.workbench().devices().setup().recording, demo("calibration"));
}

void WizardSessionTest::sessionThatCannotBeOpened_IsSaidAndReplaced()
{
  const QTemporaryDir parent;
  const QString folder = parent.filePath(QStringLiteral("session"));
  HandEyeCalibrationPanel first(nullptr, nullptr);
  first.workbench().openSession(folder);
  QSignalSpy isOpen(&first.workbench(), &HandEyeWorkbench::sessionOpened);
  QVERIFY(isOpen.wait(PatienceMs));
  // It is in use.
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  panel.goTo(WizardStep::Stylus);
  panel.workbench().openSession(folder);
  WizardDriver driver(panel);
  QTRY_COMPARE_WITH_TIMEOUT(panel.currentStep(), WizardStep::Devices, PatienceMs);
  QTRY_VERIFY2_WITH_TIMEOUT(driver.message().contains(QStringLiteral("new session")), qPrintable(driver.message()), PatienceMs);
  QVERIFY(!panel.workbench().sessionFolder().isEmpty() && panel.workbench().sessionFolder() != folder);
  loadInputs(panel);
  importCapture(panel);
}

/// A recording is pivoted while another session is opened.
void WizardSessionTest::resultOfAnotherSession_IsNobodys()
{
  const QTemporaryDir parent;
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  HandEyeWorkbench& workbench = panel.workbench();
  panel.goTo(WizardStep::Stylus);
  QVERIFY(panel.openFile(demo("pivot.igs.mha")));
  workbench.openSession(parent.filePath(QStringLiteral("another")));
  QSignalSpy opened(&workbench, &HandEyeWorkbench::sessionOpened);
  QVERIFY(opened.wait(PatienceMs));
  waitUntilStored(workbench);
  QTest::qWait(200);
  QVERIFY(!workbench.stylus() && !workbench.isSessionUsed());
}

/// Points that were touched fit themselves, and would draw the model beside its phantom with a small residual.
void WizardSessionTest::landmarksOfNoSuchMesh_AreRefused()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  HandEyeWorkbench& workbench = panel.workbench();
  panel.goTo(WizardStep::Overlay);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.model(), PatienceMs);
  WizardDriver driver(panel);
  auto* const landmarks = panel.findChild<LandmarkPanel*>();
  QVERIFY(landmarks->loadModelLandmarks(demo("phantom_model_points.txt")));
  waitUntilStored(workbench);
  QVERIFY2(!driver.message().contains(QStringLiteral("no landmarks")), qPrintable(driver.message()));
  QVector<LandmarkPanel::Landmark> wrong = demoLandmarks();
  for (LandmarkPanel::Landmark& landmark : wrong)
  {
    landmark.point_Model = *std::exchange(landmark.touched_Phantom, std::nullopt);
  }
  landmarks->setLandmarks(wrong);
  QTRY_VERIFY2_WITH_TIMEOUT(driver.message().contains(QStringLiteral("no landmarks of")), qPrintable(driver.message()), PatienceMs);
  for (LandmarkPanel::Landmark& landmark : wrong)
  {
    landmark.touched_Phantom = landmark.point_Model;
  }
  QSignalSpy refused(&workbench, &HandEyeWorkbench::refused);
  landmarks->setLandmarks(wrong);
  QVERIFY(refused.wait(PatienceMs));
  QVERIFY(!workbench.modelToPhantom() && !workbench.registration());
}

HANDEYE_WIDGET_TEST_MAIN(WizardSessionTest)

#include "WizardSessionTest.moc"
