// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StagesView.h"

#include "BallStages.h"
#include "ImageConversion.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr int Gap = 6;

/// The pictures' shape when there are none yet.
QSizeF shapeOf(const QImage& picture)
{
  return picture.isNull() ? QSizeF(4, 3) : QSizeF(picture.size());
}

/// How the pictures are laid out: columns, and the cell of one picture with its caption.
struct Layout
{
  int columns = 4;
  QSizeF picture;  ///< of one picture
};

/// The one of both layouts (four in a row, two by two) that shows the pictures larger.
Layout layoutFor(const QSizeF& area, const QSizeF& shape, int captionHeight)
{
  Layout best;
  for (const int columns : { 4, 2 })
  {
    const int rows = StagesView::Count / columns;
    const QSizeF cell((area.width() - (columns - 1) * Gap) / columns, (area.height() - (rows - 1) * Gap) / rows - captionHeight);
    const QSizeF picture = shape.scaled(cell.expandedTo({ 1, 1 }), Qt::KeepAspectRatio);
    if (picture.width() > best.picture.width())
    {
      best = { columns, picture };
    }
  }
  return best;
}

}  // namespace

StagesView::StagesView(QWidget* parent)
  : QWidget(parent)
{
  this->setAccessibleName(tr("Steps of finding the ball"));
  // As high as there is room: the pictures are there to be looked at, and a low window has other things to show as well.
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void StagesView::setStages(const cv::Mat& image, const BallStages& stages)
{
  const QSize before = pictures_[0].size();
  pictures_ = { toQImage(image), toQImage(stages.mask), toQImage(stages.smoothed), toQImage(stages.outline) };
  if (pictures_[0].size() != before)
  {
    this->updateGeometry();
  }
  this->update();
}

void StagesView::clear()
{
  pictures_ = {};
  this->update();
}

QString StagesView::caption(int index)
{
  switch (index)
  {
    case 0:
      return tr("1  Image");
    case 1:
      return tr("2  Colour");
    case 2:
      return tr("3  Cleaned");
    case 3:
      return tr("4  Outline");
    default:
      return {};
  }
}

QRect StagesView::pictureRectangle(int index) const
{
  if (index < 0 || index >= Count)
  {
    return {};
  }
  const int captionHeight = this->fontMetrics().height() + 4;
  const Layout layout = layoutFor(this->size(), shapeOf(pictures_[0]), captionHeight);
  const int rows = Count / layout.columns;
  const double width = layout.columns * layout.picture.width() + (layout.columns - 1) * Gap;
  const double height = rows * (layout.picture.height() + captionHeight) + (rows - 1) * Gap;
  const QPointF origin((this->width() - width) / 2, std::max(0.0, (this->height() - height) / 2));
  const QPointF offset((index % layout.columns) * (layout.picture.width() + Gap),
    (index / layout.columns) * (layout.picture.height() + captionHeight + Gap));
  return QRectF(origin + offset, layout.picture).toAlignedRect();
}

QSize StagesView::sizeHint() const
{
  return { 480, this->heightForWidth(480) };
}

QSize StagesView::minimumSizeHint() const
{
  return { 200, 100 };
}

int StagesView::heightForWidth(int width) const
{
  // Narrow places get two by two, wide ones a row.
  const int columns = width < 700 ? 2 : 4;
  const int rows = Count / columns;
  const QSizeF shape = shapeOf(pictures_[0]);
  const double pictureWidth = (width - (columns - 1) * Gap) / double(columns);
  const double pictureHeight = pictureWidth * shape.height() / shape.width();
  return int(std::ceil(rows * (pictureHeight + this->fontMetrics().height() + 4) + (rows - 1) * Gap));
}

void StagesView::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  for (int index = 0; index < Count; ++index)
  {
    const QRect place = this->pictureRectangle(index);
    const QImage& picture = pictures_[std::size_t(index)];
    if (picture.isNull())
    {
      painter.setPen(QPen(this->palette().color(QPalette::Disabled, QPalette::WindowText), 1, Qt::DashLine));
      painter.drawRect(QRectF(place).adjusted(0.5, 0.5, -0.5, -0.5));
    }
    else
    {
      // Scaled in device pixels, smoothly also when much smaller.
      const QSize pixels = place.size() * this->devicePixelRatioF();
      QImage scaled = picture.scaled(pixels, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
      scaled.setDevicePixelRatio(this->devicePixelRatioF());
      painter.drawImage(place.topLeft(), scaled);
    }
    painter.setPen(this->palette().color(QPalette::WindowText));
    const QRect text(place.left(), place.bottom() + 2, place.width(), this->fontMetrics().height() + 2);
    painter.drawText(
      text, Qt::AlignLeft | Qt::AlignVCenter, this->fontMetrics().elidedText(caption(index), Qt::ElideRight, text.width()));
  }
}

void StagesView::mousePressEvent(QMouseEvent* event)
{
  if (event->button() != Qt::LeftButton)
  {
    QWidget::mousePressEvent(event);
    return;
  }
  for (int index = 0; index < Count; ++index)
  {
    const QImage& picture = pictures_[std::size_t(index)];
    const QRectF place = this->pictureRectangle(index);
    if (!picture.isNull() && place.contains(event->localPos()))
    {
      const QPointF share(
        (event->localPos().x() - place.left()) / place.width(), (event->localPos().y() - place.top()) / place.height());
      emit imageClicked({ share.x() * picture.width() - 0.5, share.y() * picture.height() - 0.5 });
      return;
    }
  }
}

bool StagesView::event(QEvent* event)
{
  if (event->type() == QEvent::ToolTip)
  {
    static const char* const texts[] = { QT_TR_NOOP("The frame as the camera sends it. Click on the ball to learn its colour."),
      QT_TR_NOOP("How well each pixel suits the ball's colour: white suits."),
      QT_TR_NOOP("The regions that are left when speckle is taken away."),
      QT_TR_NOOP("The outline that was fitted, and where the ball's centre projects (px of the recorded image)") };
    const auto* help = static_cast<QHelpEvent*>(event);
    for (int index = 0; index < Count; ++index)
    {
      if (this->pictureRectangle(index).contains(help->pos()))
      {
        QToolTip::showText(help->globalPos(), tr(texts[index]), this);
        return true;
      }
    }
    QToolTip::hideText();
    event->ignore();
    return true;
  }
  return QWidget::event(event);
}

}  // namespace handeye
