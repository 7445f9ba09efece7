// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LivePipeline.h"
#include "WorkThread.h"

#include <QElapsedTimer>
#include <QThread>
#include <QtTest>

#include <atomic>
#include <memory>

using handeye::LivePipeline;
using handeye::WorkThread;

namespace
{

handeye::devices::PairedFrame frameAt(double timeSec)
{
  handeye::devices::PairedFrame frame;
  frame.image.timeSec = timeSec;
  frame.image.content = handeye::devices::VideoFrame{ cv::Mat(48, 64, CV_8UC3, cv::Scalar(120, 121, 119)) };
  return frame;
}

}  // namespace

/// Frames on their way from the work's thread to the window.
class LivePipelineTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    work_ = std::make_unique<WorkThread>([](const char* message) { qWarning("%s", message); });
    pipeline_ = std::make_unique<LivePipeline>(*work_);
    seen_ = 0;
    pipeline_->addListener([this](const handeye::devices::PairedFrame&, const std::optional<handeye::BallDetection>&) { ++seen_; });
  }
  void cleanup()
  {
    work_.reset();
    pipeline_.reset();
  }

  /// Two frames within the 32 ms of one showing, and then nothing: the second is what is seen at the end.
  void lastFrame_IsShownThoughItCameTooSoon()
  {
    takeAndWait(1);
    QTRY_VERIFY(pipeline_->newest());
    takeAndWait(2);
    takeAndWait(3);
    QTRY_COMPARE(pipeline_->newest()->frame.image.timeSec, 3.0);
  }

  void framesThatComeTooFast_AreLeftOut()
  {
    QSignalSpy spy(pipeline_.get(), &LivePipeline::shown);
    QElapsedTimer clock;
    clock.start();
    double timeSec = 0;
    while (clock.elapsed() < 1000)
    {
      pipeline_->take(frameAt(++timeSec));
      QTest::qWait(3);
    }
    QTRY_COMPARE(pipeline_->newest()->frame.image.timeSec, timeSec);
    // 32 ms each, and one more for the first and for the last.
    QVERIFY2(spy.count() <= clock.elapsed() / 32 + 2, qPrintable(QString::number(spy.count())));
    QVERIFY(spy.count() > 5);
  }

  void clear_LeavesNoFrameOnItsWay()
  {
    takeAndWait(1);
    takeAndWait(2);
    pipeline_->clear();
    QTest::qWait(100);
    QVERIFY(!pipeline_->newest());
  }

private:
  void takeAndWait(double timeSec)
  {
    const int before = seen_;
    pipeline_->take(frameAt(timeSec));
    while (seen_ == before)
    {
      QThread::msleep(1);
    }
    std::atomic<bool> isDone{ false };
    work_->post([&isDone] { isDone = true; });  // behind the rest of what is done to the frame
    while (!isDone)
    {
      QThread::msleep(1);
    }
  }

  std::unique_ptr<WorkThread> work_;
  std::unique_ptr<LivePipeline> pipeline_;
  std::atomic<int> seen_{ 0 };
};

QTEST_MAIN(LivePipelineTest)
#include "LivePipelineTest.moc"
