// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkFiles.h"
#include "LandmarkPanel.h"
#include "OverlayRecordingTask.h"
#include "Recording.h"
#include "SequenceMetafile.h"
#include "StereoServer.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QFileInfo>
#include <QLabel>
#include <QRegularExpression>
#include <QScrollArea>
#include <QSignalSpy>
#include <QSlider>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>

using handeye::HandEyeWorkbench;
using handeye::WizardStep;

/// In a low window the looks are behind their button.
static void openLook(HandEyeCalibrationPanel& panel)
{
  auto* button = static_cast<QWidget*>(panel.page(WizardStep::Overlay))->findChild<QToolButton*>(QStringLiteral("lookButton"));
  if (!button->isChecked())
  {
    button->click();
  }
}

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
  void recording_IsInTheSession_WithItsTransforms();
  void recording_EndsWithThePage();
  void twoEyes_SeeEachTheirOwn();
  void closedWindow_LosesNothingOfAVideo();
  void anotherMesh_DoesNotTakeTheRegistrationOfTheOneBefore();

private:
  vtkHandEyeOverlayPipeline* pipeline() { return panel_->videoView().pipeline(); }
  void feed(bool isPhantomSeen);
  /// Frames until something holds: where drawing is slow, not every one is shown. @return whether it came to hold
  bool feedUntil(const std::function<bool()>& holds);
  QImage seen();
  /// A panel with a stereo rig's calibration and both its videos.
  std::unique_ptr<HandEyeCalibrationPanel> stereoPanel(StereoServer& server);

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
  openLook(*panel_);
  handeye::DeviceSetup setup;
  setup.kind = handeye::DeviceSetup::Kind::Recording;
  setup.recording = demo + QStringLiteral("calibration");
  QVERIFY(workbench.connectDevices(setup));
  QTRY_VERIFY_WITH_TIMEOUT(pipeline()->GetModelVisible() && pipeline()->GetNotice().empty(), PatienceMs);
  // From here on the test says what is seen.
  frame_ = workbench.live().newest()->frame;
  workbench.devices().disconnectDevices();
  QTest::qWait(500);
  const auto* said = panel_->page(WizardStep::Overlay)->findChild<QLabel*>(QStringLiteral("overlayLabel"));
  QVERIFY2(feedUntil([this] { return pipeline()->GetModelVisible() && pipeline()->GetFade() == 1; }), qPrintable(said->text()));
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

bool WizardOverlayTest::feedUntil(const std::function<bool()>& holds)
{
  for (int i = 0; i < 400; ++i)
  {
    if (holds())
    {
      return true;
    }
    feed(true);
  }
  return false;
}

QImage WizardOverlayTest::seen()
{
  feed(true);  // a picture that is older than 1.5 s has no model on it
  QTest::qWait(300);
  return panel_->videoView().snapshot();
}

namespace
{

/// The pose of every frame is a little different, and with it the shading of a few pixels.
bool isSame(const QImage& a, const QImage& b)
{
  int different = 0;
  for (int y = 0; y < a.height() && a.size() == b.size(); ++y)
  {
    for (int x = 0; x < a.width(); ++x)
    {
      const QColor one = a.pixelColor(x, y), other = b.pixelColor(x, y);
      const int most =
        std::max({ std::abs(one.red() - other.red()), std::abs(one.green() - other.green()), std::abs(one.blue() - other.blue()) });
      different += most > 6 ? 1 : 0;
    }
  }
  return a.size() == b.size() && different < 20;
}

}  // namespace

