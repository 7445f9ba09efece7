// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ErrorSeries.h"

#include <QVector>
#include <QWidget>

#include <memory>

class vtkChartXY;

namespace handeye
{

/// Projection error (px) against distance from the camera (mm): points of one marker and colour per series, and the mean of each as
/// a
/// line. Follows the palette, light or dark. Points that are not finite are left out. A vtkChartXY, painted by Qt: see ChartCanvas.
class ErrorDistancePlot : public QWidget
{
  Q_OBJECT

public:
  explicit ErrorDistancePlot(QWidget* parent = nullptr);
  ~ErrorDistancePlot() override;

  /// All series; empty shows words instead of axes.
  void setSeries(const QVector<ErrorSeries>& series);
  const QVector<ErrorSeries>& series() const;
  vtkChartXY* chart() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

protected:
  void changeEvent(QEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
