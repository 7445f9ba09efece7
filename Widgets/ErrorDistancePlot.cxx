// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorDistancePlot.h"

#include "ChartCanvas.h"
#include "Look.h"

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

vtkSmartPointer<vtkTable> makeTable(const QVector<QPointF>& points, const char* yName)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("distance");
  y->SetName(yName);
  for (const QPointF& point : points)
  {
    if (std::isfinite(point.x()) && std::isfinite(point.y()))
    {
      x->InsertNextValue(point.x());
      y->InsertNextValue(point.y());
    }
  }
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

/// The axes' ends: all points and means, from zero error, with some air.
struct Ranges
{
  double left = 0, right = 1, top = 1;
  bool isEmpty = true;
};

/// The marks of the series, as VTK draws them and as the legend writes them.
struct Marker
{
  int style;
  char16_t sign;
};
constexpr Marker Markers[] = { { vtkPlotPoints::CIRCLE, u'\u25cf' }, { vtkPlotPoints::SQUARE, u'\u25a0' },
  { vtkPlotPoints::DIAMOND, u'\u25c6' }, { vtkPlotPoints::CROSS, u'\u2715' }, { vtkPlotPoints::PLUS, u'\u271a' } };

const Marker& markerOf(int index)
{
  return Markers[std::size_t(index) % std::size(Markers)];
}

/// About five round numbers (1, 2, 5 times a power of ten) for an axis. VTK's own choice does not ask how large the labels are.
void setTicks(vtkAxis* axis, double begin, double end)
{
  const double rough = (end - begin) / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  const int digits = std::max(0, int(-std::floor(std::log10(step) + 1e-9)));
  // A label at the very end would be cut off.
  for (double tick = step * std::ceil(begin / step - 1e-9); tick < end - 0.15 * step; tick += step)
  {
    positions->InsertNextValue(tick);
    labels->InsertNextValue(QLocale().toString(tick, 'f', digits).toStdString());
  }
  axis->SetCustomTickPositions(positions, labels);
}

Ranges rangesOf(const QVector<ErrorSeries>& series)
{
  Ranges ranges;
  for (const ErrorSeries& one : series)
  {
    for (const QPointF& point : one.points)
    {
      if (std::isfinite(point.x()) && std::isfinite(point.y()))
      {
        ranges.left = ranges.isEmpty ? point.x() : std::min(ranges.left, point.x());
        ranges.right = ranges.isEmpty ? point.x() : std::max(ranges.right, point.x());
        ranges.top = std::max(ranges.isEmpty ? 0 : ranges.top, point.y());
        ranges.isEmpty = false;
      }
    }
  }
  const double air = std::max(10.0, 0.05 * (ranges.right - ranges.left));
  ranges.left = std::max(0.0, ranges.left - air);
  ranges.right += air;
  ranges.top = std::max(0.1, 1.12 * ranges.top);
  return ranges;
}

}  // namespace

class ErrorDistancePlot::Private
{
public:
  void build(const ErrorDistancePlot& plot);
  void style(const ErrorDistancePlot& plot);
  void styleAxis(vtkAxis* axis, const QString& title, const QWidget& widget);
  void addSeries(const ErrorSeries& one, int index, const QPalette& palette, const Ranges& ranges);
  QString wordsAt(const QPointF& place) const;

  void writeLegend(const QPalette& palette);

  QStackedLayout* layout = nullptr;
  QLabel* legend = nullptr;
  QWidget* page = nullptr;
  QLabel* nothing = nullptr;
  ChartCanvas* canvas = nullptr;
  vtkNew<vtkChartXY> chart;
  QVector<ErrorSeries> series;
};

ErrorDistancePlot::ErrorDistancePlot(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>())
{
  this->setAccessibleName(tr("Projection error against distance"));
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
  d->canvas->setAccessibleName(this->accessibleName());
  d->canvas->setToolTip(tr("Projection error (px) of each sample against its distance from the camera (mm); the line is the mean. "
                           "Point at a mark for its numbers."));
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
}

ErrorDistancePlot::~ErrorDistancePlot() = default;

void ErrorDistancePlot::setSeries(const QVector<ErrorSeries>& series)
{
  d->series = series;
  d->build(*this);
  d->canvas->update();
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
  const Ranges ranges = rangesOf(series);
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
  left->SetRange(0, ranges.top);
  setTicks(bottom, ranges.left, ranges.right);
  setTicks(left, 0, ranges.top);
  this->style(plot);
}

void ErrorDistancePlot::Private::addSeries(const ErrorSeries& one, int index, const QPalette& palette, const Ranges& ranges)
{
  const QColor color = one.color.isValid() ? one.color : seriesColor(index, palette);
  if (one.errorPx.count > 0)
  {
    vtkPlot* mean = chart->AddPlot(vtkChart::LINE);
    mean->SetInputData(makeTable({ { ranges.left, one.errorPx.mean }, { ranges.right, one.errorPx.mean } }, "mean"), 0, 1);
    const QString title =
      ErrorDistancePlot::tr("%1: mean %2").arg(one.name, withUnit(one.errorPx.mean, 2, ErrorDistancePlot::tr("px")));
    mean->SetLabel(title.toStdString());
    mean->GetPen()->SetColor(toVtk(color));
    mean->GetPen()->SetWidth(1.6F);
    mean->GetPen()->SetLineType(vtkPen::DASH_LINE);
  }
  auto* points = vtkPlotPoints::SafeDownCast(chart->AddPlot(vtkChart::POINTS));
  points->SetInputData(makeTable(one.points, "error"), 0, 1);
  points->SetLabel(one.name.toStdString());
  points->SetMarkerStyle(markerOf(index).style);
  points->SetMarkerSize(9);
  points->GetPen()->SetColor(toVtk(color));
  points->GetPen()->SetWidth(1.5F);
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
      const QPointF mark(along(chart->GetAxis(vtkAxis::BOTTOM), point.x(), 0), along(chart->GetAxis(vtkAxis::LEFT), point.y(), 1));
      const double distancePx = std::hypot(mark.x() - place.x(), mark.y() - place.y());
      if (distancePx < nearestPx)
      {
        nearestPx = distancePx;
        words = ErrorDistancePlot::tr("%1: %2 at %3")
                  .arg(one.name, withUnit(point.y(), 2, ErrorDistancePlot::tr("px")),
                    withUnit(point.x(), 0, ErrorDistancePlot::tr("mm")));
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
    const QColor color = one.color.isValid() ? one.color : seriesColor(index, palette);
    const QString mean = one.errorPx.count > 0
      ? ErrorDistancePlot::tr(" (mean %1)").arg(withUnit(one.errorPx.mean, 2, ErrorDistancePlot::tr("px")))
      : QString();
    entries += QStringLiteral("<span style=\"color:%1\">%2</span>&nbsp;%3%4")
                 .arg(color.name(), QString(QChar(markerOf(index).sign)), one.name.toHtmlEscaped(), mean.toHtmlEscaped());
  }
  legend->setText(entries.join(QStringLiteral(" &nbsp; &nbsp;")));
}

void ErrorDistancePlot::Private::style(const ErrorDistancePlot& plot)
{
  const QPalette& palette = plot.palette();
  const QColor ground = palette.color(QPalette::Base);
  chart->GetBackgroundBrush()->SetColor(toVtk(ground));
  this->styleAxis(chart->GetAxis(vtkAxis::BOTTOM), ErrorDistancePlot::tr("Distance from the camera [mm]"), plot);
  this->styleAxis(chart->GetAxis(vtkAxis::LEFT), ErrorDistancePlot::tr("Projection error [px]"), plot);
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
