// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Icons.h"

#include <QApplication>
#include <QFile>
#include <QPainter>
#include <QPalette>
#include <QSvgRenderer>

namespace desktop
{
namespace
{

QPixmap renderSvg(const QByteArray& svg, int size)
{
  QPixmap pixmap(size, size);
  pixmap.fill(Qt::transparent);
  QSvgRenderer renderer(svg);
  QPainter painter(&pixmap);
  renderer.render(&painter);
  return pixmap;
}

QByteArray inColor(QByteArray svg, const QColor& color)
{
  return svg.replace("currentColor", color.name().toLatin1());
}

}  // namespace

QIcon icon(const QString& name)
{
  QFile file(QStringLiteral(":/NavigationDesktop/%1.svg").arg(name));
  if (!file.open(QIODevice::ReadOnly))
  {
    return {};
  }
  const QByteArray svg = file.readAll();
  const QPalette palette = QApplication::palette();
  QIcon icon;
  for (const int size : { 16, 20, 24, 32, 48, 64 })
  {
    icon.addPixmap(renderSvg(inColor(svg, palette.color(QPalette::Active, QPalette::ButtonText)), size), QIcon::Normal);
    icon.addPixmap(renderSvg(inColor(svg, palette.color(QPalette::Disabled, QPalette::ButtonText)), size), QIcon::Disabled);
  }
  return icon;
}

QColor streamLightColor(NavigationHost::StreamLight light)
{
  switch (light)
  {
    case NavigationHost::StreamLight::Live:
      return QColor(0x2e, 0xa0, 0x43);
    case NavigationHost::StreamLight::Stale:
      return QColor(0xe0, 0x9b, 0x00);
    case NavigationHost::StreamLight::Lost:
      break;
  }
  return QColor(0xd6, 0x3b, 0x3b);
}

QPixmap streamLightPixmap(NavigationHost::StreamLight light, int size, double devicePixelRatio)
{
  QPixmap pixmap(qRound(size * devicePixelRatio), qRound(size * devicePixelRatio));
  pixmap.setDevicePixelRatio(devicePixelRatio);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor color = streamLightColor(light);
  const QRectF area = QRectF(0, 0, size, size).adjusted(1, 1, -1, -1);
  painter.setPen(QPen(color.darker(140), 1));
  painter.setBrush(color);
  switch (light)
  {
    case NavigationHost::StreamLight::Live:
      painter.drawEllipse(area);
      break;
    case NavigationHost::StreamLight::Stale:
      painter.drawPolygon(QPolygonF({ QPointF(area.center().x(), area.top()), area.bottomRight(), area.bottomLeft() }));
      break;
    case NavigationHost::StreamLight::Lost:
      painter.setPen(QPen(color, size / 5.0, Qt::SolidLine, Qt::RoundCap));
      painter.drawLine(area.adjusted(1, 1, -1, -1).topLeft(), area.adjusted(1, 1, -1, -1).bottomRight());
      painter.drawLine(area.adjusted(1, 1, -1, -1).topRight(), area.adjusted(1, 1, -1, -1).bottomLeft());
      break;
  }
  return pixmap;
}

QIcon levelIcon(NavigationHost::LogLevel level)
{
  if (level == NavigationHost::LogLevel::Info)
  {
    return {};
  }
  const bool isError = level == NavigationHost::LogLevel::Error;
  const auto light = isError ? NavigationHost::StreamLight::Lost : NavigationHost::StreamLight::Stale;
  QIcon icon;
  for (const double ratio : { 1.0, 2.0, 3.0 })
  {
    icon.addPixmap(streamLightPixmap(light, 16, ratio));
  }
  return icon;
}

}  // namespace desktop
