// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensCoverageView.h"

#include "Look.h"

#include <QPainter>

#include <algorithm>

namespace handeye
{

LensCoverageView::LensCoverageView(QWidget* parent)
  : QWidget(parent)
{
  QSizePolicy policy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setSizePolicy(policy);
  setState({});
}

void LensCoverageView::setState(const LensTask::State& state)
{
  const bool isOther = state.views != state_.views || state.width != state_.width || accessibleName().isEmpty();
  state_ = state;
  if (isOther)
  {
    setAccessibleName(tr("Coverage of the image: %1 %").arg(100 * state.coverageShare, 0, 'f', 0));
    setToolTip(tr("Where in the image (%1 x %2 px) the views have points; empty cells still need the board")
                 .arg(state.width)
                 .arg(state.height));
    update();
  }
}

void LensCoverageView::paintEvent(QPaintEvent* /*event*/)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double aspect = state_.width > 0 ? double(state_.width) / state_.height : 4.0 / 3;
  const double drawnWidth = std::min(double(width()) - 2, (height() - 2) * aspect);
  const QRectF frame((width() - drawnWidth) / 2, (height() - drawnWidth / aspect) / 2, drawnWidth, drawnWidth / aspect);
  painter.fillRect(frame, palette().color(QPalette::Base));
  QColor good = levelColor(Level::Good, palette());
  const double cellWidth = frame.width() / std::max<double>(1, double(state_.coverage.cols()));
  const double cellHeight = frame.height() / std::max<double>(1, double(state_.coverage.rows()));
  for (int row = 0; row < state_.coverage.rows(); ++row)
  {
    for (int column = 0; column < state_.coverage.cols(); ++column)
    {
      const QRectF cell(frame.left() + column * cellWidth, frame.top() + row * cellHeight, cellWidth, cellHeight);
      const int points = state_.coverage(row, column);
      if (points > 0)
      {
        good.setAlphaF(0.15 + 0.35 * std::min(1.0, points / 40.0));
        painter.fillRect(cell, good);
      }
      painter.setPen(palette().color(QPalette::Mid));
      painter.drawRect(cell);
    }
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(palette().color(QPalette::Text));
  for (const Eigen::Vector2d& point_Image : state_.points_Image)
  {
    painter.drawEllipse(frame.topLeft() +
        QPointF((point_Image.x() + 0.5) * frame.width() / state_.width, (point_Image.y() + 0.5) * frame.height() / state_.height),
      1.1, 1.1);
  }
  painter.setPen(palette().color(QPalette::Mid));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(frame);
  if (state_.views == 0)
  {
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(frame, Qt::AlignCenter | Qt::TextWordWrap, tr("No views yet"));
  }
}

}  // namespace handeye