void WizardOverlayTest::look_ByKeyAndByControl()
{
  WizardDriver driver(*panel_);
  auto* outline = driver.onPage<QCheckBox>("outlineBox");
  auto* gl = panel_->videoView().findChild<QVTKOpenGLNativeWidget*>();
  const QImage plain = seen();
  QTest::keyClick(gl, Qt::Key_O);
  QVERIFY(outline->isChecked() && pipeline()->GetLook().outline);
  const QImage outlined = seen();
  QVERIFY(!isSame(outlined, plain));
  driver.check(outline);
  QVERIFY(!outline->isChecked() && !pipeline()->GetLook().outline);
  QTRY_VERIFY_WITH_TIMEOUT(isSame(seen(), plain), PatienceMs);  // where drawing is slow, not every frame is shown
  driver.check(driver.onPage<QCheckBox>("wireframeBox"));
  QVERIFY(pipeline()->GetLook().wireframe && !isSame(seen(), plain));
  QTest::keyClick(gl, Qt::Key_0);
  QVERIFY(!driver.onPage<QCheckBox>("wireframeBox")->isChecked());
  QTest::keyClick(gl, Qt::Key_U);
  QCOMPARE(driver.onPage<QComboBox>("lensBox")->currentIndex(), 1);
  QTest::keyClick(gl, Qt::Key_U);
  QTest::keyClick(gl, Qt::Key_Plus, Qt::ShiftModifier);
  QCOMPARE(driver.onPage<QSlider>("opacitySlider")->value(), 75);
  QVERIFY(!isSame(seen(), plain));
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

namespace
{

int framesOf(const QString& path, cv::Mat& last)
{
  cv::VideoCapture video(path.toStdString());
  int count = 0;
  for (cv::Mat frame; video.read(frame); ++count)
  {
    last = frame.clone();
  }
  return count;
}

/// How many pictures the page says that there are.
int picturesTold(const WizardDriver& driver)
{
  return QRegularExpression(QStringLiteral("([0-9]+) pictures")).match(driver.visibleText("recordLabel")).captured(1).toInt();
}

/// Whether a picture out of an encoder has what is shown over a video, where that is most different from it.
bool isInIt(const cv::Mat& encoded, const cv::Mat& shown, const cv::Mat& video)
{
  cv::Mat difference;
  cv::absdiff(shown, video, difference);
  cv::cvtColor(difference, difference, cv::COLOR_BGR2GRAY);
  const cv::Mat overlay = difference > 40;
  const double toShown = cv::norm(encoded, shown, cv::NORM_L1, overlay), toVideo = cv::norm(encoded, video, cv::NORM_L1, overlay);
  qInfo("%d pixels of the overlay: %.1f from what was shown, %.1f from the video", cv::countNonZero(overlay),
    toShown / cv::countNonZero(overlay), toVideo / cv::countNonZero(overlay));
  return cv::countNonZero(overlay) > 200 && 3 * toShown < toVideo;
}

QString metafileOf(QString path)
{
  return path.replace(QRegularExpression(QStringLiteral("\\.[a-z0-9]+$")), QStringLiteral(".igs.mha"));
}

}  // namespace

void WizardOverlayTest::recording_IsInTheSession_WithItsTransforms()
{
  WizardDriver driver(*panel_);
  for (const int format : { 0, 1 })
  {
    driver.onPage<QComboBox>("formatBox")->setCurrentIndex(format);
    driver.click(driver.onPage("recordButton"));
    QVERIFY(driver.visibleText("recordLabel").contains(QStringLiteral("Recording: 0:0")));
    QVERIFY(driver.onPage("recordButton")->text().contains(QStringLiteral("Stop")));
    QVERIFY(feedUntil(
      [&]
      {
        frame_.image.timeSec += 0.05;
        return picturesTold(driver) >= 5;
      }));
    cv::Mat shown;
    QVERIFY(panel_->videoView().readShown(shown));
    driver.click(driver.onPage("recordButton"));
    QTRY_VERIFY2_WITH_TIMEOUT(driver.visibleText("recordLabel").startsWith(QStringLiteral("Stored: videos/overlay-")),
      qPrintable(driver.visibleText("recordLabel")), PatienceMs);
    const QString path = driver.onPage<QLabel>("recordLabel")->toolTip();
    QVERIFY(path.startsWith(panel_->workbench().sessionFolder() + QStringLiteral("/videos/")));
    cv::Mat last;
    const int count = framesOf(path, last);
    QVERIFY2(count > 3, qPrintable(path));
    // The video's own pixels, not the window's; and what was seen: the model is in it.
    QCOMPARE(QSize(last.cols, last.rows), panel_->videoView().frameSize());
    QVERIFY(isInIt(last, shown, frame_.image.frame()->image));
    const auto metafile = handeye::io::SequenceMetafile::open(metafileOf(path).toStdString());
    QCOMPARE(metafile.frameCount(), count);
    QVERIFY(metafile.transform(0, "ModelToCamera").isUsable());
    QVERIFY(metafile.frame(count - 1).timestampSec > metafile.frame(0).timestampSec);
    const QStringList left = QDir(QFileInfo(path).path()).entryList({ QStringLiteral("*.part*") }, QDir::Files);
    QVERIFY2(left.isEmpty(), qPrintable(left.join(QLatin1Char(' '))));
  }
}

void WizardOverlayTest::recording_EndsWithThePage()
{
  WizardDriver driver(*panel_);
  driver.click(driver.onPage("recordButton"));
  for (int i = 0; i < 5; ++i)
  {
    frame_.image.timeSec += 0.05;
    feed(true);
  }
  panel_->goTo(WizardStep::Capture);
  panel_->goTo(WizardStep::Overlay);
  openLook(*panel_);
  QTRY_VERIFY_WITH_TIMEOUT(driver.visibleText("recordLabel").startsWith(QStringLiteral("Stored: videos/")), PatienceMs);
  QVERIFY(driver.onPage("recordButton")->text().contains(QStringLiteral("Record")));
}

std::unique_ptr<HandEyeCalibrationPanel> WizardOverlayTest::stereoPanel(StereoServer& server)
{
  auto panel = std::make_unique<HandEyeCalibrationPanel>(nullptr, nullptr);
  testing_widgets::show(*panel, QSize(1280, 800));
  printRefusals(*panel);
  HandEyeWorkbench& workbench = panel->workbench();
  // The right eye is 12 mm beside the left one.
  const QString demo = QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/");
  std::ifstream truthFile((demo + QStringLiteral("truth.json")).toStdString());
  const nlohmann::json truth = nlohmann::json::parse(truthFile);
  nlohmann::json right = truth.at("markerToCamera");
  right[0][3] = right[0][3].get<double>() - 12;
  const nlohmann::json camera = { { "width", 640 }, { "height", 480 },
    { "cameraMatrix", { { 600, 0, 320 }, { 0, 600, 240 }, { 0, 0, 1 } } }, { "distortionCoefficients", { -0.1, 0.01, 0, 0 } } };
  const QString path = QStringLiteral(HANDEYE_TEST_OUTPUT_DIR "/WizardOverlay.stereo.json");
  std::ofstream(path.toStdString()) << nlohmann::json{ { "status", "ok" }, { "markerToCamera", truth.at("markerToCamera") },
    { "markerToRightCamera", right }, { "camera", camera }, { "rightCamera", camera },
    { "tip_Stylus_Mm", truth.at("tip_Stylus_Mm") }, { "ballRadiusMm", truth.at("ballRadiusMm") } };
  workbench.loadCalibration(path);
  const auto landmarks = handeye::readLandmarkLists((demo + QStringLiteral("phantom_model_points.txt")).toStdString(),
    (demo + QStringLiteral("phantom_touched_points.txt")).toStdString());
  workbench.registerLandmarks(landmarks.points_Model, landmarks.points_Phantom);
  const auto recording = handeye::io::Recording::open((demo + QStringLiteral("calibration")).toStdString());
  server.setPoses(recording.transform(0, "MarkerToTracker").transform, recording.transform(0, "PhantomToTracker").transform);
  panel->goTo(WizardStep::Overlay);
  openLook(*panel);
  handeye::DeviceSetup setup;
  setup.kind = handeye::DeviceSetup::Kind::Servers;
  setup.servers = QStringList{ QStringLiteral("127.0.0.1:%1").arg(server.port()) };
  setup.image = QStringLiteral("LeftVideo");
  setup.rightImage = QStringLiteral("RightVideo");
  workbench.connectDevices(setup);
  return panel;
}

void WizardOverlayTest::twoEyes_SeeEachTheirOwn()
{
  StereoServer server;
  const auto panel = stereoPanel(server);
  WizardDriver driver(*panel);
  handeye::VideoView& view = panel->videoView();
  QTRY_VERIFY_WITH_TIMEOUT(view.pipeline()->GetModelVisible() && panel->workbench().live().newest()->right, PatienceMs);
  QVERIFY(!view.stereo());
  auto* eyes = driver.onPage<QComboBox>("eyesBox");
  const auto choose = [&](int row)
  {
    eyes->setCurrentIndex(row);
    emit eyes->activated(row);
  };
  choose(1);
  QTRY_VERIFY_WITH_TIMEOUT(view.stereo() && view.rightPipeline()->GetModelVisible(), PatienceMs);
  QVERIFY(driver.visibleText("eyesLabel").isEmpty());
  // Each half has its own video, and the model where its own eye sees it.
  cv::Mat shown;
  QTRY_VERIFY_WITH_TIMEOUT(
    view.readShown(shown) && shown.cols == 1280 && shown.rows == 480 && shown.at<cv::Vec3b>(3, 1276)[1] == StereoServer::RightGrey,
    PatienceMs);  // the layout is there before the right eye's picture
  QCOMPARE(int(shown.at<cv::Vec3b>(3, 3)[1]), StereoServer::LeftGrey);
  QCOMPARE(int(shown.at<cv::Vec3b>(3, 1276)[1]), StereoServer::RightGrey);
  const auto middleOf = [&](const cv::Rect& half, int grey)
  {
    cv::Mat different;
    cv::absdiff(shown(half), cv::Scalar::all(grey), different);
    std::vector<cv::Mat> channels;
    cv::split(different, channels);
    const cv::Moments moments = cv::moments((channels[0] | channels[1] | channels[2]) > 25, true);
    return cv::Point2d(moments.m10 / moments.m00, moments.m01 / moments.m00);
  };
  const cv::Point2d left = middleOf({ 0, 0, 640, 480 }, StereoServer::LeftGrey);
  const cv::Point2d right = middleOf({ 640, 0, 640, 480 }, StereoServer::RightGrey);
  QVERIFY2(left.x - right.x > 8 && left.x - right.x < 120, qPrintable(QString::number(left.x - right.x)));
  QVERIFY(std::abs(left.y - right.y) < 8);
  // Keys, as over a picture for one eye.
  auto* gl = view.findChild<QVTKOpenGLNativeWidget*>();
  QTest::keyClick(gl, Qt::Key_S);
  QCOMPARE(eyes->currentIndex(), 2);
  QTest::keyClick(gl, Qt::Key_E);
  QVERIFY(driver.onPage<QCheckBox>("swapBox")->isChecked());
  QTest::keyClick(gl, Qt::Key_O);
  QVERIFY(view.rightPipeline()->GetLook().outline);
  // Without the right eye's video there is one eye again, and why.
  server.setRightSent(false);
  QTRY_VERIFY_WITH_TIMEOUT(!view.stereo(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(driver.visibleText("eyesLabel").contains(QStringLiteral("RightVideo")), PatienceMs);
  panel->videoView().grab().save(QStringLiteral(HANDEYE_TEST_OUTPUT_DIR "/WizardOverlay.oneEye.png"));
}

void WizardOverlayTest::closedWindow_LosesNothingOfAVideo()
{
  StereoServer server;
  auto panel = stereoPanel(server);
  WizardDriver driver(*panel);
  QTRY_VERIFY_WITH_TIMEOUT(panel->videoView().pipeline()->GetModelVisible(), PatienceMs);
  driver.click(driver.onPage("recordButton"));
  QTRY_VERIFY_WITH_TIMEOUT(picturesTold(driver) >= 10, PatienceMs);
  const QString path = driver.onPage<QLabel>("recordLabel")->toolTip();
  const int told = picturesTold(driver);
  panel.reset();
  cv::Mat last;
  const int count = framesOf(path, last);
  QVERIFY2(count >= told, qPrintable(QStringLiteral("%1 of %2").arg(count).arg(told)));
  QCOMPARE(handeye::io::SequenceMetafile::open(metafileOf(path).toStdString()).frameCount(), count);
}

void WizardOverlayTest::anotherMesh_DoesNotTakeTheRegistrationOfTheOneBefore()
{
  HandEyeWorkbench& workbench = panel_->workbench();
  WizardDriver driver(*panel_);
  const QString first = workbench.modelPath();
  const QString other = QStringLiteral(HANDEYE_TEST_OUTPUT_DIR "/AnotherMesh.ply");
  QFile::remove(other);
  QVERIFY(QFile::copy(first, other));
  auto* const keep = driver.onPage("keepButton");
  QVERIFY(!keep->isVisible());
  workbench.loadModel(other);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.isRegisteredForAnotherModel(), PatienceMs);
  QVERIFY(feedUntil([&] { return driver.visibleText("overlayLabel").contains(QFileInfo(first).fileName()); }));
  QVERIFY(!pipeline()->GetModelVisible());
  QVERIFY(workbench.problemOf(WizardStep::Overlay).contains(QStringLiteral("this mesh")));
  QVERIFY(keep->isVisible());
  QVERIFY2(panel_->findChild<handeye::LandmarkPanel*>()->landmarks().isEmpty(), "those of the mesh before do not place this one");
  panel_->grab().save(QStringLiteral(HANDEYE_TEST_OUTPUT_DIR "/WizardOverlay.anotherMesh.png"));
  const auto* area = panel_->findChild<QScrollArea*>(QStringLiteral("scrollArea"));
  QVERIFY2(panel_->page(WizardStep::Overlay)->width() <= area->viewport()->width(), "cut off to the side");
  // It is still so when the session is opened again.
  const QString session = workbench.capture().folder();
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.capture().isBusy(), PatienceMs);
  workbench.openSession(session);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.isRegisteredForAnotherModel(), PatienceMs);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.calibration() && workbench.calibration()->isUsable(), PatienceMs);
  // The person says that both meshes lie in the same coordinates.
  driver.click(keep);
  QVERIFY(!workbench.isRegisteredForAnotherModel());
  QVERIFY(!keep->isVisible());
  QVERIFY(feedUntil([this] { return pipeline()->GetModelVisible(); }));
}

HANDEYE_WIDGET_TEST_MAIN(WizardOverlayTest)

#include "WizardOverlayTest.moc"
