// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorDistancePlot.h"

#include "Look.h"
#include "PlotAxes.h"

#include <QEvent>
#include <QLabel>
#include <QLocale>
#include <QPalette>
#include <QStackedLayout>
#include <QStringList>
#include <QTimer>
#include <QVBoxLayout>
#include <QVTKOpenGLNativeWidget.h>
#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkCallbackCommand.h>
#include <vtkChartXY.h>
#include <vtkColor.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkTooltipItem.h>

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
  { vtkPlotPoints::DIAMOND, u'\u25c6' }, { vtkPlotPoints::CROSS, u'\u2715' }, { vtkPlotPoints::PLUS, u'\u271a' } };

const Marker& markerOf(int index)
{
  return Markers[std::size_t(index) % std::size(Markers)];
}

}  // namespace

class ErrorDistancePlot::Private
{
public:
  void build(const ErrorDistancePlot& plot);
  void style(const ErrorDistancePlot& plot);
  void styleAxis(vtkAxis* axis, const QString& title, const QWidget& widget, double ratio);
  void addSeries(const ErrorSeries& one, int index, const QPalette& palette, const PlotRanges& ranges, double ratio);

  void writeLegend(const QPalette& palette);

  QStackedLayout* layout = nullptr;
  QLabel* legend = nullptr;
  QWidget* page = nullptr;
  QLabel* nothing = nullptr;
  QVTKOpenGLNativeWidget* gl = nullptr;
  /// A margin: VTK lets the letters of the axes touch the borders, or be cut off by them.
  void fitChart()
  {
    const int* size = window->GetSize();
    const float margin = 4.0F * float(window->GetDPI()) / 72;
    chart->SetSize(vtkRectf(margin, 1.5F * margin, float(size[0]) - 2 * margin, float(size[1]) - 2 * margin));
  }

  QTimer renderTimer;
  vtkNew<vtkCallbackCommand> beforeRendering;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkContextView> view;
  vtkNew<vtkChartXY> chart;
  QVector<ErrorSeries> series;
  ErrorPlotAxes axes;
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
  d->gl = new QVTKOpenGLNativeWidget(d->page);
  column->addWidget(d->legend);
  column->addWidget(d->gl, 1);
  d->gl->setRenderWindow(d->window);
  d->gl->setAccessibleName(this->accessibleName());
  d->gl->setToolTip(tr("Projection error (px) of each sample against its distance from the camera (mm); the line is the mean. "
                       "Point at a mark for its numbers."));
  d->layout->addWidget(d->nothing);
  d->layout->addWidget(d->page);
  d->view->SetRenderWindow(d->window);
  d->view->GetScene()->AddItem(d->chart);
  d->chart->SetShowLegend(false);
  // The whole is always seen; the wheel scrolls the page.
  d->chart->SetZoomWithMouseWheel(false);
  for (const int action : { vtkChart::PAN, vtkChart::ZOOM, vtkChart::SELECT })
  {
    d->chart->SetActionToButton(action, -1);
  }
  d->chart->SetHiddenAxisBorder(0);
  d->chart->SetAutoSize(false);
  d->beforeRendering->SetClientData(d.get());
  d->beforeRendering->SetCallback([](vtkObject*, unsigned long, void* self, void*) { static_cast<Private*>(self)->fitChart(); });
  d->window->AddObserver(vtkCommand::StartEvent, d->beforeRendering);
  d->renderTimer.setSingleShot(true);
  d->renderTimer.setInterval(0);
  connect(&d->renderTimer, &QTimer::timeout, this,
    [this]
    {
      if (d->gl->isVisible() && d->gl->isValid())
      {
        d->window->Render();
      }
    });
}

ErrorDistancePlot::~ErrorDistancePlot()
{
  d->window->RemoveObserver(d->beforeRendering);
}

void ErrorDistancePlot::setSeries(const QVector<ErrorSeries>& series)
{
  d->series = series;
  d->build(*this);
  d->renderTimer.start();
}

void ErrorDistancePlot::setAxes(const ErrorPlotAxes& axes)
{
  d->axes = axes;
  d->build(*this);
  d->renderTimer.start();
}

