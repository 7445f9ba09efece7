// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FaultyServer.h"
#include "LandmarkPanel.h"
#include "SampleTable.h"
#include "SequenceMetafileWriter.h"
#include "StreamList.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "WizardPage.h"
#include "WizardStepBar.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLineEdit>
#include <QProgressBar>
#include <QRadioButton>
#include <QTemporaryDir>
#include <QToolButton>
#include <QWheelEvent>

#include <fstream>
#include <memory>

using handeye::HandEyeWorkbench;
using handeye::WizardStep;

namespace
{

QString demo(const char* name)
{
  return QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/") + QString::fromLatin1(name);
}

/// A stylus that turns about one axis only: its tip is free along it.
void writeOneAxisPivot(const QString& path)
{
  handeye::io::SequenceMetafileWriterOptions options;
  options.transformsOnly = true;
  handeye::io::SequenceMetafileWriter writer(path.toStdString(), options);
  for (int i = 0; i < 200; ++i)
  {
    Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
    stylusToTracker.linear() = Eigen::AngleAxisd(0.6 * std::sin(0.05 * i), Eigen::Vector3d::UnitX()).toRotationMatrix();
    const Eigen::Vector3d tip_Tracker = stylusToTracker.linear() * Eigen::Vector3d(0, 0, 150);
    stylusToTracker.translation() = Eigen::Vector3d(10, 20, -900) - tip_Tracker;
    handeye::io::SequenceFrame frame;
    frame.timestampSec = i / 30.0;
    frame.transforms["StylusToTracker"] = { stylusToTracker.matrix(), "OK" };
    writer.append(frame);
  }
  writer.close();
}

}  // namespace

/// Every refusal stands on the screen in words, and Next stays closed.
class WizardRefusalsTest : public QObject
{
  Q_OBJECT

private slots:
  void init();
  void cleanup();

  void nothingConnected_SaysWhatToDo();
  void address_ThatIsNone();
  void server_ThatIsNotThere();
  void oneStream_ForTwoTools();
  void wheel_OverAChoice_ChangesNothing();
  void recording_ThatIsNotThere();
  void wrongFile_AsCamera();
  void wrongFile_AsStylus();
  void wrongFile_AsMesh();
  void pivot_AboutOneAxis();
  void pivot_FinishedAtOnce();
  void ball_ThatIsNotThere();
  void click_OnSomethingGrey();
  void tracker_ThatIsLost();
  void lensOfAnotherSize_IsSaidAsLongAsItIsUsed();
  void newSession_HasTheRoomsLensAgain();
  void latency_IsExplained_AndCanBeCancelled();
  void landmarks_StartedOver_KeepWhatWasAccepted();
  void capture_WithTooFewPlaces();
  void pages_SayWhatIsMissing();

private:
  HandEyeWorkbench& workbench() { return panel_->workbench(); }
  void connectTo(FaultyServer& server);
  void loadInputs();

  std::unique_ptr<HandEyeCalibrationPanel> panel_;
  std::unique_ptr<WizardDriver> driver_;
  QTemporaryDir folder_;
};

void WizardRefusalsTest::init()
{
  panel_ = std::make_unique<HandEyeCalibrationPanel>(nullptr, nullptr);
  driver_ = std::make_unique<WizardDriver>(*panel_);
  testing_widgets::show(*panel_, QSize(1280, 800));
}

void WizardRefusalsTest::cleanup()
{
  driver_.reset();
  panel_.reset();
}

void WizardRefusalsTest::connectTo(FaultyServer& server)
{
  panel_->goTo(WizardStep::Devices);
  driver_->check(driver_->onPage<QRadioButton>("serversButton"));
  driver_->onPage<QLineEdit>("serversEdit")->setText(QStringLiteral("127.0.0.1:%1").arg(server.port()));
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
}

