// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoView.h"

#include "WidgetTestSupport.h"

#include <QSignalSpy>
#include <opencv2/core.hpp>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include <cmath>
#include <stdexcept>

using namespace handeye;

namespace
{

/// Dark, with one bright block of 8 x 8 px at this place.
cv::Mat frameWithBlock(int width, int height, int x, int y)
{
  cv::Mat frame(height, width, CV_8UC3, cv::Scalar(40, 40, 40));
  frame(cv::Rect(x, y, 8, 8)).setTo(cv::Scalar(0, 0, 255));
  return frame;
}

QWidget* glOf(VideoView& view)
{
  return view.findChild<QVTKOpenGLNativeWidget*>();
}

}  // namespace

class VideoViewTest : public QObject
{
  Q_OBJECT

private slots:
  void WithoutVideo_TheWordsAreShownAndClicksMeanNothing()
  {
    VideoView view;
    view.setPlaceholderText(QStringLiteral("No camera"));
    testing_widgets::show(view, { 400, 300 });
    QSignalSpy clicks(&view, &VideoView::imageClicked);
    QTest::mouseClick(glOf(view), Qt::LeftButton, {}, { 200, 150 });
    QCOMPARE(clicks.count(), 0);
    QVERIFY(!view.hasFrame());
    QVERIFY(!view.imageToWidget({ 1, 1 }).has_value());
    QCOMPARE(view.grab().toImage().pixelColor(3, 3), view.palette().color(QPalette::Window));
  }

  void TheBlockIsWhereTheMappingSays_AfterEachResize()
  {
    VideoView view;
    testing_widgets::show(view, { 640, 480 });
    view.setFrame(frameWithBlock(320, 240, 200, 60));
    for (const QSize& size : { QSize(640, 480), QSize(900, 300), QSize(333, 517), QSize(500, 500) })
    {
      view.resize(size);
      QTest::qWait(120);
      const std::optional<QPointF> center = view.imageToWidget({ 203.5, 63.5 });
      QVERIFY(center.has_value());
      const QImage seen = view.snapshot();
      const double ratio = view.devicePixelRatioF();
      QCOMPARE(seen.size(), size * ratio);
      const QColor inside = seen.pixelColor((*center * ratio).toPoint());
      QVERIFY2(inside.red() > 150 && inside.green() < 60, qPrintable(inside.name()));
      // The block's corners too: 8 px wide, from 199.5 to 207.5.
      const QPointF before = *view.imageToWidget({ 197.5, 63.5 }), after = *view.imageToWidget({ 209.5, 63.5 });
      QVERIFY(seen.pixelColor((before * ratio).toPoint()).red() < 90);
      QVERIFY(seen.pixelColor((after * ratio).toPoint()).red() < 90);
      // Letterboxed: both directions have one scale, and the picture's middle is the widget's.
      const QPointF first = *view.imageToWidget({ 0, 0 }), last = *view.imageToWidget({ 319, 239 });
      QVERIFY(std::abs((last.x() - first.x()) / 319 - (last.y() - first.y()) / 239) < 0.02);
      QVERIFY(std::abs((first.x() + last.x()) / 2 - size.width() / 2.0) < 1);
      QVERIFY(std::abs((first.y() + last.y()) / 2 - size.height() / 2.0) < 1);
    }
  }

  void AClick_IsAPointOfTheImage_BesideThePictureItIsNone()
  {
    VideoView view;
    testing_widgets::show(view, { 640, 300 });
    view.setFrame(frameWithBlock(320, 240, 10, 10));
    QTest::qWait(120);
    QSignalSpy clicks(&view, &VideoView::imageClicked);
    const QPoint place = view.imageToWidget({ 250, 120 })->toPoint();
    QTest::mouseClick(glOf(view), Qt::LeftButton, {}, place);
    QCOMPARE(clicks.count(), 1);
    const QPointF point = clicks[0][0].toPointF();
    QVERIFY(std::hypot(point.x() - 250, point.y() - 120) < 1.5);
    QTest::mouseClick(glOf(view), Qt::LeftButton, {}, { 5, 150 });  // the bar on the left
    QTest::mouseClick(glOf(view), Qt::RightButton, {}, place);
    QCOMPARE(clicks.count(), 1);
    QTest::mouseDClick(glOf(view), Qt::LeftButton, {}, place);
    QVERIFY(clicks.count() <= 2);
  }

  void RoundTrip_WidgetToImageToWidget()
  {
    VideoView view;
    testing_widgets::show(view, { 517, 401 });
    view.setFrame(frameWithBlock(640, 480, 10, 10));
    QTest::qWait(120);
    for (const QPointF& point : { QPointF(0, 0), QPointF(639, 479), QPointF(123.25, 77.5) })
    {
      const QPointF back = *view.widgetToImage(*view.imageToWidget(point));
      QVERIFY(std::hypot(back.x() - point.x(), back.y() - point.y()) < 1e-6);
    }
  }

