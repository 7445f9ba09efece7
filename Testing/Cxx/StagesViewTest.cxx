// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StagesView.h"

#include "BallStages.h"
#include "WidgetTestSupport.h"

#include <QSignalSpy>
#include <opencv2/core.hpp>

#include <cmath>

using namespace handeye;

namespace
{

void fill(StagesView& view)
{
  BallStages stages;
  stages.mask = cv::Mat(240, 320, CV_8UC1, cv::Scalar(50));
  stages.smoothed = cv::Mat(240, 320, CV_8UC1, cv::Scalar(100));
  stages.edges = cv::Mat(240, 320, CV_8UC3, cv::Scalar(0, 0, 0));
  stages.outline = cv::Mat(240, 320, CV_8UC3, cv::Scalar(200, 0, 0));
  view.setStages(cv::Mat(240, 320, CV_8UC3, cv::Scalar(0, 0, 180)), stages);
}

}  // namespace

class StagesViewTest : public QObject
{
  Q_OBJECT

private slots:
  void TheFourPictures_AreInOrder_InARowOrTwoByTwo()
  {
    StagesView view;
    fill(view);
    const QColor expected[] = { QColor(180, 0, 0), QColor(50, 50, 50), QColor(100, 100, 100), QColor(0, 0, 200) };
    for (const QSize& size : { QSize(800, 180), QSize(400, 340) })
    {
      testing_widgets::show(view, size);
      const QImage seen = view.grab().toImage();
      for (int index = 0; index < StagesView::Count; ++index)
      {
        const QRect place = view.pictureRectangle(index);
        QVERIFY(view.rect().contains(place));
        QVERIFY(std::abs(place.width() / double(place.height()) - 4.0 / 3) < 0.05);
        QCOMPARE(seen.pixelColor(place.center() * view.devicePixelRatioF()), expected[index]);
      }
      QCOMPARE(view.pictureRectangle(3).top() == view.pictureRectangle(0).top(), size.width() == 800);
    }
  }

  void Pictures_GrowWithTheWidth()
  {
    StagesView view;
    fill(view);
    testing_widgets::show(view, { 400, view.heightForWidth(400) });
    const int narrow = view.pictureRectangle(0).width();
    view.resize(600, view.heightForWidth(600));
    QVERIFY(view.pictureRectangle(0).width() > 1.4 * narrow);
    QVERIFY(view.heightForWidth(600) > view.heightForWidth(400));
  }

  void AClick_IsAPointOfTheImage()
  {
    StagesView view;
    fill(view);
    testing_widgets::show(view, { 800, 200 });
    QSignalSpy clicks(&view, &StagesView::imageClicked);
    const QRect place = view.pictureRectangle(2);
    QTest::mouseClick(&view, Qt::LeftButton, {}, place.topLeft() + QPoint(place.width() / 4, place.height() / 2));
    QCOMPARE(clicks.count(), 1);
    const QPointF point = clicks[0][0].toPointF();
    QVERIFY(std::abs(point.x() - 79.5) < 2.5 && std::abs(point.y() - 119.5) < 2.5);
    QTest::mouseClick(&view, Qt::LeftButton, {}, { place.right() + 4, place.center().y() });
    view.clear();
    QTest::mouseClick(&view, Qt::LeftButton, {}, place.center());
    QCOMPARE(clicks.count(), 1);
  }
};

HANDEYE_WIDGET_TEST_MAIN(StagesViewTest)
#include "StagesViewTest.moc"
