// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoverageView.h"

#include "Look.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QLocale>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

constexpr double Gap = 10;

std::size_t indexOf(const CoverageView::Field& field)
{
  return std::size_t((field.band * CoverageView::Rows + field.row) * CoverageView::Columns + field.column);
}

int within(double share, int count)
{
  return std::clamp(int(std::floor(share * count)), 0, count - 1);
}

QString bandName(int band)
{
  return band == 0 ? CoverageView::tr("Near") : band == 1 ? CoverageView::tr("Middle") : CoverageView::tr("Far");
}

}  // namespace

CoverageView::CoverageView(QWidget* parent)
  : QWidget(parent)
{
  this->setAccessibleName(tr("Places of the ball"));
  this->setFocusPolicy(Qt::StrongFocus);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  this->updateAccessibility();
}

void CoverageView::setImageSize(const QSize& size)
{
  imageSize_ = size;
  this->update();
}

void CoverageView::setWorkingRange(double nearestMm, double furthestMm)
{
  if (!(nearestMm >= 0 && nearestMm < furthestMm && std::isfinite(furthestMm)))
  {
    throw std::invalid_argument("the working range goes from a distance (mm) to a larger one");
  }
  nearestMm_ = nearestMm;
  furthestMm_ = furthestMm;
  this->update();
}

void CoverageView::setPlaces(const QVector<Place>& places)
{
  counts_ = {};
  for (const Place& place : places)
  {
    ++counts_[indexOf(this->fieldOf(place))];
  }
  this->updateAccessibility();
  this->update();
}

void CoverageView::setNextPlace(const std::optional<Place>& place)
{
  next_ = place;
  this->updateAccessibility();
  this->update();
}

void CoverageView::setCurrentPlace(const std::optional<Place>& place)
{
  current_ = place;
  this->update();
}

CoverageView::Field CoverageView::fieldOf(const Place& place) const
{
  Field field;
  if (!imageSize_.isEmpty())
  {
    field.column = within((place.ball_Image_Px.x() + 0.5) / imageSize_.width(), Columns);
    field.row = within((place.ball_Image_Px.y() + 0.5) / imageSize_.height(), Rows);
  }
  field.band = within((place.distanceMm - nearestMm_) / (furthestMm_ - nearestMm_), Bands);
  return field;
}

int CoverageView::count(const Field& field) const
{
  return counts_.at(indexOf(field));
}

int CoverageView::filledCount() const
{
  return int(std::count_if(counts_.begin(), counts_.end(), [](int count) { return count > 0; }));
}

QRectF CoverageView::fieldRectangle(const Field& field) const
{
  const double line = this->fontMetrics().height();
  const double top = 2 * line + 6;
  const QSizeF shape = imageSize_.isEmpty() ? QSizeF(4, 3) : QSizeF(imageSize_);
  const double below = this->hasWordsBelow() ? 1.5 * line + 8 : 2;
  const QSizeF room((this->width() - (Bands - 1) * Gap - 2) / Bands, this->height() - top - below);
  const QSizeF grid = shape.scaled(room.expandedTo({ 8, 8 }), Qt::KeepAspectRatio);
  const double left = (this->width() - Bands * grid.width() - (Bands - 1) * Gap) / 2 + field.band * (grid.width() + Gap);
  const QSizeF cell(grid.width() / Columns, grid.height() / Rows);
  return { left + field.column * cell.width(), top + field.row * cell.height(), cell.width(), cell.height() };
}