  void Marks_AreDrawnWhereTheyAreGiven_AndMoveWithTheWindow()
  {
    VideoView view;
    testing_widgets::show(view, { 640, 480 });
    view.setFrame(frameWithBlock(320, 240, 300, 200));
    VideoView::DetectionMark mark;
    mark.ball_Image_Px = QPointF(80, 100);
    mark.outline_Image_Px = QPolygonF({ { 60, 80 }, { 100, 80 }, { 100, 120 }, { 60, 120 } });
    view.setDetection(mark);
    VideoView::GhostBall ghost;
    ghost.outline_Image_Px = QPolygonF({ { 200, 80 }, { 240, 80 }, { 240, 120 }, { 200, 120 } });
    view.setGhostBall(ghost);
    for (const QSize& size : { QSize(640, 480), QSize(420, 700) })
    {
      view.resize(size);
      QTest::qWait(120);
      const QImage seen = view.grab().toImage();
      const double ratio = view.devicePixelRatioF();
      const auto at = [&](const QPointF& point) { return seen.pixelColor((*view.imageToWidget(point) * ratio).toPoint()); };
      QVERIFY2(at({ 80, 100 }).green() > 180, qPrintable(at({ 80, 100 }).name()));  // the cross
      QVERIFY2(at({ 60, 105 }).green() > 120, qPrintable(at({ 60, 105 }).name()));  // the outline
      QVERIFY2(at({ 220, 100 }).blue() > at({ 150, 30 }).blue() + 20, "the ghost's inside is tinted");
    }
    view.setDetection({});
    view.setGhostBall({});
    QTest::qWait(60);
    const QImage seen = view.grab().toImage();
    QCOMPARE(seen.pixelColor((*view.imageToWidget({ 80, 100 }) * view.devicePixelRatioF()).toPoint()), QColor(40, 40, 40));
  }

  void TheBanner_IsShownReadAloudAndTakenAway()
  {
    VideoView view;
    testing_widgets::show(view, { 640, 480 });
    view.setFrame(frameWithBlock(640, 480, 0, 470));
    QTest::qWait(120);
    const QImage before = view.grab().toImage();
    view.setBanner(QStringLiteral("The stylus is not seen"), Level::Error);
    QTest::qWait(60);
    QVERIFY(view.grab().toImage() != before);
    QCOMPARE(glOf(view)->accessibleDescription(), QStringLiteral("The stylus is not seen"));
    view.setBanner({});
    QTest::qWait(60);
    QCOMPARE(view.grab().toImage(), before);
  }

  void Keys_AreForwarded_TabIsNot()
  {
    VideoView view;
    testing_widgets::show(view, { 320, 240 });
    QSignalSpy keys(&view, &VideoView::keyPressed);
    QTest::keyClick(glOf(view), Qt::Key_Space);
    QTest::keyClick(glOf(view), Qt::Key_E, Qt::ControlModifier);  // by itself VTK would end the program's loop on this letter
    QTest::keyClick(glOf(view), Qt::Key_Tab);
    QCOMPARE(keys.count(), 2);
    QCOMPARE(keys[0][0].toInt(), int(Qt::Key_Space));
    QCOMPARE(keys[1][1].value<Qt::KeyboardModifiers>(), Qt::KeyboardModifiers(Qt::ControlModifier));
  }

  void ManyRequests_RenderOnce()
  {
    VideoView view;
    testing_widgets::show(view, { 320, 240 });
    view.setFrame(frameWithBlock(320, 240, 10, 10));
    QTest::qWait(150);
    int rendered = 0;
    vtkNew<vtkCallbackCommand> count;
    count->SetClientData(&rendered);
    count->SetCallback([](vtkObject*, unsigned long, void* counter, void*) { ++*static_cast<int*>(counter); });
    view.renderWindow()->AddObserver(vtkCommand::EndEvent, count);
    for (int index = 0; index < 50; ++index)
    {
      view.setFrame(frameWithBlock(320, 240, 10 + index, 10));
    }
    QTest::qWait(150);
    view.renderWindow()->RemoveObserver(count);
    QVERIFY2(rendered >= 1 && rendered <= 3, qPrintable(QString::number(rendered)));
  }

  void FramesOfOtherSizesAndKinds()
  {
    VideoView view;
    testing_widgets::show(view, { 320, 240 });
    view.setFrame(cv::Mat(100, 200, CV_8UC1, cv::Scalar(90)));
    QTest::qWait(100);
    QCOMPARE(view.frameSize(), QSize(200, 100));
    QVERIFY(std::abs(view.imageToWidget({ 0, 0 })->y() - (240 - 160) / 2.0) < 2);
    QVERIFY_EXCEPTION_THROWN(view.setFrame(cv::Mat(10, 10, CV_32FC3)), std::invalid_argument);
    view.setFrame(cv::Mat());
    QVERIFY(!view.hasFrame());
  }
};

HANDEYE_WIDGET_TEST_MAIN(VideoViewTest)
#include "VideoViewTest.moc"
