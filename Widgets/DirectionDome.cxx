// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DirectionDome.h"

#include "PivotCollector.h"

#include <QHelpEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr int Sectors = DomeCoverage::Sectors;
constexpr double SectorDeg = 360.0 / Sectors;

/// 0 for the middle, 1 and 2 for the rings.
int ringOf(int cell)
{
  return cell == 0 ? 0 : 1 + (cell - 1) / Sectors;
}

/// Where a ring's sector begins, degrees counter-clockwise from +x.
double sectorStartDeg(int cell)
{
  return -180 + ((cell - 1) % Sectors) * SectorDeg;
}

QPointF polar(const QPointF& center, double radius, double angleDeg)
{
  const double angle = angleDeg * M_PI / 180;
  return center + QPointF(radius * std::cos(angle), -radius * std::sin(angle));
}

}  // namespace

DirectionDome::DirectionDome(QWidget* parent)
  : QWidget(parent)
  , target_(DomeCoverage::PosesEach)
{
  static_assert(DomeCoverage::Cells == 17, "the array of the header");
  this->setAccessibleName(tr("Directions of the stylus"));
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  this->updateAccessibility();
}

void DirectionDome::setCoverage(const DomeCoverage& coverage)
{
  poses_ = coverage.poses;
  this->updateAccessibility();
  this->update();
}

void DirectionDome::setTarget(int posesPerCell)
{
  target_ = std::max(1, posesPerCell);
  this->updateAccessibility();
  this->update();
}

void DirectionDome::setCurrentDirection(const std::optional<QPointF>& direction_Dome)
{
  direction_Dome_ = direction_Dome;
  this->update();
}

void DirectionDome::setViewAngle(double degrees)
{
  viewAngleDeg_ = degrees;
  this->update();
}

void DirectionDome::setHint(const QString& text)
{
  hint_ = text;
  this->updateAccessibility();
  this->update();
}

int DirectionDome::filledCount() const
{
  return int(std::count_if(poses_.begin(), poses_.end(), [this](int poses) { return poses >= target_; }));
}

int DirectionDome::cellCount()
{
  return DomeCoverage::Cells;
}

QRectF DirectionDome::domeRectangle() const
{
  const double line = this->fontMetrics().height();
  const double below = 2 * line + 10;
  const double side = std::max(40.0, std::min<double>(this->width(), this->height() - below) - 8);
  return { (this->width() - side) / 2, 4, side, side };
}

int DirectionDome::cellAt(const QPointF& point_Widget) const
{
  const QRectF dome = this->domeRectangle();
  const QPointF offset = point_Widget - dome.center();
  const double radius = std::hypot(offset.x(), offset.y()) / (dome.width() / 2);
  if (radius > 1)
  {
    return -1;
  }
  const int ring = int(3 * radius);
  if (ring == 0)
  {
    return 0;
  }
  double heading = std::atan2(-offset.y(), offset.x()) * 180 / M_PI - viewAngleDeg_ + 180;
  heading -= 360 * std::floor(heading / 360);
  return 1 + (std::min(ring, 2) - 1) * Sectors + std::min(Sectors - 1, int(heading / SectorDeg));
}

QPointF DirectionDome::cellCenter(int cell) const
{
  const QRectF dome = this->domeRectangle();
  if (cell <= 0)
  {
    return dome.center();
  }
  return polar(dome.center(), dome.width() / 2 * (ringOf(cell) + 0.5) / 3, sectorStartDeg(cell) + SectorDeg / 2 + viewAngleDeg_);
}

QString DirectionDome::describe(int cell) const
{
  const int poses = poses_[std::size_t(cell)];
  const QString count = tr("%1 of %2 poses").arg(poses).arg(target_);
  return cell == 0      ? tr("Upright: %1").arg(count)
    : ringOf(cell) == 1 ? tr("Leaning a little: %1").arg(count)
                        : tr("Leaning far: %1").arg(count);
}

void DirectionDome::updateAccessibility()
{
  const QString filled = tr("%1 of %2 directions covered").arg(this->filledCount()).arg(cellCount());
  QStringList sentences = { filled, hint_ };
  sentences.removeAll(QString());
  this->setAccessibleDescription(sentences.join(QStringLiteral(". ")));
}

QSize DirectionDome::sizeHint() const
{
  return { 280, 340 };
}

QSize DirectionDome::minimumSizeHint() const
{
  return { 160, 190 };
}

