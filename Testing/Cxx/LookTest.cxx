// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Look.h"

#include "ImageConversion.h"
#include "WidgetTestSupport.h"

#include <QDir>
#include <QFile>
#include <opencv2/core.hpp>

#include <limits>
#include <stdexcept>

using namespace handeye;
using testing_widgets::contrast;

class LookTest : public QObject
{
  Q_OBJECT

private slots:
  void EveryIconFile_IsInTheProgram()
  {
    const QStringList files = QDir(QStringLiteral(HANDEYE_RESOURCES_DIR "/Icons")).entryList({ QStringLiteral("*.svg") });
    QVERIFY(files.size() > 25);
    for (const QString& file : files)
    {
      QVERIFY2(!icon(file.chopped(4)).isNull(), qPrintable(file));
    }
    QVERIFY(icon(QStringLiteral("no such icon")).isNull());
  }

  void EveryIcon_IsSeenOnLightAndOnDark()
  {
    const QStringList files = QDir(QStringLiteral(HANDEYE_RESOURCES_DIR "/Icons")).entryList({ QStringLiteral("*.svg") });
    for (const QString& file : files)
    {
      const QImage image = icon(file.chopped(4)).pixmap(48, 48).toImage().convertToFormat(QImage::Format_ARGB32);
      for (const QColor& ground : { QColor(Qt::white), QColor(0xef, 0xef, 0xef), QColor(0x2b, 0x2d, 0x30) })
      {
        int drawn = 0, seen = 0;
        for (int y = 0; y < image.height(); ++y)
        {
          for (int x = 0; x < image.width(); ++x)
          {
            const QColor color = image.pixelColor(x, y);
            drawn += color.alpha() > 200;
            // WCAG asks for 3:1 of graphics; the gradients of anti-aliasing are left out.
            seen += color.alpha() > 200 && contrast(color, ground) >= 2.7;
          }
        }
        QVERIFY2(drawn > 60, qPrintable(file));
        QVERIFY2(
          seen > 0.5 * drawn, qPrintable(QStringLiteral("%1 on %2: %3 of %4").arg(file, ground.name()).arg(seen).arg(drawn)));
      }
    }
  }

  void Links_AreReadableOnEveryGround()
  {
    QPalette dark = testing_widgets::darkPalette();
    QVERIFY(linkColor(dark) == dark.color(QPalette::Link));
    dark.setColor(QPalette::Link, Qt::blue);
    QPalette light = testing_widgets::lightPalette();
    light.setColor(QPalette::Link, Qt::yellow);
    for (const QPalette& palette : { dark, light })
    {
      QVERIFY(contrast(linkColor(palette), palette.color(QPalette::Window)) >= 4.5);
    }
  }

  void AClause_BecomesASentence_AndNamesStayAsTheyAre()
  {
    QCOMPARE(asSentence(QStringLiteral("hold the ball still")), QStringLiteral("Hold the ball still."));
    QCOMPARE(asSentence(QStringLiteral("Load a model.")), QStringLiteral("Load a model."));
    QCOMPARE(asSentence(QStringLiteral("is that so?")), QStringLiteral("Is that so?"));
    QCOMPARE(asSentence(QStringLiteral("stylus.json: no tip")), QStringLiteral("stylus.json: no tip."));
    QCOMPARE(asSentence({}), QString());
  }

  void LevelsAndSeries_HaveContrastInBothPalettes()
  {
    for (const QPalette& palette : { testing_widgets::lightPalette(), testing_widgets::darkPalette() })
    {
      for (const Level level : { Level::Info, Level::Good, Level::Warning, Level::Error })
      {
        QVERIFY(contrast(levelColor(level, palette), palette.color(QPalette::Window)) >= 4.5);
      }
      QSet<QRgb> colors;
      for (int index = 0; index < 9; ++index)
      {
        QVERIFY(contrast(seriesColor(index, palette), palette.color(QPalette::Base)) >= 3);
        colors.insert(seriesColor(index, palette).rgb());
      }
      QCOMPARE(colors.size(), 9);
      QCOMPARE(seriesColor(9, palette), seriesColor(0, palette));
    }
  }

  void LevelIcons_DifferInShape()
  {
    // Alpha alone, so that colours do not count.
    QList<QImage> shapes;
    for (const Level level : { Level::Good, Level::Warning, Level::Error })
    {
      shapes += levelIcon(level).pixmap(32, 32).toImage().convertToFormat(QImage::Format_Alpha8);
    }
    QVERIFY(shapes[0] != shapes[1] && shapes[1] != shapes[2] && shapes[0] != shapes[2]);
  }

  void Numbers_KeepTheirUnitAndSayWhenThereIsNone()
  {
    QCOMPARE(withUnit(0.4251, 2, QStringLiteral("px")), QStringLiteral("0.43\u00a0px"));
    QCOMPARE(withUnit(std::numeric_limits<double>::infinity(), 2, QStringLiteral("px")), QStringLiteral("\u2013"));
    QCOMPARE(counted(1, QStringLiteral("1 sample"), QStringLiteral("%1 samples")), QStringLiteral("1 sample"));
    QCOMPARE(counted(0, QStringLiteral("1 sample"), QStringLiteral("%1 samples")), QStringLiteral("0 samples"));
  }

  void Pictures_KeepTheirColours()
  {
    cv::Mat bgr(2, 3, CV_8UC3, cv::Scalar(10, 20, 30));
    QCOMPARE(toQImage(bgr).pixelColor(2, 1), QColor(30, 20, 10));
    // A part of a picture has a stride.
    cv::Mat wide(4, 9, CV_8UC3, cv::Scalar(0, 0, 255));
    wide(cv::Rect(2, 1, 3, 2)).setTo(cv::Scalar(255, 0, 0));
    QCOMPARE(toQImage(wide(cv::Rect(2, 1, 3, 2))).pixelColor(2, 1), QColor(0, 0, 255));
    QCOMPARE(toQImage(cv::Mat(2, 2, CV_16UC1, cv::Scalar(257 * 77))).pixelColor(1, 1), QColor(77, 77, 77));
    QVERIFY(toQImage(cv::Mat()).isNull());
    QVERIFY_EXCEPTION_THROWN((void)toQImage(cv::Mat(2, 2, CV_32FC1)), std::invalid_argument);
  }
};

HANDEYE_WIDGET_TEST_MAIN(LookTest)
#include "LookTest.moc"