void WizardRefusalsTest::loadInputs()
{
  QVERIFY(panel_->openFile(demo("camera.yml")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().camera().has_value(), PatienceMs);
  panel_->goTo(WizardStep::Stylus);
  QVERIFY(panel_->openFile(demo("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().stylus().has_value(), PatienceMs);
}

void WizardRefusalsTest::nothingConnected_SaysWhatToDo()
{
  QVERIFY(!driver_->canGoNext());
  QVERIFY2(driver_->reason().contains(QStringLiteral("press Connect")), qPrintable(driver_->reason()));
}

void WizardRefusalsTest::address_ThatIsNone()
{
  driver_->check(driver_->onPage<QRadioButton>("serversButton"));
  driver_->onPage<QLineEdit>("serversEdit")->setText(QStringLiteral("127.0.0.1:eighteen"));
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("'127.0.0.1:eighteen' is not HOST")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

void WizardRefusalsTest::server_ThatIsNotThere()
{
  driver_->check(driver_->onPage<QRadioButton>("serversButton"));
  driver_->onPage<QLineEdit>("serversEdit")->setText(QStringLiteral("127.0.0.1:1"));
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->reason().contains(QStringLiteral("127.0.0.1:1")), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->reason().contains(QStringLiteral("refused"), Qt::CaseInsensitive), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

void WizardRefusalsTest::oneStream_ForTwoTools()
{
  FaultyServer server;
  connectTo(server);
  handeye::DeviceSetup setup = workbench().devices().setup();
  const QString marker = std::exchange(setup.markerToTracker, setup.stylusToTracker);
  workbench().setStreamNames(setup);
  QTRY_VERIFY_WITH_TIMEOUT(!driver_->canGoNext(), PatienceMs);
  QVERIFY2(
    driver_->reason().contains(QStringLiteral("chosen for the stylus and for the camera's marker")), qPrintable(driver_->reason()));
  setup.markerToTracker.clear();
  workbench().setStreamNames(setup);
  QVERIFY2(driver_->reason().contains(QStringLiteral("Choose the stream of the camera's marker")), qPrintable(driver_->reason()));
  setup.markerToTracker = marker;
  workbench().setStreamNames(setup);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
}

/// Who scrolls down the page does not choose another stream in passing.
void WizardRefusalsTest::wheel_OverAChoice_ChangesNothing()
{
  FaultyServer server;
  connectTo(server);
  const auto turn = [](QWidget* widget)
  {
    const QPointF middle = widget->rect().center();
    QWheelEvent event(middle, widget->mapToGlobal(middle.toPoint()), QPoint(), QPoint(0, -120), Qt::NoButton, Qt::NoModifier,
      Qt::NoScrollPhase, false);
    QApplication::sendEvent(widget, &event);
  };
  auto* const box = driver_->onPage<handeye::StreamList>("streamList")->choiceBox(handeye::StreamList::Role::CameraMarker);
  const int chosen = box->currentIndex();
  QVERIFY(chosen >= 0 && chosen + 1 < box->count());
  panel_->setFocus();
  turn(box);
  QCOMPARE(box->currentIndex(), chosen);
  // With the focus it is meant.
  box->setFocus();
  turn(box);
  QCOMPARE(box->currentIndex(), chosen + 1);
}

void WizardRefusalsTest::recording_ThatIsNotThere()
{
  driver_->check(driver_->onPage<QRadioButton>("recordingButton"));
  driver_->onPage<QLineEdit>("recordingEdit")->setText(QStringLiteral("/nowhere/pivot.igs.mha"));
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(
    driver_->message().contains(QStringLiteral("There is no recording '/nowhere/pivot.igs.mha'")), PatienceMs);
}

void WizardRefusalsTest::wrongFile_AsCamera()
{
  const QString path = folder_.filePath(QStringLiteral("letter.yml"));
  std::ofstream(path.toStdString()) << "dear: surgeon\n";
  QVERIFY(panel_->openFile(path));
  QCOMPARE(panel_->currentStep(), WizardStep::Camera);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("letter.yml")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
  QVERIFY(!driver_->reason().isEmpty());
}

void WizardRefusalsTest::wrongFile_AsStylus()
{
  const QString path = folder_.filePath(QStringLiteral("stylus.json"));
  std::ofstream(path.toStdString()) << "{\"status\": \"too_few_poses\"}";
  panel_->goTo(WizardStep::Stylus);
  QVERIFY(panel_->openFile(path));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("stylus.json")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

void WizardRefusalsTest::wrongFile_AsMesh()
{
  const QString path = folder_.filePath(QStringLiteral("bone.stl"));
  std::ofstream(path.toStdString()) << "not a mesh";
  QVERIFY(panel_->openFile(path));
  QCOMPARE(panel_->currentStep(), WizardStep::Overlay);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("bone.stl")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

void WizardRefusalsTest::pivot_AboutOneAxis()
{
  const QString path = folder_.filePath(QStringLiteral("oneaxis.igs.mha"));
  writeOneAxisPivot(path);
  panel_->goTo(WizardStep::Stylus);
  QVERIFY(panel_->openFile(path));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("axis")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

void WizardRefusalsTest::pivot_FinishedAtOnce()
{
  FaultyServer server;
  connectTo(server);
  panel_->goTo(WizardStep::Stylus);
  driver_->click(driver_->onPage("startButton"));
  QVERIFY2(driver_->reason().contains(QStringLiteral("under way")), qPrintable(driver_->reason()));
  driver_->click(driver_->onPage("finishButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("pose")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

void WizardRefusalsTest::ball_ThatIsNotThere()
{
  FaultyServer server;
  connectTo(server);
  loadInputs();
  panel_->goTo(WizardStep::Ball);
  auto* found = driver_->onPage<QLabel>("foundLabel");
  QTRY_VERIFY_WITH_TIMEOUT(found->text().size() > 5, PatienceMs);
  QVERIFY2(driver_->reason().contains(QStringLiteral("has not been found")), qPrintable(driver_->reason()));
  QVERIFY(!driver_->canGoNext());
  QTRY_VERIFY_WITH_TIMEOUT(!panel_->videoView().banner().isEmpty(), PatienceMs);
  panel_->goTo(WizardStep::Capture);
  QTRY_VERIFY_WITH_TIMEOUT(workbench().live().newest() && workbench().live().newest()->ball, PatienceMs);
  driver_->click(driver_->onPage("takeButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("Not taken")), PatienceMs);
}

void WizardRefusalsTest::click_OnSomethingGrey()
{
  FaultyServer server;
  connectTo(server);
  loadInputs();
  panel_->goTo(WizardStep::Ball);
  QTRY_VERIFY_WITH_TIMEOUT(panel_->videoView().hasFrame(), PatienceMs);
  QTest::qWait(200);
  emit panel_->videoView().imageClicked(QPointF(320, 240));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("no colour to speak of")), PatienceMs);
  QVERIFY(!workbench().ball().isColorLearnt);
}

void WizardRefusalsTest::tracker_ThatIsLost()
{
  FaultyServer server;
  connectTo(server);
  loadInputs();
  server.setStylusSeen(false);
  panel_->goTo(WizardStep::Capture);
  auto* hint = driver_->onPage<QLabel>("hintLabel");
  QTRY_VERIFY_WITH_TIMEOUT(hint->text().contains(QStringLiteral("Stylus:")), PatienceMs);
  QTRY_COMPARE_WITH_TIMEOUT(
    workbench().devices().stream(QStringLiteral("StylusToTracker")).light, handeye::StreamList::Light::Stale, PatienceMs);
  driver_->click(driver_->onPage("takeButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("Not taken: stylus:")), PatienceMs);
  server.stop();
  panel_->goTo(WizardStep::Devices);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->reason().contains(QStringLiteral("The stylus does not arrive")), PatienceMs);
  QVERIFY(!driver_->canGoNext());
}

/// A sentence about the lens goes with the lens, with the video, and with the session.
void WizardRefusalsTest::lensOfAnotherSize_IsSaidAsLongAsItIsUsed()
{
  FaultyServer server;
  connectTo(server);
  loadInputs();
  const handeye::io::CameraFile right = workbench().camera()->file;
  const handeye::CameraModel& lens = right.camera;
  handeye::io::CameraFile wrong = right;
  wrong.camera = handeye::CameraModel(lens.width() / 2, lens.height() / 2, lens.cameraMatrix(), lens.distortionCoefficients());
  const auto isSaid = [](const QString& text)
  { return text.contains(QStringLiteral("px")) && text.contains(QStringLiteral("calibrat")); };
  panel_->goTo(WizardStep::Ball);
  auto* const found = driver_->onPage<QLabel>("foundLabel");
  workbench().setCamera(wrong, QStringLiteral("wrong.yml"));
  QTRY_VERIFY_WITH_TIMEOUT(isSaid(found->text()), PatienceMs);
  workbench().setCamera(right, QStringLiteral("right.yml"));
  QTRY_VERIFY_WITH_TIMEOUT(!isSaid(found->text()), PatienceMs);
  // The hint of hands-free capturing, and what was refused there.
  workbench().setCamera(wrong, QStringLiteral("wrong.yml"));
  panel_->goTo(WizardStep::Capture);
  driver_->click(driver_->onPage("takeButton"));
  QTRY_VERIFY_WITH_TIMEOUT(isSaid(driver_->message()), PatienceMs);
  workbench().setCamera(right, QStringLiteral("right.yml"));
  QTRY_VERIFY2_WITH_TIMEOUT(!isSaid(driver_->message()), qPrintable(driver_->message()), PatienceMs);
  workbench().setCamera(wrong, QStringLiteral("wrong.yml"));
  panel_->goTo(WizardStep::Ball);
  QTRY_VERIFY_WITH_TIMEOUT(isSaid(found->text()), PatienceMs);
  workbench().openSession(folder_.filePath(QStringLiteral("another")));
  QTRY_VERIFY2_WITH_TIMEOUT(!isSaid(found->text()), qPrintable(found->text()), PatienceMs);
}

void WizardRefusalsTest::newSession_HasTheRoomsLensAgain()
{
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().camera().has_value(), PatienceMs);
  const QString origin = workbench().camera()->origin;
  QSignalSpy opened(&workbench(), &HandEyeWorkbench::sessionOpened);
  workbench().openSession(folder_.filePath(QStringLiteral("new")));
  QTRY_VERIFY_WITH_TIMEOUT(!opened.isEmpty(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(workbench().camera().has_value(), PatienceMs);
  QCOMPARE(workbench().camera()->origin, origin);
  panel_->goTo(WizardStep::Camera);
  QVERIFY2(driver_->canGoNext(), qPrintable(driver_->reason()));
}

void WizardRefusalsTest::latency_IsExplained_AndCanBeCancelled()
{
  FaultyServer server;
  connectTo(server);
  loadInputs();
  panel_->goTo(WizardStep::Ball);
  auto *const measure = driver_->onPage("measureButton"), *const cancel = driver_->onPage("latencyCancelButton");
  const QString how = driver_->onPage<QLabel>("latencyHowLabel")->text();
  QVERIFY2(how.contains(QStringLiteral("to and fro")) && how.contains(QStringLiteral("6 s")), qPrintable(how));
  QVERIFY(!cancel->isVisible());
  QTRY_VERIFY_WITH_TIMEOUT(measure->isEnabled(), PatienceMs);
  driver_->click(measure);
  QTRY_VERIFY_WITH_TIMEOUT(cancel->isVisible() && !measure->isVisible(), PatienceMs);
  auto* const progress = driver_->onPage<QProgressBar>("latencyProgress");
  QTRY_VERIFY2_WITH_TIMEOUT(progress->text().contains(QStringLiteral("s left")), qPrintable(progress->text()), PatienceMs);
  driver_->click(cancel);
  QTRY_VERIFY_WITH_TIMEOUT(measure->isVisible() && !cancel->isVisible(), PatienceMs);
  QVERIFY(!workbench().latency().isRunning());
  QCOMPARE(workbench().devices().setup().latencySec, 0.0);
  const QString said = driver_->onPage<QLabel>("latencyLabel")->text();
  QVERIFY2(said.startsWith(QStringLiteral("Not measured")), qPrintable(said));
}

void WizardRefusalsTest::landmarks_StartedOver_KeepWhatWasAccepted()
{
  loadInputs();
  panel_->goTo(WizardStep::Capture);
  QVERIFY(panel_->openFile(demo("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().calibration() && workbench().calibration()->isUsable(), PatienceMs);
  panel_->goTo(WizardStep::Overlay);
  auto* const panel = panel_->page(WizardStep::Overlay)->findChild<handeye::LandmarkPanel*>();
  QTRY_VERIFY_WITH_TIMEOUT(panel->landmarks().size() >= 3 && workbench().model(), PatienceMs);
  while (panel->currentLandmark() >= 0)
  {
    panel->setTouched(panel->landmarks()[panel->currentLandmark()].point_Model + Eigen::Vector3d(5, 6, 7));
  }
  QTRY_VERIFY2_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("Registered")), qPrintable(driver_->message()), PatienceMs);
  const QString before = driver_->message();
  driver_->click(driver_->onPage("clearButton"));
  QTRY_VERIFY2_WITH_TIMEOUT(
    driver_->message().contains(QStringLiteral("registration of before stays")), qPrintable(driver_->message()), PatienceMs);
  QVERIFY(workbench().modelToPhantom().has_value());
  QTest::mouseClick(driver_->onPage<QToolButton>("undoButton"), Qt::LeftButton);
  QTRY_COMPARE_WITH_TIMEOUT(driver_->message(), before, PatienceMs);
}

void WizardRefusalsTest::capture_WithTooFewPlaces()
{
  loadInputs();
  panel_->goTo(WizardStep::Capture);
  QVERIFY(panel_->openFile(demo("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(!workbench().capture().isBusy() && workbench().capture().samples().size() > 10, PatienceMs);
  QVector<int> most = QVector<int>::fromList(workbench().capture().samples().keys());
  most.resize(most.size() - 3);
  emit panel_->page(WizardStep::Capture)->findChild<handeye::SampleTable*>()->excludeRequested(most, true);
  QTRY_VERIFY2_WITH_TIMEOUT(driver_->reason().contains(QStringLiteral("at least 6")), qPrintable(driver_->reason()), PatienceMs);
  QVERIFY(!driver_->canGoNext());
  panel_->goTo(WizardStep::Validation);
  QVERIFY2(driver_->missing().contains(QStringLiteral("page Capture")), qPrintable(driver_->missing()));
}

void WizardRefusalsTest::pages_SayWhatIsMissing()
{
  const std::pair<WizardStep, const char*> pages[] = { { WizardStep::Ball, "page Camera" }, { WizardStep::Capture, "page Camera" },
    { WizardStep::Validation, "page Camera" }, { WizardStep::Finish, "page Camera" } };
  for (const auto& [step, words] : pages)
  {
    const QByteArray name = "stepButton" + QByteArray::number(int(step) + 1);
    driver_->click(driver_->find<QToolButton>(name.constData()));
    QCOMPARE(panel_->currentStep(), step);
    QVERIFY2(driver_->missing().contains(QString::fromLatin1(words)), qPrintable(driver_->missing()));
    QVERIFY(!driver_->canGoNext());
  }
}

HANDEYE_WIDGET_TEST_MAIN(WizardRefusalsTest)

#include "WizardRefusalsTest.moc"
