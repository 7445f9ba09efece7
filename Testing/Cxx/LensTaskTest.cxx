// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensTask.h"

#include "BoardPicture.h"
#include "BoardSimulation.h"
#include "CameraFile.h"
#include "CameraPage.h"
#include "TestCameras.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "WorkThread.h"

#include <QComboBox>
#include <QDir>
#include <QFileInfo>
#include <QSignalSpy>
#include <QTemporaryDir>

#include <opencv2/imgcodecs.hpp>

#include <memory>

using namespace handeye;

namespace
{

const char Charuco[] = "charuco:9x6:24:18:DICT_5X5_50";

double focalErrorPercent(const CameraModel& found)
{
  const CameraModel truth = test::webcam();
  return 100 * std::max(std::abs(found.fx() / truth.fx() - 1), std::abs(found.fy() / truth.fy() - 1));
}

/// Rendered pictures of a board, and where it stands in each.
class Scene
{
public:
  explicit Scene(const char* board)
    : board_(parseBoard(board))
    , picture_(board_, test::webcam())
  {
    how_.nearestMm = 260;
    how_.furthestMm = 420;
    how_.tiltRad = 0.75;
    how_.turnRad = 0.6;
    how_.borderShare = 0.05;
  }
  Eigen::Isometry3d nextPose() { return how_.pose(board_, test::webcam(), random_); }
  cv::Mat take(const Eigen::Isometry3d& boardToCamera)
  {
    simulation::Photograph photograph;
    photograph.noise = 1.5;
    photograph.seed = ++seed_;
    return picture_.take(boardToCamera, photograph);
  }

  test::BoardViews how_;
  BoardDescription board_;

private:
  simulation::BoardPicture picture_;
  test::Random random_{ 4 };
  unsigned seed_ = 0;
};

devices::PairedFrame frameOf(const cv::Mat& image)
{
  devices::PairedFrame frame;
  frame.image.name = "Image_Reference";
  frame.image.content = devices::VideoFrame{ image };
  return frame;
}

}  // namespace

/// The lens from rendered boards: as the live video's frames, from a recording, and clicked through on the page Camera.
class LensTaskTest : public QObject
{
  Q_OBJECT

private slots:
  void live_FindsTheFocalLength();
  void recording_FindsTheFocalLength();
  void recording_CanBeCancelled();
  void wrongBoard_IsRefusedInWords();
  void parallelViews_AreRefusedInWords();
  void otherSize_StopsInWords();
  void page_CalibratesAndUsesTheLens();

private:
  /// One picture, as the live video brings it, until it was looked at.
  static void show(LensTask& task, const std::function<void()>& give);
};

void LensTaskTest::show(LensTask& task, const std::function<void()>& give)
{
  const int before = task.state().pictures;
  give();
  QTRY_VERIFY_WITH_TIMEOUT(task.state().pictures > before || !task.isCollecting(), PatienceMs);
}

void LensTaskTest::live_FindsTheFocalLength()
{
  WorkThread work([](const char* message) { qWarning("%s", message); });
  LensTask task(work);
  Scene scene(Charuco);
  QSignalSpy calibrated(&task, &LensTask::calibrated), refused(&task, &LensTask::refused);
  task.start(scene.board_);
  for (int place = 0; place < 40 && task.state().views < 18; ++place)
  {
    const Eigen::Isometry3d boardToCamera = scene.nextPose();
    const int before = task.state().views;
    for (int i = 0; i < 4 && task.state().views == before; ++i)
    {
      QVERIFY(i > 2 || task.state().views == before);  // nothing is taken before it stands still
      show(task, [&] { work.postNewest([&task, frame = frameOf(scene.take(boardToCamera))] { task.onFrame(frame); }); });
    }
  }
  QVERIFY(task.state().views >= 15);
  QVERIFY(task.state().coverageShare > 0.5);
  QVERIFY(!task.state().hint.isEmpty());
  task.calibrate();
  QVERIFY(task.isWorking() && !task.isCollecting());
  QTRY_VERIFY_WITH_TIMEOUT(calibrated.count() + refused.count() == 1, PatienceMs);
  QVERIFY2(calibrated.count() == 1, refused.isEmpty() ? "" : qPrintable(refused[0][0].toString()));
  const LensCalibrationResult& result = task.result()->calibration;
  qInfo("focal length off by %.4f %%, %.3f px RMS, %d views", focalErrorPercent(*result.camera), result.rmsPx, result.usedCount);
  QVERIFY(focalErrorPercent(*result.camera) < 0.15);
  QVERIFY(result.rmsPx < 0.2);
}

