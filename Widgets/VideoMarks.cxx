// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoMarks.h"

#include <QPainter>
#include <QPainterPath>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// Marks lie on video, which may be of any brightness: bright colours with a dark rim, whatever the palette.
QColor markColor(Level level)
{
  switch (level)
  {
    case Level::Good:
      return QColor(0x4c, 0xf0, 0x8c);
    case Level::Warning:
      return QColor(0xff, 0xc8, 0x3d);
    case Level::Error:
      return QColor(0xff, 0x6f, 0x61);
    case Level::Info:
      break;
  }
  return QColor(0x6c, 0xc5, 0xff);
}

const QColor Rim(0, 0, 0, 190);
const QColor Panel(18, 20, 24, 215);

void strokeTwice(QPainter& painter, const QPainterPath& path, const QColor& color, qreal width, Qt::PenStyle style = Qt::SolidLine)
{
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(Rim, width + 2, Qt::SolidLine, Qt::FlatCap, Qt::RoundJoin));
  painter.drawPath(path);
  painter.setPen(QPen(color, width, style, Qt::FlatCap, Qt::RoundJoin));
  painter.drawPath(path);
}

QPainterPath closed(const QPolygonF& line)
{
  QPainterPath path;
  path.addPolygon(line);
  path.closeSubpath();
  return path;
}

}  // namespace

VideoMarks::VideoMarks(const Mapping& imageToWidget, QWidget* parent)
  : QWidget(parent)
  , imageToWidget_(imageToWidget)
{
  this->setAttribute(Qt::WA_TransparentForMouseEvents);
  this->setAttribute(Qt::WA_NoSystemBackground);
  this->setFocusPolicy(Qt::NoFocus);
}

void VideoMarks::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  this->draw(painter);
}

void VideoMarks::draw(QPainter& painter) const
{
  painter.setRenderHint(QPainter::Antialiasing);
  if (this->frameSize.isEmpty())
  {
    this->drawPlaceholder(painter);
  }
  else
  {
    painter.save();
    painter.setClipRect(this->pictureRectangle());
    this->drawGhost(painter);
    this->drawDetection(painter);
    painter.restore();
    this->drawFlash(painter);
  }
  this->drawBanner(painter);
}

QPolygonF VideoMarks::mapped(const QPolygonF& line_Image_Px) const
{
  QPolygonF line;
  line.reserve(line_Image_Px.size());
  for (const QPointF& point_Image_Px : line_Image_Px)
  {
    if (const std::optional<QPointF> point = imageToWidget_(point_Image_Px))
    {
      line.append(*point);
    }
  }
  return line;
}

QRectF VideoMarks::pictureRectangle() const
{
  const std::optional<QPointF> first = imageToWidget_({ -0.5, -0.5 });
  const std::optional<QPointF> last = imageToWidget_({ this->frameSize.width() - 0.5, this->frameSize.height() - 0.5 });
  return first && last ? QRectF(*first, *last) : QRectF(this->rect());
}

void VideoMarks::drawPlaceholder(QPainter& painter) const
{
  painter.fillRect(this->rect(), this->palette().color(QPalette::Window));
  QFont font = this->font();
  font.setPointSizeF(font.pointSizeF() * 1.3);
  painter.setFont(font);
  painter.setPen(this->palette().color(QPalette::WindowText));
  painter.drawText(this->rect().adjusted(16, 16, -16, -16), Qt::AlignCenter | Qt::TextWordWrap, this->placeholder);
}

void VideoMarks::drawGhost(QPainter& painter) const
{
  if (!this->ghost)
  {
    return;
  }
  const QPolygonF line = this->mapped(this->ghost->outline_Image_Px);
  if (line.size() < 3)
  {
    return;
  }
  const QColor color = markColor(this->ghost->level);
  QColor fill = color;
  fill.setAlpha(56);
  painter.setPen(Qt::NoPen);
  painter.setBrush(fill);
  painter.drawPath(closed(line));
  strokeTwice(painter, closed(line), color, 2.5, this->ghost->level == Level::Good ? Qt::SolidLine : Qt::DashLine);
  if (!this->ghost->hint.isEmpty())
  {
    const QRectF box = line.boundingRect();
    this->drawLabel(painter, { box.center().x(), box.bottom() + 6 }, this->ghost->hint, color);
  }
}