QString ErrorDistancePlot::markOf(int index, const QPalette& palette)
{
  return QStringLiteral("<span style=\"color:%1\">%2</span>")
    .arg(seriesColor(index, palette).name(), QString(QChar(markerOf(index).sign)));
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
  const double ratio = plot.devicePixelRatioF();
  for (int index = 0; index < series.size(); ++index)
  {
    this->addSeries(series[index], index, plot.palette(), ranges, ratio);
    words += ErrorDistancePlot::tr("%1: mean %2, largest %3")
               .arg(series[index].name, withUnit(series[index].errorPx.mean, 2, ErrorDistancePlot::tr("px")),
                 withUnit(series[index].errorPx.maximum, 2, ErrorDistancePlot::tr("px")));
  }
  gl->setAccessibleDescription(words.join(QStringLiteral("; ")));
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

void ErrorDistancePlot::Private::addSeries(
  const ErrorSeries& one, int index, const QPalette& palette, const PlotRanges& ranges, double ratio)
{
  const QColor color = one.color.isValid() ? one.color : seriesColor(index, palette);
  if (one.errorPx.count > 0 && series.size() <= MostMeans && !axes.isLogarithmic)
  {
    vtkPlot* mean = chart->AddPlot(vtkChart::LINE);
    mean->SetInputData(makeTable({ { ranges.left, one.errorPx.mean }, { ranges.right, one.errorPx.mean } }, "mean", false), 0, 1);
    const QString title =
      ErrorDistancePlot::tr("%1: mean %2").arg(one.name, withUnit(one.errorPx.mean, 2, ErrorDistancePlot::tr("px")));
    mean->SetLabel(title.toStdString());
    mean->GetPen()->SetColor(toVtk(color));
    mean->GetPen()->SetWidth(float(1.6 * ratio));
    mean->GetPen()->SetLineType(vtkPen::DASH_LINE);
  }
  auto* points =
    vtkPlotPoints::SafeDownCast(chart->AddPlot(axes.isJoined && one.points.size() > 1 ? vtkChart::LINE : vtkChart::POINTS));
  points->SetInputData(makeTable(one.points, "error", axes.isLogarithmic), 0, 1);
  points->SetLabel(one.name.toStdString());
  points->SetMarkerStyle(markerOf(index).style);
  points->SetMarkerSize(float(9 * ratio));
  points->GetPen()->SetColor(toVtk(color));
  points->GetPen()->SetWidth(float(1.5 * ratio));
  points->GetBrush()->SetColor(toVtk(color, 200));
  const QString errorFormat = axes.isLogarithmic ? QString() : ErrorDistancePlot::tr(": %y px at %x %1").arg(axes.xUnit);
  points->SetTooltipLabelFormat((one.name + errorFormat).toStdString());
}

void ErrorDistancePlot::Private::styleAxis(vtkAxis* axis, const QString& title, const QWidget& widget, double ratio)
{
  const QColor text = widget.palette().color(QPalette::Text);
  const QColor grid = widget.palette().color(QPalette::Mid);
  // VTK multiplies by the window's resolution itself.
  const int size = widget.fontInfo().pixelSize();
  axis->SetTitle(title.toStdString());
  for (vtkTextProperty* property : { axis->GetTitleProperties(), axis->GetLabelProperties() })
  {
    property->SetColor(text.redF(), text.greenF(), text.blueF());
    property->SetFontSize(size);
    property->SetBold(false);
  }
  axis->GetPen()->SetColor(toVtk(text));
  axis->GetPen()->SetWidth(float(ratio));
  axis->GetGridPen()->SetColor(toVtk(grid, 120));
  axis->GetGridPen()->SetWidth(float(ratio));
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
    const QColor color = one.color.isValid() ? one.color : seriesColor(index, palette);
    const QString mean = one.errorPx.count > 0 && series.size() <= MostMeans
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
  const double ratio = plot.devicePixelRatioF();
  const QColor ground = palette.color(QPalette::Base);
  view->GetRenderer()->SetBackground(ground.redF(), ground.greenF(), ground.blueF());
  chart->GetBackgroundBrush()->SetColor(toVtk(ground));
  this->styleAxis(chart->GetAxis(vtkAxis::BOTTOM), axes.xTitle, plot, ratio);
  this->styleAxis(chart->GetAxis(vtkAxis::LEFT), axes.yTitle, plot, ratio);
  vtkTooltipItem* tooltip = chart->GetTooltip();
  tooltip->GetTextProperties()->SetFontSize(plot.fontInfo().pixelSize());
  this->writeLegend(palette);
}

void ErrorDistancePlot::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange)
  {
    d->build(*this);
    d->renderTimer.start();
  }
}

void ErrorDistancePlot::showEvent(QShowEvent* event)
{
  QWidget::showEvent(event);
  // On a screen of another device pixel ratio sizes are others.
  d->build(*this);
  d->renderTimer.start();
}

}  // namespace handeye
