// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Statistics.h"

#include <QColor>
#include <QPointF>
#include <QString>
#include <QVector>

namespace handeye
{

/// Projection errors of one capture or method, for the plot and the table beside it.
struct ErrorSeries
{
  QString name;             ///< "validation", "fit"
  QVector<QPointF> points;  ///< x: distance from the camera, mm; y: error, px
  Summary errorPx;          ///< of the errors, as summarize() or validateHandEye() says
  QColor color;             ///< invalid: by the order of the series, see seriesColor()
};

}  // namespace handeye