void VideoMarks::drawDetection(QPainter& painter) const
{
  if (!this->detection)
  {
    return;
  }
  const QColor color = markColor(this->detection->level);
  const Qt::PenStyle style = this->detection->level == Level::Good ? Qt::SolidLine : Qt::DashLine;
  const QPolygonF line = this->mapped(this->detection->outline_Image_Px);
  QRectF box;
  if (line.size() >= 3)
  {
    strokeTwice(painter, closed(line), color, 2, style);
    box = line.boundingRect();
  }
  if (this->detection->ball_Image_Px)
  {
    if (const std::optional<QPointF> center = imageToWidget_(*this->detection->ball_Image_Px))
    {
      QPainterPath cross;
      cross.moveTo(*center - QPointF(9, 0));
      cross.lineTo(*center + QPointF(9, 0));
      cross.moveTo(*center - QPointF(0, 9));
      cross.lineTo(*center + QPointF(0, 9));
      strokeTwice(painter, cross, color, 1.5);
      box = box.united(QRectF(*center - QPointF(9, 9), QSizeF(18, 18)));
    }
  }
  if (!this->detection->text.isEmpty() && !box.isNull())
  {
    const qreal height = this->fontMetrics().height() + 8;
    // Above the ball: the ghost's hint is below.
    this->drawLabel(painter, { box.center().x(), box.top() - 6 - height }, this->detection->text, color);
  }
}

void VideoMarks::drawLabel(QPainter& painter, const QPointF& anchor, const QString& text, const QColor& color) const
{
  const QRectF limits = this->pictureRectangle().intersected(QRectF(this->rect())).adjusted(4, 4, -4, -4);
  const QFontMetricsF metrics(this->font());
  const QRectF wanted =
    metrics.boundingRect(QRectF(0, 0, std::max(40.0, limits.width() - 16), 1e4), Qt::TextWordWrap | Qt::AlignHCenter, text);
  QRectF panel(0, 0, wanted.width() + 16, wanted.height() + 8);
  panel.moveTo(anchor.x() - panel.width() / 2, anchor.y());
  panel.moveLeft(std::max(limits.left(), std::min(panel.left(), limits.right() - panel.width())));
  panel.moveTop(std::max(limits.top(), std::min(panel.top(), limits.bottom() - panel.height())));
  painter.setPen(Qt::NoPen);
  painter.setBrush(Panel);
  painter.drawRoundedRect(panel, 5, 5);
  painter.setPen(color);
  painter.setFont(this->font());
  painter.drawText(panel, Qt::AlignCenter | Qt::TextWordWrap, text);
}

void VideoMarks::drawBanner(QPainter& painter) const
{
  if (this->banner.isEmpty())
  {
    return;
  }
  QFont font = this->font();
  font.setPointSizeF(font.pointSizeF() * 1.2);
  font.setBold(true);
  const QFontMetricsF metrics(font);
  const qreal iconSize = metrics.height();
  const qreal widest = std::max(60.0, this->width() - 24 - iconSize - 28);
  const QRectF text = metrics.boundingRect(QRectF(0, 0, widest, 1e4), Qt::TextWordWrap | Qt::AlignLeft, this->banner);
  QRectF panel(0, 0, std::ceil(text.width()) + iconSize + 30, std::ceil(std::max(text.height(), iconSize)) + 14);
  panel.moveTo((this->width() - panel.width()) / 2, 10);
  painter.setPen(QPen(markColor(this->bannerLevel), 1.5));
  painter.setBrush(Panel);
  painter.drawRoundedRect(panel, 7, 7);
  const QRectF place(panel.left() + 10, panel.top() + 7, iconSize, iconSize);
  levelIcon(this->bannerLevel).paint(&painter, place.toRect());
  painter.setFont(font);
  painter.setPen(Qt::white);
  painter.drawText(panel.adjusted(iconSize + 18, 7, -10, -7), Qt::AlignLeft | Qt::AlignVCenter | Qt::TextWordWrap, this->banner);
}

void VideoMarks::drawFlash(QPainter& painter) const
{
  if (this->flash <= 0)
  {
    return;
  }
  QColor color = markColor(Level::Good);
  color.setAlphaF(std::min(1.0, this->flash));
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(color, 8, Qt::SolidLine, Qt::SquareCap, Qt::MiterJoin));
  painter.drawRect(this->pictureRectangle().adjusted(4, 4, -4, -4));
}

}  // namespace handeye
