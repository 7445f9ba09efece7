// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ThemeStyle.h"

#include <QPainter>
#include <QStyleOption>

namespace desktop
{

namespace
{

/// Between ground and text; nearer to the ground where the box cannot be used.
QColor frameColor(const QStyleOption& option)
{
  const double share = option.state & QStyle::State_Enabled ? 0.62 : 0.35;
  const QColor ground = option.palette.color(QPalette::Window), text = option.palette.color(QPalette::Active, QPalette::WindowText);
  const auto mixed = [share](int a, int b) { return qRound(a + share * (b - a)); };
  return QColor(mixed(ground.red(), text.red()), mixed(ground.green(), text.green()), mixed(ground.blue(), text.blue()));
}

}  // namespace

ThemeStyle::ThemeStyle()
  : QProxyStyle(QStringLiteral("Fusion"))
{
  this->setObjectName(QStringLiteral("Fusion"));
}

void ThemeStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter, const QWidget* widget) const
{
  QProxyStyle::drawPrimitive(element, option, painter, widget);
  const bool isBox = element == PE_IndicatorCheckBox, isRadio = element == PE_IndicatorRadioButton;
  const bool hasFocusFrame = option && option->state & State_HasFocus && option->state & State_KeyboardFocusChange;
  if ((!isBox && !isRadio) || !option || hasFocusFrame)
  {
    return;
  }
  painter->save();
  painter->setRenderHint(QPainter::Antialiasing);
  painter->setBrush(Qt::NoBrush);
  painter->setPen(frameColor(*option));
  // Where Fusion draws its own.
  const QRect rect = option->rect;
  if (isBox)
  {
    painter->drawRect(QRectF(rect).adjusted(0.5, 0.5, -0.5, -0.5));
  }
  else
  {
    const double radius = (rect.width() + (rect.width() + 1) % 2) / 2.0 - 1;
    painter->drawEllipse(QPointF(rect.center() + QPoint(1, 1)), radius, radius);
  }
  painter->restore();
}

}  // namespace desktop
