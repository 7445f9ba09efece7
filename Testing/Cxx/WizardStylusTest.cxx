// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DirectionDome.h"
#include "FaultyServer.h"
#include "ResultFiles.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "WizardPage.h"
#include "WizardScreens.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <QLineEdit>
#include <QProgressBar>
#include <QRadioButton>
#include <QRegularExpression>
#include <QScreen>
#include <vtkSmartPointer.h>

#include <memory>

using handeye::HandEyeWorkbench;
using handeye::WizardStep;

/// The page Stylus in the simulated room: pivoted, and spun.
class WizardStylusTest : public QObject
{
  Q_OBJECT

private slots:
  void init();
  void cleanup();

  void pivot_SaysOneCount_AndWhyItEnds();
  void spin_FindsTheShaft_StoresItAndIsNotNeeded();
  void spin_Cancelled_LeavesTheStylusAsItWas();
  void spin_OfAStylusThatLiesStill_IsRefusedInWords();
  void pivot_Anew_ForgetsTheShaft();

private:
  HandEyeWorkbench& workbench() { return panel_->workbench(); }
  QString text(const char* name) { return driver_->onPage<QLabel>(name)->text(); }
  void connectToRoom();
  void pivot();
  void photograph(const QString& name);

  vtkSmartPointer<vtkSlicerHandEyeCalibrationLogic> logic_;
  std::unique_ptr<HandEyeCalibrationPanel> panel_;
  std::unique_ptr<WizardDriver> driver_;
};

void WizardStylusTest::init()
{
  logic_ = vtkSmartPointer<vtkSlicerHandEyeCalibrationLogic>::New();  // one that knows no stylus
  panel_ = std::make_unique<HandEyeCalibrationPanel>(logic_, nullptr);
  driver_ = std::make_unique<WizardDriver>(*panel_);
  testing_widgets::show(*panel_, QSize(1280, 800));
}

void WizardStylusTest::cleanup()
{
  driver_.reset();
  panel_.reset();
}

void WizardStylusTest::connectToRoom()
{
  panel_->goTo(WizardStep::Devices);
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
  panel_->goTo(WizardStep::Stylus);
}