void LensTaskTest::recording_FindsTheFocalLength()
{
  QTemporaryDir folder;
  QVERIFY(QDir(folder.path()).mkdir(QStringLiteral("frames")));
  Scene scene(Charuco);
  for (int i = 0; i < 24; ++i)
  {
    const QString name = folder.filePath(QStringLiteral("frames/%1.png").arg(i, 4, 10, QLatin1Char('0')));
    QVERIFY(cv::imwrite(name.toStdString(), scene.take(scene.nextPose())));
  }
  WorkThread work([](const char* message) { qWarning("%s", message); });
  LensTask task(work);
  QSignalSpy calibrated(&task, &LensTask::calibrated), refused(&task, &LensTask::refused), worked(&task, &LensTask::worked);
  task.calibrateRecording(folder.path(), scene.board_);
  QTRY_VERIFY_WITH_TIMEOUT(calibrated.count() + refused.count() == 1, PatienceMs);
  QVERIFY2(calibrated.count() == 1, refused.isEmpty() ? "" : qPrintable(refused[0][0].toString()));
  QCOMPARE(worked.count(), 24);
  qInfo("focal length off by %.4f %%", focalErrorPercent(*task.result()->calibration.camera));
  QVERIFY(focalErrorPercent(*task.result()->calibration.camera) < 0.15);

  task.calibrateRecording(folder.filePath(QStringLiteral("nowhere")), scene.board_);
  QTRY_VERIFY_WITH_TIMEOUT(refused.count() == 1, PatienceMs);
  QVERIFY2(refused[0][0].toString().contains(QStringLiteral("nowhere")), qPrintable(refused[0][0].toString()));
}

void LensTaskTest::recording_CanBeCancelled()
{
  QTemporaryDir folder;
  QVERIFY(QDir(folder.path()).mkdir(QStringLiteral("frames")));
  Scene scene(Charuco);
  const cv::Mat image = scene.take(scene.nextPose());
  for (int i = 0; i < 200; ++i)
  {
    const QString name = folder.filePath(QStringLiteral("frames/%1.png").arg(i, 4, 10, QLatin1Char('0')));
    QVERIFY(cv::imwrite(name.toStdString(), image));
  }
  WorkThread work([](const char* message) { qWarning("%s", message); });
  LensTask task(work);
  QSignalSpy calibrated(&task, &LensTask::calibrated), refused(&task, &LensTask::refused), worked(&task, &LensTask::worked);
  QObject::connect(&task, &LensTask::worked, &task, &LensTask::cancel);
  task.calibrateRecording(folder.path(), scene.board_);
  QTRY_VERIFY_WITH_TIMEOUT(!task.isWorking(), PatienceMs);
  QVERIFY(worked.count() < 200);
  QCOMPARE(calibrated.count() + refused.count(), 0);
  QVERIFY(!task.result());
}

void LensTaskTest::wrongBoard_IsRefusedInWords()
{
  WorkThread work([](const char* message) { qWarning("%s", message); });
  LensTask task(work);
  Scene scene("chessboard:7x5:25");
  QSignalSpy refused(&task, &LensTask::refused);
  task.calibrate();
  QCOMPARE(refused.count(), 1);
  QVERIFY(refused[0][0].toString().contains(QStringLiteral("No views")));
  task.start(parseBoard(Charuco));
  for (int i = 0; i < 4; ++i)
  {
    show(task, [&] { work.postNewest([&task, frame = frameOf(scene.take(scene.nextPose()))] { task.onFrame(frame); }); });
    QVERIFY(!task.state().seen.isEmpty());
  }
  QCOMPARE(task.state().views, 0);
  task.calibrate();
  QTRY_VERIFY_WITH_TIMEOUT(refused.count() == 2, PatienceMs);
  const QString message = refused[1][0].toString();
  QVERIFY2(
    message.contains(QStringLiteral("None of 4 pictures shows the board charuco:9x6:24:18:DICT_5X5_50")), qPrintable(message));
}

void LensTaskTest::parallelViews_AreRefusedInWords()
{
  WorkThread work([](const char* message) { qWarning("%s", message); });
  LensTask task(work);
  Scene scene(Charuco);
  scene.how_.tiltRad = 0;
  scene.how_.turnRad = 0.1;
  QSignalSpy calibrated(&task, &LensTask::calibrated), refused(&task, &LensTask::refused);
  task.start(scene.board_);
  for (int place = 0; place < 30 && task.state().views < 8; ++place)
  {
    const Eigen::Isometry3d boardToCamera = scene.nextPose();
    for (int i = 0; i < 3; ++i)
    {
      show(task, [&] { work.postNewest([&task, frame = frameOf(scene.take(boardToCamera))] { task.onFrame(frame); }); });
    }
  }
  QCOMPARE(task.state().views, 8);
  task.calibrate();
  QTRY_VERIFY_WITH_TIMEOUT(calibrated.count() + refused.count() == 1, PatienceMs);
  QCOMPARE(calibrated.count(), 0);
  QCOMPARE(toString(task.result()->calibration.status), std::string("parallel_views"));
  QVERIFY2(refused[0][0].toString().contains(QStringLiteral("Next: ")), qPrintable(refused[0][0].toString()));
}