QString CoverageView::describe(const Field& field) const
{
  const QLocale locale;
  const double step = (furthestMm_ - nearestMm_) / Bands;
  const QString depth =
    tr("%1 to %2 mm")
      .arg(locale.toString(nearestMm_ + field.band * step, 'f', 0), locale.toString(nearestMm_ + (field.band + 1) * step, 'f', 0));
  QString where = bandName(field.band) + QStringLiteral(", ") + depth;
  if (!imageSize_.isEmpty())
  {
    const int width = imageSize_.width(), height = imageSize_.height();
    where = tr("x %1 to %2 px, y %3 to %4 px; %5")
              .arg(field.column * width / Columns)
              .arg((field.column + 1) * width / Columns - 1)
              .arg(field.row * height / Rows)
              .arg((field.row + 1) * height / Rows - 1)
              .arg(where);
  }
  const QString samples = counted(this->count(field), tr("1 sample"), tr("%1 samples"));
  const bool isNext = next_ && this->fieldOf(*next_) == field;
  return where + QStringLiteral(": ") + samples + (isNext ? tr(" – hold the ball here next") : QString());
}

void CoverageView::updateAccessibility()
{
  QString text = tr("%1 of %2 fields have a sample.").arg(this->filledCount()).arg(Columns * Rows * Bands);
  if (this->hasFocus())
  {
    text = this->describe(focus_) + QStringLiteral(". ") + text;
  }
  else if (next_)
  {
    text += tr(" Next: %1.").arg(this->describe(this->fieldOf(*next_)));
  }
  this->setAccessibleDescription(text);
}

QSize CoverageView::sizeHint() const
{
  return { 420, 170 };
}

QSize CoverageView::minimumSizeHint() const
{
  return { 240, 104 };
}

/// In a low place the fields are worth more than their count, which the tooltip and the accessible description have.
bool CoverageView::hasWordsBelow() const
{
  return this->height() >= 8 * this->fontMetrics().height();
}

void CoverageView::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  for (int band = 0; band < Bands; ++band)
  {
    this->paintBand(painter, band);
  }
  if (!this->hasWordsBelow())
  {
    return;
  }
  const double line = this->fontMetrics().height();
  const QRectF below(0, this->height() - 1.4 * line, this->width(), 1.4 * line);
  const QString words = this->hasFocus() ? this->describe(focus_)
                                         : tr("%1 of %2 fields have a sample").arg(this->filledCount()).arg(Columns * Rows * Bands);
  painter.setPen(this->palette().color(QPalette::WindowText));
  painter.drawText(below, Qt::AlignCenter, this->fontMetrics().elidedText(words, Qt::ElideRight, this->width()));
}

void CoverageView::paintBand(QPainter& painter, int band) const
{
  const double line = this->fontMetrics().height();
  const QRectF first = this->fieldRectangle({ 0, 0, band });
  const QRectF last = this->fieldRectangle({ Columns - 1, Rows - 1, band });
  const QRectF grid(first.topLeft(), last.bottomRight());
  const double step = (furthestMm_ - nearestMm_) / Bands;
  painter.setPen(this->palette().color(QPalette::WindowText));
  const QRectF title(grid.left() - Gap / 2, grid.top() - 2 * line - 5, grid.width() + Gap, line);
  painter.drawText(title, Qt::AlignCenter, bandName(band));
  const QString range = tr("%1–%2 mm").arg(nearestMm_ + band * step, 0, 'f', 0).arg(nearestMm_ + (band + 1) * step, 0, 'f', 0);
  painter.drawText(title.translated(0, line), Qt::AlignCenter, range);
  const QColor ground = this->palette().color(QPalette::Base);
  const QColor full = levelColor(Level::Good, this->palette());
  // Of the text, not of a role for shadows: those of dark palettes are darker than their ground.
  QColor lines = this->palette().color(QPalette::Text);
  lines.setAlphaF(0.35);
  for (int row = 0; row < Rows; ++row)
  {
    for (int column = 0; column < Columns; ++column)
    {
      const Field field{ column, row, band };
      const int samples = this->count(field);
      const QRectF place = this->fieldRectangle(field);
      painter.fillRect(place, ground);
      if (samples > 0)
      {
        QColor fill = full;
        fill.setAlphaF(std::min(0.55, 0.25 + 0.1 * samples));
        painter.fillRect(place, fill);
      }
      painter.setBrush(Qt::NoBrush);
      painter.setPen(QPen(lines, 1));
      painter.drawRect(place);
      if (samples > 0)
      {
        painter.setPen(this->palette().color(QPalette::Text));
        painter.drawText(place, Qt::AlignCenter, QString::number(samples));
      }
    }
  }
  this->paintMarks(painter, band, grid);
}

