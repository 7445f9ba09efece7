// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Statistics.h"

#include <QColor>
#include <QPointF>
#include <QString>
#include <QVector>

#include <optional>

namespace handeye
{

/// How a series is drawn.
struct SeriesLook
{
  int color = 0;   ///< of seriesColor()
  int marker = 0;  ///< circle, square, diamond, plus; a cross stands for what failed
  bool isDashed = false;
};

/// Projection errors of one capture or method, for the plot and the table beside it.
struct ErrorSeries
{
  QString name;                    ///< "validation", "fit"
  QVector<QPointF> points;         ///< x: distance from the camera, mm; y: error, px
  Summary errorPx;                 ///< of the errors, as summarize() or validateHandEye() says
  QColor color;                    ///< invalid: by its look, see seriesColor()
  std::optional<SeriesLook> look;  ///< none: by the order of the series
};

}  // namespace handeye
