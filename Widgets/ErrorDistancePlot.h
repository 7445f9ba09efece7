// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ErrorSeries.h"

#include <QCoreApplication>
#include <QPalette>
#include <QString>
#include <QVector>
#include <QWidget>

#include <memory>

class vtkChartXY;

namespace handeye
{

/// What errors are drawn against, and how; the distance from the camera unless said otherwise.
struct ErrorPlotAxes
{
  QString xTitle = QCoreApplication::translate("ErrorDistancePlot", "Distance from the camera [mm]");
  QString yTitle = QCoreApplication::translate("ErrorDistancePlot", "Projection error [px]");
  QString xUnit = QStringLiteral("mm");
  double leastAir = 10;        ///< left and right of the points, in the unit of x
  bool isLogarithmic = false;  ///< of the errors: where they differ by so much that the small ones would lie on the axis
  bool isJoined = false;       ///< points of a series are joined by lines
  /// What is seen, a sentence.
  QString description = QCoreApplication::translate("ErrorDistancePlot",
    "Projection error (px) of each sample against its distance from the camera (mm); lines are the means of up to four series.");
};

/// Projection error (px) against distance from the camera (mm): points of one marker and colour per series, and the mean of each
/// (of up to four) as a line. Follows the palette, light or dark. Points that are not finite are left out. A vtkChartXY, painted by Qt:
/// see ChartCanvas.
class ErrorDistancePlot : public QWidget
{
  Q_OBJECT

public:
  explicit ErrorDistancePlot(QWidget* parent = nullptr);
  ~ErrorDistancePlot() override;

  /// All series; empty shows words instead of axes.
  void setSeries(const QVector<ErrorSeries>& series);
  const QVector<ErrorSeries>& series() const;
  /// For errors against something else, such as the number of samples.
  void setAxes(const ErrorPlotAxes& axes);
  /// The mark of a series in its colour, as rich text.
  static QString markOf(const SeriesLook& look, const QPalette& palette);
  vtkChartXY* chart() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  /// The legend's lines do not decide how high a plot is: a page would take that for all it needs.
  bool hasHeightForWidth() const override { return false; }

protected:
  void changeEvent(QEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
