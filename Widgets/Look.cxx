// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Look.h"

#include <QFile>
#include <QLocale>
#include <QPalette>

#include <algorithm>
#include <cmath>

/// The icons are part of a static library; without this the linker leaves them out. Not in a namespace: rcc's function is not.
static void initializeIcons()
{
  Q_INIT_RESOURCE(HandEyeWidgets);
}

namespace handeye
{

bool isDark(const QPalette& palette)
{
  return qGray(palette.color(QPalette::Window).rgb()) < 128;
}

QColor levelColor(Level level, const QPalette& palette)
{
  const bool dark = isDark(palette);
  switch (level)
  {
    case Level::Good:
      return dark ? QColor(0x5f, 0xd3, 0x8a) : QColor(0x06, 0x74, 0x3a);
    case Level::Warning:
      return dark ? QColor(0xff, 0xca, 0x5c) : QColor(0x85, 0x56, 0x00);
    case Level::Error:
      return dark ? QColor(0xff, 0x8f, 0x85) : QColor(0xb3, 0x26, 0x1e);
    case Level::Info:
      break;
  }
  return palette.color(QPalette::WindowText);
}

QColor seriesColor(int index, const QPalette& palette)
{
  // Okabe and Ito's colours and a grey in the order of report::seriesColor(), darker or lighter by the ground.
  static const QColor onLight[] = { QColor(0x00, 0x5f, 0x9e), QColor(0xc2, 0x4a, 0x00), QColor(0x00, 0x7a, 0x5a),
    QColor(0xa6, 0x3d, 0x80), QColor(0x1c, 0x1c, 0x1c), QColor(0xa8, 0x70, 0x00), QColor(0x2f, 0x8f, 0xc0),
    QColor(0x80, 0x80, 0x80), QColor(0x6b, 0x64, 0x00) };
  static const QColor onDark[] = { QColor(0x56, 0xb4, 0xe9), QColor(0xf5, 0x8a, 0x3c), QColor(0x35, 0xd0, 0xa5),
    QColor(0xe8, 0x9b, 0xc8), QColor(0xf2, 0xf2, 0xf2), QColor(0xff, 0xc4, 0x00), QColor(0x8f, 0x9d, 0xff),
    QColor(0xa0, 0xa0, 0xa0), QColor(0xd8, 0xd0, 0x70) };
  constexpr int count = int(std::size(onLight));
  const int wrapped = ((index % count) + count) % count;
  return isDark(palette) ? onDark[wrapped] : onLight[wrapped];
}

Level errorLevel(double meanPx)
{
  return !std::isfinite(meanPx) ? Level::Info : meanPx < 1 ? Level::Good : meanPx < 3 ? Level::Warning : Level::Error;
}

QIcon icon(const QString& name)
{
  initializeIcons();
  const QString path = QStringLiteral(":/HandEye/Icons/%1.svg").arg(name);
  return QFile::exists(path) ? QIcon(path) : QIcon();
}

QIcon levelIcon(Level level)
{
  switch (level)
  {
    case Level::Good:
      return icon(QStringLiteral("ok"));
    case Level::Warning:
      return icon(QStringLiteral("warning"));
    case Level::Error:
      return icon(QStringLiteral("error"));
    case Level::Info:
      break;
  }
  return icon(QStringLiteral("info"));
}

QColor linkColor(const QPalette& palette)
{
  const auto luminance = [](const QColor& color)
  {
    const auto linear = [](double share) { return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
  };
  const double link = luminance(palette.color(QPalette::Link)), ground = luminance(palette.color(QPalette::Window));
  constexpr double LeastContrast = 4.5;  // of text, after WCAG 2
  return (std::max(link, ground) + 0.05) / (std::min(link, ground) + 0.05) >= LeastContrast ? palette.color(QPalette::Link)
    : isDark(palette)                                                                       ? QColor(0x6c, 0xb6, 0xff)
                                                                                            : QColor(0x1f, 0x5f, 0xa8);
}

QString asSentence(const QString& message)
{
  QString sentence = message.trimmed();
  if (sentence.isEmpty())
  {
    return sentence;
  }
  // The name of a file or a stream stays what it is.
  const QString first = sentence.section(QLatin1Char(' '), 0, 0);
  const auto isOfAName = [](QChar c) { return c.isDigit() || QStringLiteral("./_'").contains(c); };
  if (std::none_of(first.begin(), first.end(), isOfAName))
  {
    sentence[0] = sentence[0].toUpper();
  }
  return QStringLiteral(".!?:…>").contains(sentence.back()) ? sentence : sentence + QLatin1Char('.');
}

QString counted(int count, const QString& one, const QString& many)
{
  return count == 1 ? one : many.arg(count);
}

QString withUnit(double value, int digits, const QString& unit)
{
  if (!std::isfinite(value))
  {
    return QString(QChar(0x2013));
  }
  // A no-break space: the unit stays with its number.
  return QLocale().toString(value, 'f', digits) + QChar(0x00a0) + unit;
}

}  // namespace handeye
