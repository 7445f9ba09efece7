// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QApplication>
#include <QImage>
#include <QPalette>
#include <QStyle>
#include <QSurfaceFormat>
#include <QTest>
#include <QVTKOpenGLNativeWidget.h>

#include <algorithm>
#include <cmath>

/// main() of a test of widgets with OpenGL in them: like QTEST_MAIN, but with VTK's surface format, which has to be set first.
#define HANDEYE_WIDGET_TEST_MAIN(TestClass)                                                                                        \
  int main(int argc, char** argv)                                                                                                  \
  {                                                                                                                                \
    QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());                                                     \
    QApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);                                                                          \
    QApplication application(argc, argv);                                                                                          \
    QApplication::setStyle(QStringLiteral("Fusion"));                                                                              \
    TestClass test;                                                                                                                \
    return QTest::qExec(&test, argc, argv);                                                                                        \
  }

namespace testing_widgets
{

/// Light text on a dark ground, as desktops have it.
inline QPalette darkPalette()
{
  QPalette palette;
  const QColor window(0x2b, 0x2d, 0x30), base(0x1f, 0x20, 0x23), text(0xe6, 0xe6, 0xe6), dim(0x8a, 0x8d, 0x92);
  palette.setColor(QPalette::Window, window);
  palette.setColor(QPalette::WindowText, text);
  palette.setColor(QPalette::Base, base);
  palette.setColor(QPalette::AlternateBase, QColor(0x26, 0x28, 0x2b));
  palette.setColor(QPalette::Text, text);
  palette.setColor(QPalette::Button, QColor(0x3a, 0x3c, 0x40));
  palette.setColor(QPalette::ButtonText, text);
  palette.setColor(QPalette::BrightText, Qt::white);
  palette.setColor(QPalette::ToolTipBase, base);
  palette.setColor(QPalette::ToolTipText, text);
  palette.setColor(QPalette::Highlight, QColor(0x2f, 0x6f, 0xb5));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::Link, QColor(0x7f, 0xb5, 0xff));
  palette.setColor(QPalette::Mid, QColor(0x5a, 0x5d, 0x63));
  palette.setColor(QPalette::Dark, QColor(0x18, 0x19, 0x1b));
  palette.setColor(QPalette::Light, QColor(0x4a, 0x4d, 0x52));
  palette.setColor(QPalette::Midlight, QColor(0x42, 0x44, 0x48));
  for (const QPalette::ColorRole role : { QPalette::WindowText, QPalette::Text, QPalette::ButtonText })
  {
    palette.setColor(QPalette::Disabled, role, dim);
  }
  return palette;
}

inline QPalette lightPalette()
{
  return QApplication::style()->standardPalette();
}

/// WCAG's relative luminance.
inline double luminance(const QColor& color)
{
  const auto linear = [](double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}

/// WCAG's contrast, 1 to 21.
inline double contrast(const QColor& first, const QColor& second)
{
  const double a = luminance(first), b = luminance(second);
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

/// Shows a widget of this size and waits until it is painted.
inline void show(QWidget& widget, const QSize& size)
{
  widget.resize(size);
  widget.show();
  // There is no window manager in the test's X server: nobody else gives the window the keyboard.
  widget.activateWindow();
  QVERIFY(QTest::qWaitForWindowExposed(&widget));
  QTest::qWait(50);
}

}  // namespace testing_widgets
