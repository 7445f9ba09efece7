// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatencyTask.h"
#include "WorkThread.h"

#include <QtTest>

#include <memory>

using handeye::LatencyTask;
using handeye::WorkThread;

namespace
{

handeye::CameraModel someCamera()
{
  Eigen::Matrix3d cameraMatrix = Eigen::Matrix3d::Identity();
  cameraMatrix(0, 0) = cameraMatrix(1, 1) = 600;
  cameraMatrix(0, 2) = 320;
  cameraMatrix(1, 2) = 240;
  return handeye::CameraModel(640, 480, cameraMatrix, {});
}

handeye::devices::PairedFrame frameAt(double timeSec)
{
  handeye::devices::PairedFrame frame;
  frame.image.timeSec = timeSec;
  return frame;
}

}  // namespace

/// The measurement of the latency ends in any case. What it measures is tested in TemporalCalibrationTest and WizardRunTest.
class LatencyTaskTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    work_ = std::make_unique<WorkThread>([](const char* message) { qWarning("%s", message); });
    task_ = std::make_unique<LatencyTask>(*work_);
    refusals_ = std::make_unique<QSignalSpy>(task_.get(), &LatencyTask::refused);
  }
  void cleanup()
  {
    work_.reset();
    task_.reset();
  }

  void noPicture_EndsWithTheReason()
  {
    task_->setLongestSilence(100);
    start(1);
    QVERIFY(task_->isRunning());
    QTRY_COMPARE(refusals_->count(), 1);
    QVERIFY(!task_->isRunning());
    QVERIFY2(refusal().contains("no picture has come"), qPrintable(refusal()));
  }

  void pictures_KeepItGoing_UntilTheyStop()
  {
    task_->setLongestSilence(400);
    start(1000);
    for (int i = 0; i < 8; ++i)
    {
      task_->onFrame(frameAt(i * 0.1), {});
      QTest::qWait(100);
      QVERIFY(task_->isRunning());
    }
    QTRY_COMPARE(refusals_->count(), 1);
    QVERIFY(!task_->isRunning());
  }

  void picturesWithoutABall_AreRefusedAtTheEnd()
  {
    start(1);
    for (int i = 0; i <= 11; ++i)
    {
      task_->onFrame(frameAt(i * 0.1), {});
    }
    QTRY_COMPARE(refusals_->count(), 1);
    QVERIFY(!refusal().isEmpty() && !refusal().contains("no picture"));
    QVERIFY(!task_->isRunning());
  }

  void result_IsSaidInPlainWords_WithUnitAndVerdict()
  {
    handeye::TemporalCalibrationResult result;
    result.latencySec = -0.0402;
    result.sigmaSec = 0.0006;
    const QString late = LatencyTask::words(result);
    QVERIFY2(late.contains(QStringLiteral("The video is 40.2\u00a0ms later")), qPrintable(late));
    QVERIFY2(late.contains(QStringLiteral("\u00b1\u00a00.6\u00a0ms")) && late.contains("Good: "), qPrintable(late));
    result.latencySec = 0.025;
    result.sigmaSec = 0.006;
    const QString early = LatencyTask::words(result);
    QVERIFY2(early.contains(QStringLiteral("The tracker is 25.0\u00a0ms later")), qPrintable(early));
    QVERIFY2(early.contains("Usable, but") && early.contains(QStringLiteral("1.2\u00a0mm")), qPrintable(early));
    result.latencySec = 0.0004;
    result.sigmaSec = 0.0005;
    const QString none = LatencyTask::words(result);
    QVERIFY2(none.startsWith("Video and tracker are in time"), qPrintable(none));
  }

  void differenceWithinTheNoise_IsNotCalledInTime_UnlessItDoesNotMatter()
  {
    handeye::TemporalCalibrationResult result;
    result.latencySec = -0.018;
    result.sigmaSec = 0.010;
    const QString hidden = LatencyTask::words(result);
    QVERIFY2(!hidden.contains("in time") && !hidden.contains("Good") && !hidden.contains("later"), qPrintable(hidden));
    QVERIFY2(hidden.contains(QStringLiteral("noise: 18.0\u00a0ms \u00b1\u00a010.0\u00a0ms.")), qPrintable(hidden));
    QVERIFY2(hidden.contains("measure again"), qPrintable(hidden));
    result.latencySec = 0.0014;  // 0.28 mm at a brisk motion
    QVERIFY2(LatencyTask::words(result).contains("in time"), qPrintable(LatencyTask::words(result)));
    result.latencySec = 0.0016;  // 0.32 mm
    QVERIFY2(!LatencyTask::words(result).contains("in time"), qPrintable(LatencyTask::words(result)));
  }

  void measuredAgain_IsNotDisturbedByTheNewsOfBefore()
  {
    task_->setLongestSilence(100);
    start(1);
    task_->onFrame(frameAt(0), {});
    task_->onFrame(frameAt(2), {});  // evaluated; its news wait in this thread's queue
    task_->cancel();
    start(1);
    QTRY_COMPARE(refusals_->count(), 1);
    QVERIFY2(refusal().contains("no picture has come"), qPrintable(refusal()));
    QVERIFY(!task_->isRunning());
  }

  void cancelled_SaysNothing()
  {
    task_->setLongestSilence(50);
    start(1);
    task_->onFrame(frameAt(0), {});
    task_->onFrame(frameAt(2), {});  // evaluated; the news of it waits in this thread's queue
    task_->cancel();
    QTest::qWait(150);
    QCOMPARE(refusals_->count(), 0);
    QVERIFY(!task_->isRunning());
  }

private:
  void start(double seconds)
  {
    task_->start(someCamera(), { 0, 0, 150 }, QStringLiteral("MarkerToTracker"), QStringLiteral("StylusToTracker"), seconds);
  }
  QString refusal() const { return refusals_->last().at(0).toString(); }

  std::unique_ptr<WorkThread> work_;
  std::unique_ptr<LatencyTask> task_;
  std::unique_ptr<QSignalSpy> refusals_;
};

QTEST_MAIN(LatencyTaskTest)
#include "LatencyTaskTest.moc"
