// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page Comparison, clicked through with the demo's captures and a rendered recording of a board.
#include "BoardPicture.h"
#include "BoardSimulation.h"
#include "CameraFile.h"
#include "CaptureSimulation.h"
#include "ComparisonPage.h"
#include "ComparisonTable.h"
#include "ErrorDistancePlot.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "WizardScreens.h"

#include <QComboBox>
#include <QDesktopServices>
#include <QFile>
#include <QFileInfo>
#include <QProgressBar>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTabWidget>
#include <QTemporaryDir>
#include <QUrl>
#include <vtkChartXY.h>

#include <fstream>
#include <memory>

using namespace handeye;

namespace
{

const char Board[] = "charuco:8x6:25:18:DICT_5X5_100";
const QString Demo = QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/");

io::CameraFile demoCamera()
{
  return io::readCameraFile((Demo + QStringLiteral("camera.yml")).toStdString());
}

Eigen::Isometry3d demoMarkerToCamera()
{
  std::ifstream file((Demo + QStringLiteral("truth.json")).toStdString());
  const nlohmann::json truth = nlohmann::json::parse(file);
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 12; ++i)
  {
    markerToCamera(i / 4, i % 4) = truth["markerToCamera"][std::size_t(i / 4)][std::size_t(i % 4)].get<double>();
  }
  return markerToCamera;
}

/// A further capture by the demo's camera: the demo's own are what is calibrated from and validated on.
void writeFurtherCapture(const QString& path, const CaptureInputs& inputs)
{
  test::SimulatedSession session(0);
  session.camera = demoCamera().camera;
  session.markerToCamera = demoMarkerToCamera();
  session.tip_Stylus = inputs.tip_Stylus;
  session.ballRadiusMm = inputs.ballRadiusMm;
  test::Random random(21);
  for (int i = 0; i < 8; ++i)
  {
    session.balls_Camera.push_back(test::randomPointInView(session.camera, { 200, 400, 0.2 }, random));
  }
  session.write(path.toStdString(), session.trackAll(4));
}

/// A board that stands still in front of the demo's camera, which moves; tracking with the noise of a good tracker.
/// @param isTurning false: the camera only moves sideways
void writeBoard(const QString& path, bool isTurning)
{
  const test::BoardScene scene{ parseBoard(Board), demoCamera().camera, demoMarkerToCamera() };
  const simulation::BoardPicture pictures(scene.board, scene.camera);
  test::BoardViews how;
  how.nearestMm = 280;
  how.furthestMm = 420;
  how.borderShare = 0.3;
  how.turnRad = 0.9;
  test::Random random(8);
  QDir().mkpath(path + QStringLiteral("/frames"));
  std::vector<io::SequenceFrame> frames;
  Eigen::Isometry3d boardToCamera = how.pose(scene.board, scene.camera, random);
  for (int i = 0; i < 10; ++i)
  {
    simulation::Photograph photograph;
    photograph.noise = 1.5;
    photograph.seed = unsigned(i);
    test::SimulatedSession::writePicture(path.toStdString(), i, pictures.take(boardToCamera, photograph));
    io::SequenceFrame frame;
    frame.timestampSec = 0.1 * i;
    const test::BoardNoise noise{ 0.0004, 0.12, 0 };
    frame.transforms["MarkerToTracker"] = { scene.view(i, boardToCamera, noise, random).markerToTracker.matrix(), "OK" };
    frames.push_back(frame);
    if (isTurning)
    {
      boardToCamera = how.pose(scene.board, scene.camera, random);
    }
    else
    {
      boardToCamera.translation() += Eigen::Vector3d(3, -2, 4);
    }
  }
  test::SimulatedSession::writeTracking((path + QStringLiteral("/tracking.igs.mha")).toStdString(), frames);
}

}  // namespace

class WizardComparisonTest : public QObject
{
  Q_OBJECT

private slots:
  void init();
  void cleanup();
  void withoutSamples_ItSaysWhereToGetThem_AndNextIsOpen();
  void methodsWithTheBall_AreComparedAndStored();
  void otherSamples_MakeItStale();
  void stop_KeepsTheResultOfBefore();
  void closingTheWindow_StopsIt();
  void failingMethods_AreRowsWithTheirReason();
  void wrongFiles_AreRefusedInWords();
  void report_IsWrittenAndOpened();
  void allMethods_NothingIsCutOff();
  void openedReport(const QUrl& url) { opened_ << url; }

private:
  void fill();
  void compare();
  ComparisonPage* page() const { return static_cast<ComparisonPage*>(panel_->page(WizardStep::Comparison)); }
  ComparisonTask& task() const { return panel_->workbench().comparison(); }
  int rowOf(const char* method) const;
  void takePicture(const QString& name);

