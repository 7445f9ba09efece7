// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoverageView.h"

#include "WidgetTestSupport.h"

#include <QHelpEvent>
#include <QToolTip>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace handeye;
using Field = CoverageView::Field;
using Place = CoverageView::Place;

class CoverageViewTest : public QObject
{
  Q_OBJECT

private slots:
  void PlacesCountInTheirField_AlsoAtTheBorders()
  {
    CoverageView view;
    view.setImageSize({ 640, 480 });
    view.setWorkingRange(150, 450);
    QCOMPARE(view.fieldOf({ { -0.5, -0.5 }, 150 }), (Field{ 0, 0, 0 }));
    QCOMPARE(view.fieldOf({ { 159.4, 119.4 }, 249 }), (Field{ 0, 0, 0 }));
    QCOMPARE(view.fieldOf({ { 159.6, 119.6 }, 251 }), (Field{ 1, 1, 1 }));
    QCOMPARE(view.fieldOf({ { 639.4, 479.4 }, 450 }), (Field{ 3, 3, 2 }));
    // Outside: the field nearest to it.
    QCOMPARE(view.fieldOf({ { 5000, -80 }, 20 }), (Field{ 3, 0, 0 }));
    view.setPlaces({ { { 10, 10 }, 160 }, { { 20, 20 }, 170 }, { { 620, 10 }, 440 } });
    QCOMPARE(view.count({ 0, 0, 0 }), 2);
    QCOMPARE(view.count({ 3, 0, 2 }), 1);
    QCOMPARE(view.filledCount(), 2);
    view.setPlaces({});
    QCOMPARE(view.filledCount(), 0);
  }

  void TheToolTip_SaysPixelsAndMillimetres()
  {
    CoverageView view;
    view.setImageSize({ 640, 480 });
    view.setWorkingRange(150, 450);
    testing_widgets::show(view, { 520, 220 });
    view.setNextPlace(Place{ { 600, 100 }, 300 });
    const QPoint place = view.fieldRectangle({ 3, 0, 1 }).center().toPoint();
    QHelpEvent event(QEvent::ToolTip, place, view.mapToGlobal(place));
    QApplication::sendEvent(&view, &event);
    const QString text = QToolTip::text();
    QVERIFY2(text.contains(QStringLiteral("480 to 639 px")) && text.contains(QStringLiteral("0 to 119 px")) &&
        text.contains(QStringLiteral("250 to 350 mm")) && text.contains(QStringLiteral("next")),
      qPrintable(text));
    QToolTip::hideText();
  }

  void Fields_AreInsideAndApart_AtAnySize()
  {
    CoverageView view;
    view.setImageSize({ 640, 480 });
    testing_widgets::show(view, { 520, 220 });
    for (const QSize& size : { QSize(520, 220), QSize(260, 130), QSize(300, 500) })
    {
      view.resize(size);
      for (int band = 0; band < CoverageView::Bands; ++band)
      {
        const QRectF last = view.fieldRectangle({ 3, 3, band });
        QVERIFY(QRectF(view.rect()).contains(last));
        const QRectF grid(view.fieldRectangle({ 0, 0, band }).topLeft(), last.bottomRight());
        QVERIFY(std::abs(grid.width() / grid.height() - 4.0 / 3) < 0.02);
        if (band > 0)
        {
          QVERIFY(grid.left() > view.fieldRectangle({ 3, 0, band - 1 }).right());
        }
      }
    }
  }

  void TheNextPlace_IsHighlighted()
  {
    CoverageView view;
    view.setImageSize({ 640, 480 });
    view.setWorkingRange(150, 450);
    testing_widgets::show(view, { 520, 220 });
    const QImage before = view.grab().toImage();
    view.setNextPlace(Place{ { 600, 100 }, 300 });
    const QImage after = view.grab().toImage();
    const QRect changed = (QRectF(view.fieldRectangle({ 3, 0, 1 })).adjusted(-2, -2, 2, 2)).toAlignedRect();
    const double ratio = view.devicePixelRatioF();
    int inside = 0, outside = 0;
    for (int y = 0; y < after.height() - 30 * ratio; ++y)  // the line of words below is another thing
    {
      for (int x = 0; x < after.width(); ++x)
      {
        if (after.pixel(x, y) != before.pixel(x, y))
        {
          ++(changed.contains(int(x / ratio), int(y / ratio)) ? inside : outside);
        }
      }
    }
    QVERIFY(inside > 50);
    QCOMPARE(outside, 0);
  }

  void TheKeyboard_GoesThroughTheFields()
  {
    CoverageView view;
    view.setImageSize({ 640, 480 });
    view.setWorkingRange(150, 450);
    testing_widgets::show(view, { 520, 220 });
    view.activateWindow();
    view.setFocus();
    QTRY_VERIFY(view.hasFocus());
    for (int step = 0; step < 4; ++step)
    {
      QTest::keyClick(&view, Qt::Key_Right);
    }
    QTest::keyClick(&view, Qt::Key_Down);
    // The fifth column is the first of the middle band.
    QVERIFY2(view.accessibleDescription().contains(QStringLiteral("x 0 to 159 px, y 120 to 239 px; Middle, 250 to 350 mm")),
      qPrintable(view.accessibleDescription()));
  }

  void ARangeThatIsNone_IsRefused()
  {
    CoverageView view;
    QVERIFY_EXCEPTION_THROWN(view.setWorkingRange(400, 400), std::invalid_argument);
    QVERIFY_EXCEPTION_THROWN(view.setWorkingRange(100, std::numeric_limits<double>::infinity()), std::invalid_argument);
  }
};

HANDEYE_WIDGET_TEST_MAIN(CoverageViewTest)
#include "CoverageViewTest.moc"
