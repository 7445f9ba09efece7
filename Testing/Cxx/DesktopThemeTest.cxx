// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopTestMain.h"
#include "Theme.h"

#include <QCheckBox>
#include <QLabel>
#include <QRadioButton>
#include <QStyle>
#include <QStyleOptionButton>

#include <algorithm>
#include <cmath>

using desktop::Theme;

namespace
{

double luminance(const QColor& color)
{
  const auto linear = [](double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}

/// WCAG's contrast, 1 to 21.
double contrast(const QColor& first, const QColor& second)
{
  const double a = luminance(first), b = luminance(second);
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

/// The largest contrast with the ground on a line through the middle of a button's indicator, at its left edge.
double edgeContrast(QAbstractButton& button, QStyle::SubElement element)
{
  button.adjustSize();
  QStyleOptionButton option;
  option.initFrom(&button);
  const QRect box = button.style()->subElementRect(element, &option, &button);
  const QImage picture = button.grab().toImage();
  double largest = 0;
  for (int x = box.left(); x < box.left() + 3; ++x)
  {
    largest = std::max(largest, contrast(picture.pixelColor(x, box.center().y()), button.palette().color(QPalette::Window)));
  }
  return largest;
}

/// The pixel of a label that is furthest from its ground.
double textContrast(QLabel& label)
{
  const QImage picture = label.grab().toImage();
  double largest = 0;
  for (int y = 0; y < picture.height(); ++y)
  {
    for (int x = 0; x < picture.width(); ++x)
    {
      largest = std::max(largest, contrast(picture.pixelColor(x, y), label.palette().color(QPalette::Window)));
    }
  }
  return largest;
}

}  // namespace

class DesktopThemeTest : public QObject
{
  Q_OBJECT

private slots:
  void everyBox_IsToldFromTheGround()
  {
    for (const Theme theme : { Theme::Dark, Theme::Light })
    {
      desktop::applyTheme(theme);
      QCheckBox box("Hands-free");
      QRadioButton radio("Recording");
      for (QAbstractButton* button : std::initializer_list<QAbstractButton*>{ &box, &radio })
      {
        const auto element = button == &box ? QStyle::SE_CheckBoxIndicator : QStyle::SE_RadioButtonIndicator;
        button->setAutoExclusive(false);
        for (const bool isOn : { false, true })
        {
          button->setChecked(isOn);
          // WCAG asks for 3:1 of what can be operated.
          const double found = edgeContrast(*button, element);
          QVERIFY2(found >= 3, qPrintable(QString("%1 %2: %3").arg(desktop::themeName(theme), button->text()).arg(found)));
        }
      }
    }
  }

  void links_AreReadable_AlsoThoseOfBeforeTheChange()
  {
    desktop::applyTheme(Theme::Light);
    QLabel label("<a href=\"https://example.org\">report.html</a>");
    for (const Theme theme : { Theme::Dark, Theme::Light, Theme::Dark })
    {
      desktop::applyTheme(theme);
      QCoreApplication::processEvents();
      const double found = textContrast(label);
      QVERIFY2(found >= 4, qPrintable(QString("%1: %2").arg(desktop::themeName(theme)).arg(found)));
    }
  }

  void darkPaletteOfTheSystem_GetsReadableLinks_AndALightOneKeepsItsOwn()
  {
    QPalette dark(QColor(0x30, 0x30, 0x30));
    dark.setColor(QPalette::Link, Qt::blue);
    dark.setColor(QPalette::Base, Qt::black);
    const QPalette readable = desktop::withReadableLinks(dark);
    for (const QPalette::ColorRole ground : { QPalette::Window, QPalette::Base })
    {
      QVERIFY(contrast(readable.color(QPalette::Link), readable.color(ground)) >= 4.5);
    }
    QCOMPARE(readable.color(QPalette::Window), dark.color(QPalette::Window));
    QPalette light(QColor(0xf0, 0xf0, 0xf0));
    light.setColor(QPalette::Link, Qt::darkBlue);
    QCOMPARE(desktop::withReadableLinks(light).color(QPalette::Link), QColor(Qt::darkBlue));
  }

  void system_IsWhatItWas()
  {
    desktop::applyTheme(Theme::Dark);
    QVERIFY(desktop::isDark());
    desktop::applyTheme(Theme::System);
    QVERIFY(!desktop::isDark());
  }
};

DESKTOP_TEST_MAIN(DesktopThemeTest)
#include "DesktopThemeTest.moc"