void WizardStylusTest::pivot()
{
  driver_->click(driver_->onPage("startButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
}

void WizardStylusTest::photograph(const QString& name)
{
  QTest::qWait(300);
  const QString file = QStringLiteral("%1/%2.png").arg(screenshotFolder(), name);
  QVERIFY2(panel_->screen()->grabWindow(panel_->winId()).save(file), qPrintable(file));
  QVERIFY2(faultsOf(*panel_).isEmpty(), qPrintable(faultsOf(*panel_).join(QLatin1Char('\n'))));
}

void WizardStylusTest::pivot_SaysOneCount_AndWhyItEnds()
{
  connectToRoom();
  QVERIFY2(text("introLabel").contains(QStringLiteral("ends by itself")), qPrintable(text("introLabel")));
  driver_->click(driver_->onPage("startButton"));
  auto* const dome = driver_->onPage<handeye::DirectionDome>("dome");
  QTRY_VERIFY_WITH_TIMEOUT(dome->filledCount() > 3 || driver_->canGoNext(), PatienceMs);
  photograph(QStringLiteral("stylus-pivoting"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(text("introLabel").startsWith(QStringLiteral("Enough")), PatienceMs);
  photograph(QStringLiteral("stylus-enough"));
  // The same words in both places, and they add up.
  const QString poses = text("posesLabel");
  QVERIFY2(driver_->message().contains(poses), qPrintable(poses + QStringLiteral(" / ") + driver_->message()));
  const QRegularExpression words(
    QStringLiteral("(\\d+) used of (\\d+): (\\d+) hidden, (\\d+) disagree(?:, (\\d+) tell nothing new)?"));
  const QRegularExpressionMatch match = words.match(poses);
  QVERIFY2(match.hasMatch(), qPrintable(poses));
  QCOMPARE(match.captured(1).toInt() + match.captured(3).toInt() + match.captured(4).toInt() + match.captured(5).toInt(),
    match.captured(2).toInt());
  QCOMPARE(workbench().stylus()->document.at("usedFrames").get<int>(), match.captured(1).toInt());
  // As many directions as were promised, and the same number wherever it stands.
  QVERIFY(dome->filledCount() >= 12);
  QVERIFY(text("introLabel").contains(QStringLiteral("%1 of 17").arg(dome->filledCount())));
  QVERIFY2(dome->accessibleDescription().contains(QStringLiteral("not needed")), qPrintable(dome->accessibleDescription()));
}

void WizardStylusTest::spin_FindsTheShaft_StoresItAndIsNotNeeded()
{
  connectToRoom();
  QVERIFY(!driver_->onPage("spinButton")->isEnabled());
  pivot();
  QVERIFY2(text("shaftLabel").contains(QStringLiteral("not known")), qPrintable(text("shaftLabel")));
  driver_->click(driver_->onPage("spinButton"));
  QVERIFY(workbench().spin().isCollecting() && driver_->canGoNext());
  QTRY_VERIFY_WITH_TIMEOUT(driver_->onPage<QProgressBar>("spinProgress")->value() > 20, PatienceMs);
  photograph(QStringLiteral("stylus-spinning"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().stylus()->stylusTipToStylus.has_value(), PatienceMs);
  QVERIFY(!workbench().spin().isCollecting() && driver_->canGoNext());
  qInfo("%s", qPrintable(text("shaftLabel")));
  QVERIFY2(text("shaftLabel").contains(QRegularExpression(QStringLiteral("found to \\d+\\.\\d+ deg from \\d+ poses"))),
    qPrintable(text("shaftLabel")));
  photograph(QStringLiteral("stylus-spun"));
  const Eigen::Vector3d truth_Stylus = -workbench().devices().room()->tip_Stylus.normalized();
  const Eigen::Vector3d shaft_Stylus = -workbench().stylus()->stylusTipToStylus->linear().col(2);
  QVERIFY(std::acos(std::min(1.0, shaft_Stylus.dot(truth_Stylus))) < 0.5 / 57.2958);
  double logicsShaft[3] = {};
  QTRY_VERIFY_WITH_TIMEOUT(logic_->GetStylusShaft(logicsShaft), PatienceMs);
  QVERIFY(shaft_Stylus.isApprox(Eigen::Vector3d(logicsShaft), 1e-6));
  // It is in the file that exports read, and comes back with the session.
  const QString file = workbench().documentPath(QStringLiteral("stylus"));
  QTRY_VERIFY_WITH_TIMEOUT(handeye::readStylusTipFrame(file.toStdString()).has_value(), PatienceMs);
  const QString words = workbench().shaftWords();
  QSignalSpy opened(&workbench(), &HandEyeWorkbench::sessionOpened);
  workbench().openSession(workbench().sessionFolder());
  QTRY_VERIFY_WITH_TIMEOUT(!opened.isEmpty() && workbench().stylus().has_value(), PatienceMs);
  QCOMPARE(workbench().shaftWords(), words);
}

void WizardStylusTest::spin_Cancelled_LeavesTheStylusAsItWas()
{
  connectToRoom();
  pivot();
  const Eigen::Vector3d tip_Stylus = workbench().stylus()->tip_Stylus;
  driver_->click(driver_->onPage("spinButton"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().spin().state().poses > 20, PatienceMs);
  driver_->click(driver_->onPage("spinCancelButton"));
  QVERIFY(!workbench().spin().isCollecting());
  QTest::qWait(600);
  QVERIFY(!workbench().stylus()->stylusTipToStylus && workbench().stylus()->tip_Stylus == tip_Stylus);
  QVERIFY(driver_->onPage("spinButton")->isVisible() && driver_->canGoNext());
  QVERIFY2(text("shaftLabel").contains(QStringLiteral("not known")), qPrintable(text("shaftLabel")));
}

void WizardStylusTest::spin_OfAStylusThatLiesStill_IsRefusedInWords()
{
  FaultyServer server;
  driver_->check(driver_->onPage<QRadioButton>("serversButton"));
  driver_->onPage<QLineEdit>("serversEdit")->setText(QStringLiteral("127.0.0.1:%1").arg(server.port()));
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
  panel_->goTo(WizardStep::Stylus);
  workbench().takeStylusTip({ 0, 0, 150 }, QStringLiteral("a test"));
  driver_->click(driver_->onPage("spinButton"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().spin().state().poses > 30, PatienceMs);
  QVERIFY(!driver_->onPage("spinFinishButton")->isEnabled());
  QVERIFY2(text("shaftLabel").contains(QStringLiteral("different valid poses")), qPrintable(text("shaftLabel")));
  workbench().spin().finish();
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("different valid poses")), PatienceMs);
  QVERIFY(!workbench().stylus()->stylusTipToStylus);
}

/// Whether it is the same stylus, nobody knows.
void WizardStylusTest::pivot_Anew_ForgetsTheShaft()
{
  connectToRoom();
  pivot();
  driver_->click(driver_->onPage("spinButton"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().stylus()->stylusTipToStylus.has_value(), PatienceMs);
  driver_->click(driver_->onPage("startButton"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().pivot().isCollecting(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(!workbench().stylus()->stylusTipToStylus, PatienceMs);
  QVERIFY2(text("shaftLabel").contains(QStringLiteral("not known")), qPrintable(text("shaftLabel")));
}

HANDEYE_WIDGET_TEST_MAIN(WizardStylusTest)

#include "WizardStylusTest.moc"