void LensTaskTest::otherSize_StopsInWords()
{
  WorkThread work([](const char* message) { qWarning("%s", message); });
  LensTask task(work);
  Scene scene(Charuco);
  QSignalSpy refused(&task, &LensTask::refused);
  task.start(scene.board_);
  const cv::Mat image = scene.take(scene.nextPose());
  show(task, [&] { work.postNewest([&task, frame = frameOf(image)] { task.onFrame(frame); }); });
  show(task, [&] { work.postNewest([&task, frame = frameOf(image.rowRange(0, 400))] { task.onFrame(frame); }); });
  QTRY_COMPARE_WITH_TIMEOUT(refused.count(), 1, PatienceMs);
  QVERIFY(refused[0][0].toString().contains(QStringLiteral("from 640 x 480 to 640 x 400 px")));
  QVERIFY(!task.isCollecting());
}

void LensTaskTest::page_CalibratesAndUsesTheLens()
{
  QTemporaryDir folder;
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  printRefusals(panel);
  WizardDriver driver(panel);
  HandEyeWorkbench& workbench = panel.workbench();
  testing_widgets::show(panel, QSize(400, 1000));
  workbench.openSession(folder.filePath(QStringLiteral("session")));
  QTRY_VERIFY_WITH_TIMEOUT(!workbench.sessionFolder().isEmpty(), PatienceMs);
  panel.goTo(WizardStep::Camera);
  LensTask& task = workbench.lens();
  QComboBox* combo = driver.onPage<QComboBox>("boardCombo");
  combo->setEditText(QStringLiteral("charuco:9x6:24"));
  QVERIFY(!driver.onPage<QLabel>("boardProblemLabel")->text().startsWith(QStringLiteral("ChArUco: ")));
  combo->setEditText(QString::fromLatin1(Charuco));
  const QString board = driver.onPage<QLabel>("boardProblemLabel")->text();
  QVERIFY2(board.startsWith(QStringLiteral("ChArUco: ")) && board.endsWith(QStringLiteral(" mm")), qPrintable(board));
  QVERIFY(!driver.onPage("startButton")->isEnabled());  // no device is connected
  QVERIFY(!driver.onPage("useButton")->isVisible());

  Scene scene(Charuco);
  task.start(scene.board_);
  QVERIFY(task.isCollecting());
  for (int place = 0; place < 40 && task.state().views < 18 && !QTest::currentTestFailed(); ++place)
  {
    const Eigen::Isometry3d boardToCamera = scene.nextPose();
    for (int i = 0; i < 3; ++i)
    {
      show(task, [&] { workbench.live().take(frameOf(scene.take(boardToCamera))); });
    }
  }
  QVERIFY(driver.onPage<QLabel>("countLabel")->text().contains(QStringLiteral("18 views")));
  driver.click(driver.onPage("calibrateButton"));
  QTRY_VERIFY_WITH_TIMEOUT(task.result() && !task.isWorking(), PatienceMs);
  QVERIFY2(task.result()->calibration.isUsable(), task.result()->calibration.message.c_str());
  QVERIFY(driver.onPage<QLabel>("resultLabel")->text().contains(QStringLiteral("px RMS")));
  QTest::qWait(100);
  QDir().mkpath(QStringLiteral(HANDEYE_SCREENSHOT_DIR));
  QVERIFY(panel.grab().save(QStringLiteral(HANDEYE_SCREENSHOT_DIR "/wizard-camera-lens.png")));
  QVERIFY(static_cast<QWidget*>(panel.page(WizardStep::Camera))
            ->grab()
            .save(QStringLiteral(HANDEYE_SCREENSHOT_DIR "/wizard-camera-lens-page.png")));

  QVERIFY(!workbench.camera());
  driver.onPage("useButton")->click();
  QVERIFY(workbench.camera().has_value());
  QVERIFY(focalErrorPercent(workbench.camera()->file.camera) < 0.15);
  QVERIFY(driver.canGoNext() || workbench.problemOf(WizardStep::Camera).isEmpty());
  const QString file = workbench.sessionFolder() + QStringLiteral("/camera.yml");
  QTRY_VERIFY_WITH_TIMEOUT(QFileInfo::exists(file), PatienceMs);
  const CameraModel read = io::readCameraFile(file.toStdString()).camera;
  QCOMPARE(read.width(), 640);
  QVERIFY(std::abs(read.fx() - workbench.camera()->file.camera.fx()) < 1e-6);
}

HANDEYE_WIDGET_TEST_MAIN(LensTaskTest)
#include "LensTaskTest.moc"