/// The next place, where the ball is, and the keyboard's field.
void CoverageView::paintMarks(QPainter& painter, int band, const QRectF& grid) const
{
  if (next_ && this->fieldOf(*next_).band == band)
  {
    const QColor color = seriesColor(1, this->palette());
    const QRectF place = this->fieldRectangle(this->fieldOf(*next_)).adjusted(1, 1, -1, -1);
    painter.setPen(QPen(color, 2.5));
    painter.drawRect(place);
    // A target: to be told from a full field without its colour.
    const double radius = std::min(place.width(), place.height()) / 4;
    painter.setPen(QPen(color, 1.5));
    painter.drawEllipse(place.center(), radius, radius);
    if (this->count(this->fieldOf(*next_)) == 0)
    {
      painter.setBrush(color);
      painter.drawEllipse(place.center(), radius / 3, radius / 3);
    }
  }
  if (current_ && this->fieldOf(*current_).band == band)
  {
    const QPointF share((current_->ball_Image_Px.x() + 0.5) / std::max(1, imageSize_.width()),
      (current_->ball_Image_Px.y() + 0.5) / std::max(1, imageSize_.height()));
    const QPointF at(
      grid.left() + std::clamp(share.x(), 0.0, 1.0) * grid.width(), grid.top() + std::clamp(share.y(), 0.0, 1.0) * grid.height());
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(this->palette().color(QPalette::Base), 4));
    painter.drawEllipse(at, 5, 5);
    painter.setPen(QPen(seriesColor(0, this->palette()), 2));
    painter.drawEllipse(at, 5, 5);
  }
  if (this->hasFocus() && focus_.band == band)
  {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(this->palette().color(QPalette::Highlight), 2, Qt::DotLine));
    painter.drawRect(this->fieldRectangle(focus_).adjusted(2.5, 2.5, -2.5, -2.5));
  }
}

std::optional<CoverageView::Field> CoverageView::fieldAt(const QPointF& point_Widget) const
{
  for (int band = 0; band < Bands; ++band)
  {
    for (int row = 0; row < Rows; ++row)
    {
      for (int column = 0; column < Columns; ++column)
      {
        if (this->fieldRectangle({ column, row, band }).contains(point_Widget))
        {
          return Field{ column, row, band };
        }
      }
    }
  }
  return {};
}

void CoverageView::keyPressEvent(QKeyEvent* event)
{
  // All three bands are one row of twelve columns for the keyboard.
  int column = focus_.band * Columns + focus_.column;
  switch (event->key())
  {
    case Qt::Key_Left:
      --column;
      break;
    case Qt::Key_Right:
      ++column;
      break;
    case Qt::Key_Up:
      --focus_.row;
      break;
    case Qt::Key_Down:
      ++focus_.row;
      break;
    default:
      QWidget::keyPressEvent(event);
      return;
  }
  column = std::clamp(column, 0, Bands * Columns - 1);
  focus_ = { column % Columns, std::clamp(focus_.row, 0, Rows - 1), column / Columns };
  this->updateAccessibility();
  this->update();
}

void CoverageView::focusInEvent(QFocusEvent* event)
{
  QWidget::focusInEvent(event);
  this->updateAccessibility();
  this->update();
}

void CoverageView::focusOutEvent(QFocusEvent* event)
{
  QWidget::focusOutEvent(event);
  this->updateAccessibility();
  this->update();
}

bool CoverageView::event(QEvent* event)
{
  if (event->type() == QEvent::ToolTip)
  {
    const auto* help = static_cast<QHelpEvent*>(event);
    if (const std::optional<Field> field = this->fieldAt(help->pos()))
    {
      QToolTip::showText(help->globalPos(), this->describe(*field), this);
      return true;
    }
    QToolTip::hideText();
    event->ignore();
    return true;
  }
  return QWidget::event(event);
}

}  // namespace handeye
