// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorDistancePlot.h"

#include "ChartCanvas.h"
#include "Look.h"
#include "StatisticsTable.h"
#include "WidgetTestSupport.h"

#include <QClipboard>
#include <QHelpEvent>
#include <QLabel>
#include <QToolTip>
#include <vtkAxis.h>
#include <vtkChartXY.h>
#include <vtkDoubleArray.h>
#include <vtkPlot.h>
#include <vtkTable.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace handeye;

namespace
{

ErrorSeries seriesOf(const QString& name, const QVector<QPointF>& points)
{
  ErrorSeries series;
  series.name = name;
  series.points = points;
  std::vector<double> errors;
  for (const QPointF& point : points)
  {
    if (std::isfinite(point.y()))
    {
      errors.push_back(point.y());
    }
  }
  series.errorPx = summarize(errors);
  return series;
}

/// Pixels of a colour, with some slack for anti-aliasing.
int countOf(const QImage& image, const QColor& color)
{
  int count = 0;
  for (int y = 0; y < image.height(); ++y)
  {
    for (int x = 0; x < image.width(); ++x)
    {
      const QColor pixel = image.pixelColor(x, y);
      count +=
        std::abs(pixel.red() - color.red()) + std::abs(pixel.green() - color.green()) + std::abs(pixel.blue() - color.blue()) < 90;
    }
  }
  return count;
}

ChartCanvas& canvasOf(const ErrorDistancePlot& plot)
{
  for (QWidget* const child : plot.findChildren<QWidget*>())
  {
    if (auto* const canvas = dynamic_cast<ChartCanvas*>(child))
    {
      return *canvas;
    }
  }
  throw std::logic_error("there is no canvas");
}

const QVector<QPointF> Points{ { 150, 0.4 }, { 300, 1.2 }, { 420, 0.8 } };

}  // namespace

class ErrorDistancePlotTest : public QObject
{
  Q_OBJECT

private slots:
  void WithoutErrors_ThereAreWordsAndNoAxes()
  {
    ErrorDistancePlot plot;
    testing_widgets::show(plot, { 480, 320 });
    plot.setSeries({});
    QVERIFY(!canvasOf(plot).isVisible());
    plot.setSeries({ seriesOf(QStringLiteral("empty"), {}) });
    QVERIFY(!canvasOf(plot).isVisible());
    plot.setSeries({ seriesOf(QStringLiteral("validation"), Points) });
    QVERIFY(canvasOf(plot).isVisible());
  }

  void TheChart_HoldsThePointsTheMeanAndTheUnits()
  {
    ErrorDistancePlot plot;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    QVector<QPointF> points = Points;
    points.append({ 200, nan });
    plot.setSeries({ seriesOf(QStringLiteral("validation"), points) });
    vtkChartXY* chart = plot.chart();
    QCOMPARE(int(chart->GetNumberOfPlots()), 2);
    vtkTable* mean = chart->GetPlot(0)->GetInput();
    QCOMPARE(mean->GetValue(0, 1).ToDouble(), 0.8);
    QCOMPARE(mean->GetValue(1, 1).ToDouble(), 0.8);
    vtkTable* table = chart->GetPlot(1)->GetInput();
    QCOMPARE(int(table->GetNumberOfRows()), 3);
    QCOMPARE(table->GetValue(1, 0).ToDouble(), 300.0);
    QCOMPARE(table->GetValue(1, 1).ToDouble(), 1.2);
    vtkAxis* bottom = chart->GetAxis(vtkAxis::BOTTOM);
    vtkAxis* left = chart->GetAxis(vtkAxis::LEFT);
    QVERIFY(std::string(bottom->GetTitle()).find("mm") != std::string::npos);
    QVERIFY(std::string(left->GetTitle()).find("px") != std::string::npos);
    QVERIFY(left->GetMinimum() == 0 && left->GetMaximum() > 1.2);
    QVERIFY(bottom->GetMinimum() < 150 && bottom->GetMaximum() > 420);
    QVERIFY(bottom->GetTickPositions()->GetNumberOfTuples() >= 4);
  }

  void BothPalettes_ShowThePointsInTheirColour()
  {
    for (const bool dark : { false, true })
    {
      QApplication::setPalette(dark ? testing_widgets::darkPalette() : testing_widgets::lightPalette());
      ErrorDistancePlot plot;
      testing_widgets::show(plot, { 480, 320 });
      plot.setSeries(
        { seriesOf(QStringLiteral("validation"), Points), seriesOf(QStringLiteral("fit"), { { 200, 0.2 }, { 350, 0.3 } }) });
      QTest::qWait(200);
      const QImage seen = plot.grab().toImage();
      const QColor ground = seen.pixelColor(seen.width() - 2, seen.height() / 2);
      QCOMPARE(ground, plot.palette().color(QPalette::Base));
      QVERIFY(countOf(seen, seriesColor(0, plot.palette())) > 60);
      QVERIFY(countOf(seen, seriesColor(1, plot.palette())) > 40);
    }
  }

