// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DirectionDome.h"

#include "PivotCollector.h"
#include "WidgetTestSupport.h"

#include <QSet>

#include <cmath>

using namespace handeye;

class DirectionDomeTest : public QObject
{
  Q_OBJECT

private slots:
  void EveryCell_IsWhereItsDirectionIs()
  {
    DirectionDome dome;
    testing_widgets::show(dome, { 300, 370 });
    for (int cell = 0; cell < DirectionDome::cellCount(); ++cell)
    {
      QCOMPARE(dome.cellAt(dome.cellCenter(cell)), cell);
    }
    QCOMPARE(dome.cellAt({ 1, 1 }), -1);
    // Sectors run counter-clockwise from -x: the first of a ring is left, just below the middle; the fifth is right, above it.
    const QPointF middle = dome.cellCenter(0), first = dome.cellCenter(9), fifth = dome.cellCenter(13);
    QVERIFY(first.x() < middle.x() && first.y() > middle.y());
    QVERIFY(fifth.x() > middle.x() && fifth.y() < middle.y());
  }

  void TheCells_AreThoseOfTheCollector()
  {
    // A shaft that leans towards +x of the dome fills a cell that is drawn on the right.
    PivotCollector collector;
    const Eigen::Vector3d pivot_Tracker(100, 50, -900);
    const Eigen::Vector3d tip_Stylus(0, 0, -150);
    for (int turn = 0; turn < 400; ++turn)
    {
      const double heading = turn * 2.399963, lean = 0.5 * std::sqrt((turn + 0.5) / 400);
      const Eigen::Vector3d axis(-std::sin(heading), std::cos(heading), 0);
      Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
      stylusToTracker.linear() = Eigen::AngleAxisd(lean, axis).toRotationMatrix();
      stylusToTracker.translation() = pivot_Tracker - stylusToTracker.linear() * tip_Stylus;
      collector.add(stylusToTracker);
    }
    DirectionDome dome;
    dome.setTarget(1);
    dome.setCoverage(collector.coverage());
    QCOMPARE(dome.filledCount(), 17);
    QVERIFY(dome.accessibleDescription().contains(QStringLiteral("17 of 17")));
  }

  void ViewAngle_TurnsThePicture()
  {
    DirectionDome dome;
    testing_widgets::show(dome, { 300, 370 });
    const QPointF before = dome.cellCenter(13);
    dome.setViewAngle(90);
    const QPointF middle = dome.cellCenter(0), after = dome.cellCenter(13);
    // A quarter turn counter-clockwise takes (x, y up) to (-y, x).
    QVERIFY(std::abs((after.x() - middle.x()) - (before.y() - middle.y())) < 1e-6);
    QVERIFY(std::abs((after.y() - middle.y()) + (before.x() - middle.x())) < 1e-6);
    QCOMPARE(dome.cellAt(after), 13);
  }

  void CellsFill_AndTheTargetDecidesWhatIsFull()
  {
    DirectionDome dome;
    testing_widgets::show(dome, { 300, 370 });
    const QImage empty = dome.grab().toImage();
    DomeCoverage coverage;
    coverage.poses[0] = 3;
    coverage.poses[4] = 2;
    dome.setCoverage(coverage);
    QCOMPARE(dome.filledCount(), 1);
    dome.setTarget(2);
    QCOMPARE(dome.filledCount(), 2);
    const QImage filled = dome.grab().toImage();
    const double ratio = dome.devicePixelRatioF();
    const QPoint place = ((dome.cellCenter(4) + QPointF(-12, -12)) * ratio).toPoint();
    QVERIFY(filled.pixelColor(place) != empty.pixelColor(place));
    const QPoint other = ((dome.cellCenter(12) + QPointF(12, 12)) * ratio).toPoint();
    QCOMPARE(filled.pixelColor(other), empty.pixelColor(other));
  }

  void Words_AreShownAndReadAloud()
  {
    DirectionDome dome;
    testing_widgets::show(dome, { 300, 370 });
    const QImage before = dome.grab().toImage();
    dome.setHint(QStringLiteral("turn more to the left"));
    QVERIFY(dome.grab().toImage() != before);
    QVERIFY(dome.accessibleDescription().contains(QStringLiteral("turn more to the left")));
  }
};

HANDEYE_WIDGET_TEST_MAIN(DirectionDomeTest)
#include "DirectionDomeTest.moc"