void DirectionDome::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  this->paintCells(painter);
  this->paintCounts(painter);
  this->paintDirection(painter);
  this->paintWords(painter, this->domeRectangle().bottom() + 6);
}

void DirectionDome::paintCells(QPainter& painter) const
{
  const QRectF dome = this->domeRectangle();
  const QColor ground = this->palette().color(QPalette::Base);
  const QColor full = levelColor(Level::Good, this->palette());
  const auto mixed = [&](double strength)
  {
    return QColor::fromRgbF(ground.redF() + (full.redF() - ground.redF()) * strength,
      ground.greenF() + (full.greenF() - ground.greenF()) * strength, ground.blueF() + (full.blueF() - ground.blueF()) * strength);
  };
  painter.setPen(QPen(this->palette().color(QPalette::Mid), 1.2));
  // Outer rings first; each covers the inside of the one before.
  for (int cell = cellCount() - 1; cell >= 0; --cell)
  {
    const double outer = dome.width() / 2 * (ringOf(cell) + 1) / 3;
    const QRectF circle(dome.center() - QPointF(outer, outer), QSizeF(2 * outer, 2 * outer));
    const double share = std::min(1.0, poses_[std::size_t(cell)] / double(target_));
    painter.setBrush(share > 0 ? mixed(0.16 + 0.36 * share) : ground);
    if (cell == 0)
    {
      painter.drawEllipse(circle);
    }
    else
    {
      painter.drawPie(circle, int(std::lround(16 * (sectorStartDeg(cell) + viewAngleDeg_))), int(16 * SectorDeg));
    }
  }
}

void DirectionDome::paintCounts(QPainter& painter) const
{
  QFont font = this->font();
  font.setPointSizeF(std::max(6.5, font.pointSizeF() * std::min(1.0, this->domeRectangle().width() / 240)));
  painter.setFont(font);
  painter.setPen(this->palette().color(QPalette::Text));
  for (int cell = 0; cell < cellCount(); ++cell)
  {
    const int poses = poses_[std::size_t(cell)];
    const QRectF box(this->cellCenter(cell) - QPointF(30, 12), QSizeF(60, 24));
    // A full cell has a tick: colour is not all that says so.
    const QChar sign = poses >= target_ ? QChar(0x2713) : QChar(0x00b7);
    painter.drawText(box, Qt::AlignCenter, poses > 0 && poses < target_ ? QString::number(poses) : QString(sign));
  }
}

void DirectionDome::paintDirection(QPainter& painter) const
{
  if (!direction_Dome_)
  {
    return;
  }
  const QRectF dome = this->domeRectangle();
  const QColor ground = this->palette().color(QPalette::Base);
  const QColor color = seriesColor(0, this->palette());
  const double lean = std::min(1.0, std::hypot(direction_Dome_->x(), direction_Dome_->y()));
  const double heading = std::atan2(direction_Dome_->y(), direction_Dome_->x()) * 180 / M_PI + viewAngleDeg_;
  const QPointF tip = polar(dome.center(), dome.width() / 2 * lean, heading);
  painter.setPen(QPen(ground, 5));
  painter.drawLine(dome.center(), tip);
  painter.setPen(QPen(color, 2.5));
  painter.drawLine(dome.center(), tip);
  painter.setBrush(color);
  painter.setPen(QPen(ground, 1.5));
  painter.drawEllipse(tip, 6, 6);
}

void DirectionDome::paintWords(QPainter& painter, double top) const
{
  const double line = this->fontMetrics().height();
  painter.setFont(this->font());
  painter.setPen(this->palette().color(QPalette::WindowText));
  const QString counted = tr("%1 of %2 directions").arg(this->filledCount()).arg(cellCount());
  const QString first = hint_.isEmpty() ? counted : counted + QStringLiteral(" – ") + hint_;
  painter.drawText(QRectF(0, top, this->width(), 2 * line + 2), Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap, first);
}

bool DirectionDome::event(QEvent* event)
{
  if (event->type() == QEvent::ToolTip)
  {
    const auto* help = static_cast<QHelpEvent*>(event);
    const int cell = this->cellAt(help->pos());
    if (cell >= 0)
    {
      QToolTip::showText(help->globalPos(), this->describe(cell), this);
    }
    else
    {
      // The whole sentence, which may not have had room.
      QToolTip::showText(help->globalPos(), hint_, this);
    }
    return true;
  }
  return QWidget::event(event);
}

}  // namespace handeye