  /// Where VTK's axes say that a point is, there its mark is, and there its numbers are said.
  void AMark_IsAtItsNumbers_AndSaysThem()
  {
    QApplication::setPalette(testing_widgets::lightPalette());
    ErrorDistancePlot plot;
    testing_widgets::show(plot, { 480, 320 });
    plot.setSeries({ seriesOf(QStringLiteral("validation"), { { 150, 0.4 }, { 300, 1.2 } }) });
    ChartCanvas& canvas = canvasOf(plot);
    const QImage seen = canvas.grab().toImage();
    vtkAxis* bottom = plot.chart()->GetAxis(vtkAxis::BOTTOM);
    vtkAxis* left = plot.chart()->GetAxis(vtkAxis::LEFT);
    const double x = bottom->GetPoint1()[0] +
      (300 - bottom->GetMinimum()) / (bottom->GetMaximum() - bottom->GetMinimum()) *
        (bottom->GetPoint2()[0] - bottom->GetPoint1()[0]);
    const double y = left->GetPoint1()[1] +
      (1.2 - left->GetMinimum()) / (left->GetMaximum() - left->GetMinimum()) * (left->GetPoint2()[1] - left->GetPoint1()[1]);
    const QPoint place(qRound(x), qRound(canvas.height() - y));
    // The outline has the colour, what it fills is lighter.
    const QRect mark(place * seen.devicePixelRatio() - QPoint(7, 7), QSize(15, 15));
    QVERIFY(countOf(seen.copy(mark), seriesColor(0, plot.palette())) >= 10);
    QCOMPARE(countOf(seen.copy(mark.translated(30, 0)), seriesColor(0, plot.palette())), 0);
    QHelpEvent help(QEvent::ToolTip, place, canvas.mapToGlobal(place));
    QApplication::sendEvent(&canvas, &help);
    QTRY_VERIFY(QToolTip::text().contains(QStringLiteral("1.20")));
    QVERIFY2(QToolTip::text().contains(QStringLiteral("300")), qPrintable(QToolTip::text()));
  }

  void ThePaletteChangesWhileItIsShown()
  {
    QApplication::setPalette(testing_widgets::lightPalette());
    ErrorDistancePlot plot;
    testing_widgets::show(plot, { 480, 320 });
    plot.setSeries({ seriesOf(QStringLiteral("validation"), Points) });
    QTest::qWait(100);
    QApplication::setPalette(testing_widgets::darkPalette());
    QTest::qWait(200);
    const QImage seen = plot.grab().toImage();
    QCOMPARE(seen.pixelColor(seen.width() - 2, seen.height() / 2), testing_widgets::darkPalette().color(QPalette::Base));
    QApplication::setPalette(testing_widgets::lightPalette());
  }

  void TheTable_SaysRmsAndMeanApart_AndKnowsWhatItDoesNotKnow()
  {
    StatisticsTable table;
    table.setSeries({ seriesOf(QStringLiteral("validation"), { { 1, 1 }, { 2, 3 } }), seriesOf(QStringLiteral("one"), { { 1, 2 } }),
      seriesOf(QStringLiteral("none"), {}) });
    const auto text = [&](int row, int column) { return table.item(row, column)->text(); };
    QCOMPARE(text(0, StatisticsTable::Mean), QStringLiteral("2.00"));
    QCOMPARE(text(0, StatisticsTable::StandardDeviation), QStringLiteral("1.41"));
    QCOMPARE(text(0, StatisticsTable::Minimum), QStringLiteral("1.00"));
    QCOMPARE(text(0, StatisticsTable::Maximum), QStringLiteral("3.00"));
    QCOMPARE(text(0, StatisticsTable::Rms), QStringLiteral("2.24"));
    QCOMPARE(text(0, StatisticsTable::Count), QStringLiteral("2"));
    QCOMPARE(text(1, StatisticsTable::StandardDeviation), QStringLiteral("\u2013"));
    QCOMPARE(text(2, StatisticsTable::Mean), QStringLiteral("\u2013"));
    testing_widgets::show(table, { 560, 140 });
    QTest::keyClick(&table, Qt::Key_C, Qt::ControlModifier);
    const QString copied = QApplication::clipboard()->text();
    QVERIFY(copied.startsWith(QStringLiteral("Capture\tMean [px]")));
    QCOMPARE(copied.split(QLatin1Char('\n')).size(), 4);
  }
};

HANDEYE_WIDGET_TEST_MAIN(ErrorDistancePlotTest)
#include "ErrorDistancePlotTest.moc"
