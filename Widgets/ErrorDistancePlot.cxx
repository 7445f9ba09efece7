// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorDistancePlot.h"

#include "ChartCanvas.h"
#include "Look.h"
#include "PlotAxes.h"

#include <QEvent>
#include <QLabel>
#include <QLocale>
#include <QPalette>
#include <QStackedLayout>
#include <QStringList>
#include <QVBoxLayout>
#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkColor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

vtkColor4ub toVtk(const QColor& color, int alpha = 255)
{
  return { static_cast<unsigned char>(color.red()), static_cast<unsigned char>(color.green()),
    static_cast<unsigned char>(color.blue()), static_cast<unsigned char>(alpha) };
}

/// More series than this make a tangle of their means.
constexpr int MostMeans = 4;

vtkSmartPointer<vtkTable> makeTable(const QVector<QPointF>& points, const char* yName, bool isLogarithmic)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("distance");
  y->SetName(yName);
  for (const QPointF& point : points)
  {
    const double height = isLogarithmic ? std::log10(point.y()) : point.y();
    if (std::isfinite(point.x()) && std::isfinite(height))
    {
      x->InsertNextValue(point.x());
      y->InsertNextValue(height);
    }
  }
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

/// The marks of the series, as VTK draws them and as the legend writes them.
struct Marker
{
  int style;
  char16_t sign;
};
constexpr Marker Markers[] = { { vtkPlotPoints::CIRCLE, u'\u25cf' }, { vtkPlotPoints::SQUARE, u'\u25a0' },
  { vtkPlotPoints::DIAMOND, u'\u25c6' }, { vtkPlotPoints::PLUS, u'\u271a' } };

const Marker& markerOf(const SeriesLook& look)
{
  return Markers[std::size_t(look.marker) % std::size(Markers)];
}

SeriesLook lookOf(const ErrorSeries& one, int index)
{
  return one.look.value_or(SeriesLook{ index, index, false });
}

}  // namespace

class ErrorDistancePlot::Private
{
public:
  void build(const ErrorDistancePlot& plot);
  void style(const ErrorDistancePlot& plot);
  void styleAxis(vtkAxis* axis, const QString& title, const QWidget& widget);
  void addSeries(const ErrorSeries& one, int index, const QPalette& palette, const PlotRanges& ranges);
  QString wordsAt(const QPointF& place) const;

  void writeLegend(const QPalette& palette);

  QStackedLayout* layout = nullptr;
  QLabel* legend = nullptr;
  QWidget* page = nullptr;
  QLabel* nothing = nullptr;
  ChartCanvas* canvas = nullptr;
  vtkNew<vtkChartXY> chart;
  QVector<ErrorSeries> series;
  ErrorPlotAxes axes;
};

ErrorDistancePlot::ErrorDistancePlot(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>())
{
  d->layout = new QStackedLayout(this);
  d->nothing = new QLabel(tr("No errors to show yet"), this);
  d->nothing->setAlignment(Qt::AlignCenter);
  d->nothing->setWordWrap(true);
  d->page = new QWidget(this);
  auto* column = new QVBoxLayout(d->page);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  d->legend = new QLabel(d->page);
  d->legend->setWordWrap(true);
  d->legend->setAlignment(Qt::AlignCenter);
  d->canvas = new ChartCanvas(d->page);
  column->addWidget(d->legend);
  column->addWidget(d->canvas, 1);
  d->layout->addWidget(d->nothing);
  d->layout->addWidget(d->page);
  d->canvas->scene()->AddItem(d->chart);
  d->chart->SetShowLegend(false);
  d->chart->SetHiddenAxisBorder(0);
  d->chart->SetAutoSize(false);
  d->canvas->setBeforePainting(
    [chart = d->chart.Get()](const QSize& size)
    {
      // VTK lets the letters of the axes touch the borders, or be cut off by them.
      constexpr float margin = 5;
      chart->SetSize(vtkRectf(margin, 1.5F * margin, float(size.width()) - 2 * margin, float(size.height()) - 2.5F * margin));
    });
  d->canvas->setToolTipAt([this](const QPointF& place) { return d->wordsAt(place); });
  this->setAxes({});
}

ErrorDistancePlot::~ErrorDistancePlot() = default;

