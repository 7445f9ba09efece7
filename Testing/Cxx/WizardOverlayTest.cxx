// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkFiles.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFileInfo>
#include <QSignalSpy>
#include <QSlider>

#include <memory>

using handeye::HandEyeWorkbench;
using handeye::WizardStep;

/// The page Overlay with the demo's capture: its recording is the live video.
class WizardOverlayTest : public QObject
{
  Q_OBJECT

private slots:
  void initTestCase();
  void cleanupTestCase() { panel_.reset(); }

  void look_ByKeyAndByControl();
  void snapshot_IsInTheSession();
  void hiddenPhantom_IsNamed_AndTheModelGoes();

private:
  vtkHandEyeOverlayPipeline* pipeline() { return panel_->videoView().pipeline(); }
  void feed(bool isPhantomSeen);
  QImage seen();

  std::unique_ptr<HandEyeCalibrationPanel> panel_;
  handeye::devices::PairedFrame frame_;  ///< the last of the recording
};

void WizardOverlayTest::initTestCase()
{
  panel_ = std::make_unique<HandEyeCalibrationPanel>(nullptr, nullptr);
  testing_widgets::show(*panel_, QSize(1280, 800));
  const QString demo = QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/");
  HandEyeWorkbench& workbench = panel_->workbench();
  QVERIFY(panel_->openFile(demo + QStringLiteral("camera.yml")));
  panel_->goTo(WizardStep::Stylus);
  QVERIFY(panel_->openFile(demo + QStringLiteral("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.stylus().has_value() && workbench.camera().has_value(), PatienceMs);
  panel_->goTo(WizardStep::Capture);
  QVERIFY(panel_->openFile(demo + QStringLiteral("calibration")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.calibration() && workbench.calibration()->isUsable(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.capture().isBusy(), PatienceMs);
  const auto landmarks = handeye::readLandmarkLists((demo + QStringLiteral("phantom_model_points.txt")).toStdString(),
    (demo + QStringLiteral("phantom_touched_points.txt")).toStdString());
  workbench.registerLandmarks(landmarks.points_Model, landmarks.points_Phantom);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.modelToPhantom().has_value(), PatienceMs);
  panel_->goTo(WizardStep::Overlay);
  handeye::DeviceSetup setup;
  setup.kind = handeye::DeviceSetup::Kind::Recording;
  setup.recording = demo + QStringLiteral("calibration");
  QVERIFY(workbench.connectDevices(setup));
  QTRY_VERIFY_WITH_TIMEOUT(pipeline()->GetModelVisible() && pipeline()->GetNotice().empty(), PatienceMs);
  // From here on the test says what is seen.
  frame_ = workbench.live().newest()->frame;
  workbench.devices().disconnectDevices();
  QTest::qWait(500);
  feed(true);
  QTRY_VERIFY_WITH_TIMEOUT(pipeline()->GetModelVisible() && pipeline()->GetFade() == 1, PatienceMs);
}

/// The same frame 50 ms later.
void WizardOverlayTest::feed(bool isPhantomSeen)
{
  frame_.poseTimeSec += 0.05;
  for (const char* name : { "MarkerToTracker", "PhantomToTracker" })
  {
    handeye::PoseAtTime& pose = frame_.poses[name];
    const bool isSeen = isPhantomSeen || name != std::string("PhantomToTracker");
    pose.status = isSeen ? handeye::PoseAtTime::Status::Ok : handeye::PoseAtTime::Status::Invalid;
    pose.transform.translation().x() += 1e-6;  // never the same bits: a tracker's noise
  }
  panel_->workbench().live().take(frame_);
  QTest::qWait(60);
}

QImage WizardOverlayTest::seen()
{
  QTest::qWait(300);
  return panel_->videoView().snapshot();
}

void WizardOverlayTest::look_ByKeyAndByControl()
{
  WizardDriver driver(*panel_);
  auto* outline = driver.onPage<QCheckBox>("outlineBox");
  auto* gl = panel_->videoView().findChild<QVTKOpenGLNativeWidget*>();
  const QImage plain = seen();
  QTest::keyClick(gl, Qt::Key_O);
  QVERIFY(outline->isChecked() && pipeline()->GetLook().outline);
  const QImage outlined = seen();
  QVERIFY(outlined != plain);
  driver.check(outline);
  QVERIFY(!outline->isChecked() && !pipeline()->GetLook().outline);
  QVERIFY(seen() == plain);
  driver.check(driver.onPage<QCheckBox>("wireframeBox"));
  QVERIFY(pipeline()->GetLook().wireframe && seen() != plain);
  QTest::keyClick(gl, Qt::Key_0);
  QVERIFY(!driver.onPage<QCheckBox>("wireframeBox")->isChecked());
  QTest::keyClick(gl, Qt::Key_U);
  QCOMPARE(driver.onPage<QComboBox>("lensBox")->currentIndex(), 1);
  QTest::keyClick(gl, Qt::Key_U);
  QTest::keyClick(gl, Qt::Key_Plus, Qt::ShiftModifier);
  QCOMPARE(driver.onPage<QSlider>("opacitySlider")->value(), 75);
  QVERIFY(seen() != plain);
}

void WizardOverlayTest::snapshot_IsInTheSession()
{
  WizardDriver driver(*panel_);
  QSignalSpy saved(&panel_->workbench(), &HandEyeWorkbench::snapshotSaved);
  driver.click(driver.onPage("snapshotButton"));
  QTRY_COMPARE_WITH_TIMEOUT(saved.count(), 1, PatienceMs);
  const QString path = saved[0][0].toString();
  QVERIFY(path.startsWith(panel_->workbench().sessionFolder()));
  QCOMPARE(QImage(path).size(), panel_->videoView().snapshot().size());
  QVERIFY(driver.visibleText("snapshotLabel").contains(QFileInfo(path).fileName()));
}

void WizardOverlayTest::hiddenPhantom_IsNamed_AndTheModelGoes()
{
  WizardDriver driver(*panel_);
  feed(true);
  for (int i = 0; i < 8; ++i)
  {
    feed(false);
  }
  QTRY_VERIFY_WITH_TIMEOUT(pipeline()->GetNotice().find("phantom is not seen") != std::string::npos, PatienceMs);
  QVERIFY(pipeline()->GetFade() < 1);
  QVERIFY(driver.visibleText("overlayLabel").contains(QStringLiteral("phantom is not seen")));
  for (int i = 0; i < 10; ++i)
  {
    feed(false);
  }
  QTRY_VERIFY_WITH_TIMEOUT(!pipeline()->GetModelVisible(), PatienceMs);
  feed(true);
  feed(true);
  QTRY_VERIFY_WITH_TIMEOUT(pipeline()->GetModelVisible() && pipeline()->GetNotice().empty(), PatienceMs);
}

HANDEYE_WIDGET_TEST_MAIN(WizardOverlayTest)

#include "WizardOverlayTest.moc"