  QTemporaryDir folder_;
  std::unique_ptr<HandEyeCalibrationPanel> panel_;
  std::unique_ptr<WizardDriver> driver_;
  QList<QUrl> opened_;
};

void WizardComparisonTest::init()
{
  panel_ = std::make_unique<HandEyeCalibrationPanel>(nullptr, nullptr);
  testing_widgets::show(*panel_, QSize(1280, 800));
  driver_ = std::make_unique<WizardDriver>(*panel_);
  opened_.clear();
}

void WizardComparisonTest::cleanup()
{
  driver_.reset();
  panel_.reset();
}

/// The demo's captures, calibrated and validated.
void WizardComparisonTest::fill()
{
  HandEyeWorkbench& workbench = panel_->workbench();
  QVERIFY(panel_->openFile(Demo + QStringLiteral("camera.yml")));
  panel_->goTo(WizardStep::Stylus);
  QVERIFY(panel_->openFile(Demo + QStringLiteral("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.stylus().has_value() && workbench.camera().has_value(), PatienceMs);
  panel_->goTo(WizardStep::Capture);
  QVERIFY(panel_->openFile(Demo + QStringLiteral("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(
    workbench.calibration() && workbench.calibration()->isUsable() && !workbench.capture().isBusy(), PatienceMs);
  panel_->goTo(WizardStep::Validation);
  QVERIFY(panel_->openFile(Demo + QStringLiteral("validation")));
  QTRY_VERIFY_WITH_TIMEOUT(
    workbench.validation() && workbench.validation()->projectionErrorPx.count >= 8 && !workbench.validationCapture().isBusy(),
    PatienceMs);
  panel_->goTo(WizardStep::Comparison);
}

void WizardComparisonTest::compare()
{
  QSignalSpy finished(&task(), &ComparisonTask::finished), refused(&task(), &ComparisonTask::refused);
  driver_->click(driver_->onPage("compareButton"));
  QVERIFY(task().isWorking());
  QTRY_VERIFY_WITH_TIMEOUT(finished.count() + refused.count() == 1, 2 * PatienceMs);
  QVERIFY2(finished.count() == 1, refused.isEmpty() ? "" : qPrintable(refused[0][0].toString()));
}

int WizardComparisonTest::rowOf(const char* method) const
{
  const auto* table = driver_->onPage<ComparisonTable>("table");
  for (int row = 0; row < table->rowCount(); ++row)
  {
    if (table->item(row, ComparisonTable::Name)->data(Qt::AccessibleTextRole).toString() == QLatin1String(method))
    {
      return row;
    }
  }
  return -1;
}

void WizardComparisonTest::withoutSamples_ItSaysWhereToGetThem_AndNextIsOpen()
{
  panel_->goTo(WizardStep::Comparison);
  QVERIFY2(driver_->missing().contains(QStringLiteral("page Camera")), qPrintable(driver_->missing()));
  QVERIFY(driver_->canGoNext());
  QVERIFY(!driver_->onPage("compareButton")->isEnabled());
  QVERIFY(driver_->onPage<QLabel>("introLabel")->text().contains(QStringLiteral("can be left out")));
  QVERIFY(panel_->openFile(Demo + QStringLiteral("camera.yml")));
  panel_->goTo(WizardStep::Stylus);
  QVERIFY(panel_->openFile(Demo + QStringLiteral("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(panel_->workbench().stylus().has_value(), PatienceMs);
  panel_->goTo(WizardStep::Comparison);
  QVERIFY2(driver_->missing().contains(QStringLiteral("page Capture")), qPrintable(driver_->missing()));
  panel_->goTo(WizardStep::Capture);
  QVERIFY(panel_->openFile(Demo + QStringLiteral("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(panel_->workbench().calibration() && !panel_->workbench().capture().isBusy(), PatienceMs);
  panel_->goTo(WizardStep::Comparison);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->missing().contains(QStringLiteral("page Validation")), PatienceMs);
  driver_->click(driver_->find("nextButton"));
  QCOMPARE(panel_->currentStep(), WizardStep::Overlay);
}

void WizardComparisonTest::methodsWithTheBall_AreComparedAndStored()
{
  fill();
  const QString further = folder_.filePath(QStringLiteral("further"));
  writeFurtherCapture(further, *panel_->workbench().capture().inputs());
  page()->addCapture(further);
  QVERIFY(driver_->onPage<QLabel>("captureLabel")->text().contains(QStringLiteral("further")));
  compare();
  const ComparisonResult& result = task().result()->result;
  const auto* table = driver_->onPage<ComparisonTable>("table");
  QCOMPARE(table->rowCount(), int(result.methods.size()));
  QVERIFY(rowOf("as-published") >= 0 && rowOf("ml") >= 0);
  const MethodResult& ml = result.methods.front();
  QCOMPARE(ml.captures.size(), std::size_t(2));
  QCOMPARE(table->item(rowOf("ml"), ComparisonTable::Mean)->text(), QLocale().toString(ml.errorPx.mean, 'f', 2));
  QCOMPARE(table->item(rowOf("ml"), ComparisonTable::Maximum)->text(), QLocale().toString(ml.errorPx.maximum, 'f', 2));
  QCOMPARE(driver_->onPage<QLabel>("verdictLabel")->text(), QString::fromStdString(result.message));
  QVERIFY(driver_->onPage<ErrorDistancePlot>("distancePlot")->chart()->GetNumberOfPlots() >= int(result.ranking.size()));
  QVERIFY(driver_->onPage<ErrorDistancePlot>("samplesPlot")->chart()->GetNumberOfPlots() >= 5);
  auto* repeatability = driver_->onPage<QTableWidget>("repeatabilityTable");
  QVERIFY(repeatability->rowCount() >= 8);
  QVERIFY(repeatability->item(0, 4)->text().endsWith(QStringLiteral("of 2")));
  QVERIFY(table->toText().contains(QStringLiteral("ml\t")));
  QFile stored(panel_->workbench().documentPath(QStringLiteral("comparison")));
  QTRY_VERIFY_WITH_TIMEOUT(stored.exists(), PatienceMs);
  QVERIFY(stored.open(QIODevice::ReadOnly));
  const nlohmann::json document = nlohmann::json::parse(stored.readAll().toStdString());
  QCOMPARE(QString::fromStdString(document.at("message").get<std::string>()), QString::fromStdString(result.message));
}

void WizardComparisonTest::otherSamples_MakeItStale()
{
  fill();
  compare();
  auto* stale = driver_->onPage<QLabel>("staleLabel");
  QVERIFY(!stale->isVisible());
  const int some = panel_->workbench().capture().samples().firstKey();
  panel_->workbench().capture().setExcluded({ some }, true);
  QTRY_VERIFY_WITH_TIMEOUT(stale->isVisible(), PatienceMs);
  panel_->workbench().capture().setExcluded({ some }, false);
  QTRY_VERIFY_WITH_TIMEOUT(!stale->isVisible(), PatienceMs);
}

void WizardComparisonTest::stop_KeepsTheResultOfBefore()
{
  fill();
  compare();
  const std::shared_ptr<const SessionComparison> before = task().result();
  QSignalSpy progressed(&task(), &ComparisonTask::progressed), finished(&task(), &ComparisonTask::finished);
  driver_->click(driver_->onPage("compareButton"));
  QTRY_VERIFY_WITH_TIMEOUT(progressed.count() > 1, PatienceMs);
  QVERIFY(driver_->onPage<QProgressBar>("progressBar")->isVisible());
  takePicture(QStringLiteral("wizard-comparison-working-1280x800"));
  driver_->click(driver_->onPage("stopButton"));
  QVERIFY(!driver_->onPage("stopButton")->isEnabled());
  QTRY_VERIFY_WITH_TIMEOUT(!task().isWorking(), PatienceMs);
  QCOMPARE(finished.count(), 0);
  QVERIFY(task().result() == before);
  QVERIFY(!driver_->onPage<QProgressBar>("progressBar")->isVisible());
  QVERIFY(driver_->onPage("compareButton")->isEnabled());
}

void WizardComparisonTest::closingTheWindow_StopsIt()
{
  fill();
  QSignalSpy progressed(&task(), &ComparisonTask::progressed);
  driver_->click(driver_->onPage("compareButton"));
  QTRY_VERIFY_WITH_TIMEOUT(progressed.count() > 1, PatienceMs);
  QElapsedTimer clock;
  clock.start();
  cleanup();
  QVERIFY2(clock.elapsed() < 20000, qPrintable(QString::number(clock.elapsed())));
}

void WizardComparisonTest::failingMethods_AreRowsWithTheirReason()
{
  fill();
  const QString board = folder_.filePath(QStringLiteral("sideways"));
  writeBoard(board, false);
  QVERIFY(panel_->openFile(board));
  QVERIFY(driver_->onPage<QLabel>("boardLabel")->text().contains(board));
  driver_->onPage<QSpinBox>("limitSpin")->setValue(2);
  compare();
  const auto* table = driver_->onPage<ComparisonTable>("table");
  for (const char* const method : { "tsai", "park", "horaud", "daniilidis", "branch-and-bound" })
  {
    const int row = rowOf(method);
    QVERIFY2(row > rowOf("ml"), method);
    const QString reason = table->item(row, ComparisonTable::Mean)->text();
    QVERIFY2(reason.startsWith(QStringLiteral("parallel motions: ")), qPrintable(reason));
    QCOMPARE(table->columnSpan(row, ComparisonTable::Mean), int(ComparisonTable::ColumnCount) - 1);
  }
  QVERIFY(driver_->onPage<QLabel>("verdictLabel")->text().contains(QStringLiteral("gave no calibration")));
  QTest::qWait(600);
  auto* bar = panel_->findChild<QScrollArea*>(QStringLiteral("scrollArea"))->verticalScrollBar();
  bar->setValue(bar->maximum() / 2);
  QTest::qWait(300);
  takePicture(QStringLiteral("wizard-comparison-failing-1280x800"));
}

void WizardComparisonTest::wrongFiles_AreRefusedInWords()
{
  fill();
  page()->chooseBoardRecording(QStringLiteral("/nowhere/board"));
  driver_->click(driver_->onPage("compareButton"));
  QTRY_VERIFY_WITH_TIMEOUT(!task().isWorking(), PatienceMs);
  QVERIFY2(driver_->message().contains(QStringLiteral("/nowhere/board")), qPrintable(driver_->message()));
  driver_->onPage<QComboBox>("boardCombo")->setEditText(QStringLiteral("chess"));
  QVERIFY(driver_->onPage<QLabel>("boardProblemLabel")->isVisible());
  QVERIFY(!driver_->onPage("compareButton")->isEnabled());
  driver_->click(driver_->onPage("noBoardButton"));
  QVERIFY(driver_->onPage("compareButton")->isEnabled());
  // What is validated on is no further capture.
  page()->addCapture(Demo + QStringLiteral("validation"));
  driver_->click(driver_->onPage("compareButton"));
  QTRY_VERIFY_WITH_TIMEOUT(!task().isWorking(), PatienceMs);
  QVERIFY2(driver_->message().contains(QStringLiteral("those of the validation set")), qPrintable(driver_->message()));
}

void WizardComparisonTest::report_IsWrittenAndOpened()
{
  QDesktopServices::setUrlHandler(QStringLiteral("file"), this, "openedReport");
  fill();
  QVERIFY(!driver_->onPage("reportButton")->isEnabled());
  compare();
  QSignalSpy written(&task(), &ComparisonTask::reportWritten), refused(&task(), &ComparisonTask::refused);
  StallMeter stalls;
  stalls.start();
  driver_->click(driver_->onPage("reportButton"));
  QTRY_VERIFY_WITH_TIMEOUT(written.count() + refused.count() == 1, PatienceMs);
  stalls.stop();
  qInfo(
    "longest stall while the report is written: %lld ms by the clock, %.0f ms of work", stalls.longestMs(), stalls.longestWorkMs());
  QVERIFY2(stalls.longestWorkMs() < 100, "the plots are painted beside the window");
  QVERIFY2(written.count() == 1, refused.isEmpty() ? "" : qPrintable(refused[0][0].toString()));
  const QString folder = panel_->workbench().comparisonFolder();
  for (const char* const name : { "report.html", "report.pdf", "methods.csv", "errors.csv", "subsets.csv", "repeatability.csv" })
  {
    QVERIFY2(QFileInfo(folder + QLatin1Char('/') + QLatin1String(name)).size() > 100, name);
  }
  QFile html(folder + QStringLiteral("/report.html"));
  QVERIFY(html.open(QIODevice::ReadOnly));
  QVERIFY(!html.readAll().contains("Not drawn"));
  QCOMPARE(opened_.size(), 1);
  QCOMPARE(opened_[0].toLocalFile(), folder + QStringLiteral("/report.html"));
  QVERIFY(driver_->onPage<QLabel>("reportLabel")->isVisible());
  QVERIFY(driver_->onPage<QLabel>("reportLabel")->text().contains(folder));
  QDesktopServices::unsetUrlHandler(QStringLiteral("file"));
  // The window's own charts are drawn as before.
  QTest::qWait(300);
  takePicture(QStringLiteral("wizard-comparison-reported-1280x800"));
  // The session remembers both when it is opened again.
  const QString verdict = driver_->onPage<QLabel>("verdictLabel")->text(), session = panel_->workbench().capture().folder();
  QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(panel_->workbench().documentPath(QStringLiteral("comparison"))), PatienceMs);
  panel_->workbench().openSession(session);
  QTRY_VERIFY_WITH_TIMEOUT(!panel_->workbench().storedComparison().isEmpty(), PatienceMs);
  QVERIFY(driver_->onPage<QLabel>("verdictLabel")->text().contains(verdict));
  QVERIFY(driver_->onPage<QLabel>("verdictLabel")->text().startsWith(QStringLiteral("Compared before")));
  QVERIFY(driver_->onPage<QLabel>("reportLabel")->isVisible());
  QVERIFY(!driver_->onPage("reportButton")->isEnabled());
}

void WizardComparisonTest::takePicture(const QString& name)
{
  const QPixmap picture = panel_->screen()->grabWindow(panel_->winId());
  const QString path = screenshotFolder() + QLatin1Char('/') + name + QStringLiteral(".png");
  QVERIFY2(picture.save(path), qPrintable(path));
}

void WizardComparisonTest::allMethods_NothingIsCutOff()
{
  fill();
  const QString board = folder_.filePath(QStringLiteral("board"));
  writeBoard(board, true);
  page()->chooseBoardRecording(board);
  driver_->onPage<QSpinBox>("limitSpin")->setValue(3);
  compare();
  for (const char* const method : { "ml", "as-published", "tsai", "park", "horaud", "daniilidis", "branch-and-bound" })
  {
    QVERIFY2(rowOf(method) >= 0, method);
  }
  auto* tabs = driver_->onPage<QTabWidget>("tabs");
  auto* area = panel_->findChild<QScrollArea*>(QStringLiteral("scrollArea"));
  QStringList faults;
  for (const QSize size : { QSize(1280, 800), QSize(2560, 1440) })
  {
    QApplication::setPalette(size.width() > 2000 ? testing_widgets::darkPalette() : testing_widgets::lightPalette());
    panel_->resize(size);
    for (int tab = 0; tab < tabs->count(); ++tab)
    {
      tabs->setCurrentIndex(tab);
      for (const bool atEnd : { false, true })
      {
        QTest::qWait(400);
        area->verticalScrollBar()->setValue(atEnd ? area->verticalScrollBar()->maximum() : 0);
        QTest::qWait(400);
        takePicture(QStringLiteral("wizard-comparison-%1%2-%3x%4")
                      .arg(tabs->tabText(tab))
                      .arg(atEnd ? 2 : 1)
                      .arg(size.width())
                      .arg(size.height()));
      }
      faults << faultsOf(*page());
    }
  }
  QApplication::setPalette(testing_widgets::lightPalette());
  QVERIFY2(page()->minimumSizeHint().width() <= 394, qPrintable(QString::number(page()->minimumSizeHint().width())));
  QVERIFY2(faults.isEmpty(), qPrintable(faults.join(QLatin1Char('\n'))));
}

HANDEYE_WIDGET_TEST_MAIN(WizardComparisonTest)

#include "WizardComparisonTest.moc"