void ErrorDistancePlot::setSeries(const QVector<ErrorSeries>& series)
{
  d->series = series;
  d->build(*this);
  d->canvas->update();
}

void ErrorDistancePlot::setAxes(const ErrorPlotAxes& axes)
{
  d->axes = axes;
  this->setAccessibleName(tr("%1 against %2").arg(axes.yTitle, axes.xTitle));
  d->canvas->setAccessibleName(this->accessibleName());
  d->canvas->setToolTip(axes.description + QLatin1Char(' ') + tr("Point at a mark for its numbers."));
  d->build(*this);
  d->canvas->update();
}

QString ErrorDistancePlot::markOf(const SeriesLook& look, const QPalette& palette)
{
  return QStringLiteral("<span style=\"color:%1\">%2</span>")
    .arg(seriesColor(look.color, palette).name(), QString(QChar(markerOf(look).sign)));
}

const QVector<ErrorSeries>& ErrorDistancePlot::series() const
{
  return d->series;
}

vtkChartXY* ErrorDistancePlot::chart() const
{
  return d->chart;
}

QSize ErrorDistancePlot::sizeHint() const
{
  return { 480, 320 };
}

QSize ErrorDistancePlot::minimumSizeHint() const
{
  return { 260, 180 };
}

void ErrorDistancePlot::Private::build(const ErrorDistancePlot& plot)
{
  chart->ClearPlots();
  const PlotRanges ranges = PlotRanges::of(series, axes.isLogarithmic, axes.leastAir);
  layout->setCurrentWidget(ranges.isEmpty ? static_cast<QWidget*>(nothing) : page);
  QStringList words;
  for (int index = 0; index < series.size(); ++index)
  {
    this->addSeries(series[index], index, plot.palette(), ranges);
    words += ErrorDistancePlot::tr("%1: mean %2, largest %3")
               .arg(series[index].name, withUnit(series[index].errorPx.mean, 2, ErrorDistancePlot::tr("px")),
                 withUnit(series[index].errorPx.maximum, 2, ErrorDistancePlot::tr("px")));
  }
  canvas->setAccessibleDescription(words.join(QStringLiteral("; ")));
  vtkAxis* bottom = chart->GetAxis(vtkAxis::BOTTOM);
  vtkAxis* left = chart->GetAxis(vtkAxis::LEFT);
  bottom->SetBehavior(vtkAxis::FIXED);
  left->SetBehavior(vtkAxis::FIXED);
  bottom->SetRange(ranges.left, ranges.right);
  left->SetRange(ranges.bottom, ranges.top);
  setPlainTicks(bottom, ranges.left, ranges.right);
  (axes.isLogarithmic ? setLogarithmicTicks : setPlainTicks)(left, ranges.bottom, ranges.top);
  this->style(plot);
}

