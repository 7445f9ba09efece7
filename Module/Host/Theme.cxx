// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Theme.h"

#include "ThemeStyle.h"

#include <QApplication>
#include <QLabel>
#include <QPalette>
#include <QStyle>
#include <QStyleFactory>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace desktop
{
namespace
{

constexpr double LeastContrast = 4.5;  // of text, after WCAG 2

QPalette darkPalette()
{
  const QColor ground(0x2b, 0x2f, 0x33);
  const QColor text(0xe8, 0xea, 0xec);
  const QColor dimmed(0x8a, 0x90, 0x96);
  QPalette palette(QColor(0x3a, 0x3f, 0x44), ground);
  palette.setColor(QPalette::Base, QColor(0x1f, 0x22, 0x25));
  palette.setColor(QPalette::AlternateBase, QColor(0x26, 0x2a, 0x2d));
  palette.setColor(QPalette::Text, text);
  palette.setColor(QPalette::WindowText, text);
  palette.setColor(QPalette::ButtonText, text);
  palette.setColor(QPalette::BrightText, QColor(0xff, 0x6b, 0x6b));
  palette.setColor(QPalette::ToolTipBase, QColor(0x3a, 0x3f, 0x44));
  palette.setColor(QPalette::ToolTipText, text);
  palette.setColor(QPalette::PlaceholderText, dimmed);
  palette.setColor(QPalette::Link, QColor(0x6c, 0xb6, 0xff));
  palette.setColor(QPalette::LinkVisited, QColor(0xb0, 0x9c, 0xf0));
  palette.setColor(QPalette::Highlight, QColor(0x2f, 0x6f, 0xb3));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  for (const QPalette::ColorRole role : { QPalette::Text, QPalette::WindowText, QPalette::ButtonText, QPalette::HighlightedText })
  {
    palette.setColor(QPalette::Disabled, role, dimmed);
  }
  palette.setColor(QPalette::Disabled, QPalette::Highlight, QColor(0x45, 0x4b, 0x51));
  return palette;
}

QPalette lightPalette()
{
  const QColor text(0x1b, 0x1f, 0x23);
  const QColor dimmed(0x84, 0x8a, 0x90);
  QPalette palette(QColor(0xe6, 0xe8, 0xea), QColor(0xf2, 0xf3, 0xf4));
  palette.setColor(QPalette::Base, Qt::white);
  palette.setColor(QPalette::AlternateBase, QColor(0xf5, 0xf6, 0xf7));
  palette.setColor(QPalette::Text, text);
  palette.setColor(QPalette::WindowText, text);
  palette.setColor(QPalette::ButtonText, text);
  palette.setColor(QPalette::ToolTipBase, QColor(0xff, 0xff, 0xe8));
  palette.setColor(QPalette::ToolTipText, text);
  palette.setColor(QPalette::PlaceholderText, dimmed);
  palette.setColor(QPalette::Link, QColor(0x1f, 0x5f, 0xa8));
  palette.setColor(QPalette::LinkVisited, QColor(0x6a, 0x3f, 0xa0));
  palette.setColor(QPalette::Highlight, QColor(0x2f, 0x6f, 0xb3));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  for (const QPalette::ColorRole role : { QPalette::Text, QPalette::WindowText, QPalette::ButtonText })
  {
    palette.setColor(QPalette::Disabled, role, dimmed);
  }
  return palette;
}

double luminance(const QColor& color)
{
  const auto linear = [](double share) { return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}

/// A rich text has the colour of links that the palette had when the text was set.
void renewLinks()
{
  for (QWidget* const widget : QApplication::allWidgets())
  {
    auto* const label = qobject_cast<QLabel*>(widget);
    if (label && label->text().contains(QLatin1String("<a ")))
    {
      const QString text = label->text();
      label->setText(QString());
      label->setText(text);
    }
  }
}

}  // namespace

QPalette withReadableLinks(const QPalette& palette)
{
  QPalette readable = palette;
  const QPalette own = luminance(palette.color(QPalette::Window)) < 0.18 ? darkPalette() : lightPalette();
  for (const QPalette::ColorRole role : { QPalette::Link, QPalette::LinkVisited })
  {
    for (const QPalette::ColorRole ground : { QPalette::Window, QPalette::Base })
    {
      const double a = luminance(palette.color(role)), b = luminance(palette.color(ground));
      if ((std::max(a, b) + 0.05) / (std::min(a, b) + 0.05) < LeastContrast)
      {
        readable.setColor(role, own.color(role));
      }
    }
  }
  return readable;
}

void applyTheme(Theme theme)
{
  // What the system had before anything was changed.
  static const QString systemStyle = QApplication::style()->objectName();
  static const QPalette systemPalette = QApplication::palette();
  const QString style = theme == Theme::System ? systemStyle : QStringLiteral("Fusion");
  const bool isFusion = style.compare(QLatin1String("Fusion"), Qt::CaseInsensitive) == 0;
  const bool isThere = isFusion ? qobject_cast<ThemeStyle*>(QApplication::style()) != nullptr
                                : QApplication::style()->objectName().compare(style, Qt::CaseInsensitive) == 0;
  if (!isThere)
  {
    QApplication::setStyle(isFusion ? new ThemeStyle : QStyleFactory::create(style));
  }
  const QPalette palette = theme == Theme::System ? withReadableLinks(systemPalette)
    : theme == Theme::Dark                        ? darkPalette()
                                                  : lightPalette();
  QApplication::setPalette(palette);
  QToolTip::setPalette(palette);
  renewLinks();
}

bool isDark()
{
  const QPalette palette = QApplication::palette();
  return palette.color(QPalette::WindowText).lightness() > palette.color(QPalette::Window).lightness();
}

QString themeName(Theme theme)
{
  return theme == Theme::Light ? QStringLiteral("light") : theme == Theme::Dark ? QStringLiteral("dark") : QStringLiteral("system");
}

Theme themeFromName(const QString& name)
{
  for (const Theme theme : { Theme::Light, Theme::Dark })
  {
    if (name == themeName(theme))
    {
      return theme;
    }
  }
  return Theme::System;
}

}  // namespace desktop
