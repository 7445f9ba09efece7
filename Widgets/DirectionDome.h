// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Look.h"

#include <QPointF>
#include <QWidget>

#include <array>
#include <optional>

namespace handeye
{

struct DomeCoverage;

/// The directions of the stylus while it is pivoted, as a dome that fills: its middle and two rings of eight sectors, seen from
/// above, each with the count of poses; below it what is still missing and the running error, in words given from outside.
///
/// The cells are those of DomeCoverage: x of the dome's own frame to the right, y up, ring sectors counter-clockwise from -x.
/// setViewAngle() turns the picture so that its right is the person's.
class DirectionDome : public QWidget
{
  Q_OBJECT

public:
  explicit DirectionDome(QWidget* parent = nullptr);

  void setCoverage(const DomeCoverage& coverage);
  /// Poses a cell needs to be full; that of DomeCoverage until set.
  void setTarget(int posesPerCell);
  /// Where the shaft points now: x, y in the dome's frame, 1 being its rim; nothing takes the mark away.
  void setCurrentDirection(const std::optional<QPointF>& direction_Dome);
  /// Turns the picture counter-clockwise (degrees).
  void setViewAngle(double degrees);

  /// "turn more to the left": behind the count.
  void setHint(const QString& text);

  /// Full cells, of how many.
  int filledCount() const;
  static int cellCount();
  /// The cell at a place of this widget; -1 for none.
  int cellAt(const QPointF& point_Widget) const;
  /// The middle of a cell in this widget.
  QPointF cellCenter(int cell) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

private:
  QRectF domeRectangle() const;
  void paintCells(QPainter& painter) const;
  void paintCounts(QPainter& painter) const;
  void paintDirection(QPainter& painter) const;
  void paintWords(QPainter& painter, double top) const;
  QString describe(int cell) const;
  void updateAccessibility();

  std::array<int, 17> poses_{};
  int target_;
  std::optional<QPointF> direction_Dome_;
  double viewAngleDeg_ = 0;
  QString hint_;
};

}  // namespace handeye