void ErrorDistancePlot::Private::addSeries(const ErrorSeries& one, int index, const QPalette& palette, const PlotRanges& ranges)
{
  const SeriesLook look = lookOf(one, index);
  const QColor color = one.color.isValid() ? one.color : seriesColor(look.color, palette);
  if (one.errorPx.count > 0 && series.size() <= MostMeans && !axes.isLogarithmic)
  {
    vtkPlot* mean = chart->AddPlot(vtkChart::LINE);
    mean->SetInputData(makeTable({ { ranges.left, one.errorPx.mean }, { ranges.right, one.errorPx.mean } }, "mean", false), 0, 1);
    const QString title =
      ErrorDistancePlot::tr("%1: mean %2").arg(one.name, withUnit(one.errorPx.mean, 2, ErrorDistancePlot::tr("px")));
    mean->SetLabel(title.toStdString());
    mean->GetPen()->SetColor(toVtk(color));
    mean->GetPen()->SetWidth(1.6F);
    mean->GetPen()->SetLineType(vtkPen::DASH_LINE);
  }
  auto* points =
    vtkPlotPoints::SafeDownCast(chart->AddPlot(axes.isJoined && one.points.size() > 1 ? vtkChart::LINE : vtkChart::POINTS));
  points->SetInputData(makeTable(one.points, "error", axes.isLogarithmic), 0, 1);
  points->SetLabel(one.name.toStdString());
  points->SetMarkerStyle(markerOf(look).style);
  points->SetMarkerSize(9);
  points->GetPen()->SetColor(toVtk(color));
  points->GetPen()->SetWidth(1.5F);
  points->GetPen()->SetLineType(axes.isJoined && look.isDashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
  points->GetBrush()->SetColor(toVtk(color, 200));
}

/// The nearest mark's numbers, if one is at this place of the canvas.
QString ErrorDistancePlot::Private::wordsAt(const QPointF& place) const
{
  const auto along = [](vtkAxis* axis, double value, int coordinate)
  {
    const double share = (value - axis->GetMinimum()) / (axis->GetMaximum() - axis->GetMinimum());
    return axis->GetPoint1()[coordinate] + share * (axis->GetPoint2()[coordinate] - axis->GetPoint1()[coordinate]);
  };
  double nearestPx = 8;
  QString words;
  for (const ErrorSeries& one : series)
  {
    for (const QPointF& point : one.points)
    {
      const double height = axes.isLogarithmic ? std::log10(point.y()) : point.y();
      const QPointF mark(along(chart->GetAxis(vtkAxis::BOTTOM), point.x(), 0), along(chart->GetAxis(vtkAxis::LEFT), height, 1));
      const double distancePx = std::hypot(mark.x() - place.x(), mark.y() - place.y());
      if (distancePx < nearestPx)
      {
        nearestPx = distancePx;
        words = ErrorDistancePlot::tr("%1: %2 at %3")
                  .arg(one.name, withUnit(point.y(), 2, ErrorDistancePlot::tr("px")), withUnit(point.x(), 0, axes.xUnit));
      }
    }
  }
  return words;
}

void ErrorDistancePlot::Private::styleAxis(vtkAxis* axis, const QString& title, const QWidget& widget)
{
  const QColor text = widget.palette().color(QPalette::Text);
  const QColor grid = widget.palette().color(QPalette::Mid);
  const int size = widget.fontInfo().pixelSize();
  axis->SetTitle(title.toStdString());
  for (vtkTextProperty* property : { axis->GetTitleProperties(), axis->GetLabelProperties() })
  {
    property->SetColor(text.redF(), text.greenF(), text.blueF());
    property->SetFontSize(size);
    property->SetBold(false);
  }
  axis->GetPen()->SetColor(toVtk(text));
  axis->GetPen()->SetWidth(1);
  axis->GetGridPen()->SetColor(toVtk(grid, 120));
  axis->GetGridPen()->SetWidth(1);
}

/// Above the chart, where it covers no point.
void ErrorDistancePlot::Private::writeLegend(const QPalette& palette)
{
  QStringList entries;
  for (int index = 0; index < series.size(); ++index)
  {
    const ErrorSeries& one = series[index];
    if (one.points.isEmpty())
    {
      continue;
    }
    const SeriesLook look = lookOf(one, index);
    const QColor color = one.color.isValid() ? one.color : seriesColor(look.color, palette);
    const QString mean = one.errorPx.count > 0 && series.size() <= MostMeans
      ? ErrorDistancePlot::tr(" (mean %1)").arg(withUnit(one.errorPx.mean, 2, ErrorDistancePlot::tr("px")))
      : QString();
    entries += QStringLiteral("<span style=\"color:%1\">%2</span>&nbsp;%3%4")
                 .arg(color.name(), QString(QChar(markerOf(look).sign)), one.name.toHtmlEscaped(), mean.toHtmlEscaped());
  }
  legend->setText(entries.join(QStringLiteral(" &nbsp; &nbsp;")));
}

void ErrorDistancePlot::Private::style(const ErrorDistancePlot& plot)
{
  const QPalette& palette = plot.palette();
  const QColor ground = palette.color(QPalette::Base);
  chart->GetBackgroundBrush()->SetColor(toVtk(ground));
  this->styleAxis(chart->GetAxis(vtkAxis::BOTTOM), axes.xTitle, plot);
  this->styleAxis(chart->GetAxis(vtkAxis::LEFT), axes.yTitle, plot);
  this->writeLegend(palette);
}

void ErrorDistancePlot::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange)
  {
    d->build(*this);
    d->canvas->update();
  }
}

}  // namespace handeye
