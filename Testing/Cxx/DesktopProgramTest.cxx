// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// NavigationDesktop as it is started, with the module of this project.
#include <QImage>
#include <QProcess>
#include <QTemporaryDir>
#include <QtTest>

namespace
{

struct Run
{
  int code = -1;
  QString output, errors;
};

Run run(const QString& program, const QStringList& arguments, const QProcessEnvironment& environment)
{
  QProcess process;
  process.setProcessEnvironment(environment);
  process.start(program, arguments);
  Run result;
  if (process.waitForFinished(120000) && process.exitStatus() == QProcess::NormalExit)
  {
    result.code = process.exitCode();
  }
  result.output = QString::fromLocal8Bit(process.readAllStandardOutput());
  result.errors = QString::fromLocal8Bit(process.readAllStandardError());
  return result;
}

QByteArray contents(const QString& path)
{
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

}  // namespace

class DesktopProgramTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    this->Environment = QProcessEnvironment::systemEnvironment();
    this->Environment.insert("XDG_CONFIG_HOME", this->Folder.path());
  }

  void helpAndVersion_NeedNoDisplay()
  {
    this->takeDisplayAway();
    const Run help = this->desktop({ "--help" });
    QCOMPARE(help.code, 0);
    for (const char* const option :
      { "--additional-module-paths", "--demo", "--screenshot", "--size", "--no-splash", "--exit-after-startup" })
    {
      QVERIFY2(help.output.contains(option), option);
    }
    const Run version = this->desktop({ "--version" });
    QCOMPARE(version.code, 0);
    QCOMPARE(version.output, QString("NavigationDesktop " HANDEYE_VERSION "\n"));
  }

  void noDisplay_IsSaid()
  {
    this->takeDisplayAway();
    const Run nothing = this->desktop({});
    QCOMPARE(nothing.code, 2);
    QVERIFY2(nothing.errors.contains("there is no display"), qPrintable(nothing.errors));
  }

  void checkDisplay_TellsADisplayFromNone()
  {
    QCOMPARE(this->desktop({ "--check-display" }).code, 0);
    this->takeDisplayAway();
    QCOMPARE(this->desktop({ "--check-display" }).code, 2);
    this->Environment.insert("DISPLAY", ":9999");
    QVERIFY(this->desktop({ "--check-display" }).code != 0);
  }

  void wrongOptions_AreSentences_data()
  {
    QTest::addColumn<QStringList>("arguments");
    QTest::addColumn<QString>("words");
    QTest::newRow("unknown") << QStringList{ "--colour" } << "colour";
    QTest::newRow("size") << QStringList{ "--size", "large" } << "--size large: expected width and height";
    QTest::newRow("small") << QStringList{ "--size", "10x10" } << "from 320x240";
    QTest::newRow("theme") << QStringList{ "--theme", "pink" } << "system, light or dark";
    QTest::newRow("delay") << QStringList{ "--screenshot-delay", "nan" } << "expected seconds";
    QTest::newRow("paths") << QStringList{ "--additional-module-paths", "--demo" } << "expected one or more folders";
  }

  void wrongOptions_AreSentences()
  {
    QFETCH(QStringList, arguments);
    QFETCH(QString, words);
    const Run refused = this->desktop(arguments);
    QCOMPARE(refused.code, 2);
    QVERIFY2(refused.errors.contains(words), qPrintable(refused.errors));
  }

  void module_IsLoadedFromTheFolderOfTheProgram()
  {
    const Run started = this->desktop({ "--exit-after-startup", "--no-splash" });
    QCOMPARE(started.code, 0);
    QVERIFY2(started.output.contains("Loading module \"HandEyeCalibration\"\n"), qPrintable(started.output));
    QVERIFY2(!started.errors.contains("Skipped"), qPrintable(started.errors));
  }

  void additionalFolders_AreManyAndBrokenOnesDoNotStopIt()
  {
    QTemporaryDir first, second;
    QVERIFY(QFile::copy(HANDEYE_TEST_PLUGINS_DIR "/libqSlicerWitnessModule.so", first.filePath("libqSlicerWitnessModule.so")));
    QVERIFY(QFile::copy(HANDEYE_TEST_PLUGINS_DIR "/libqSlicerFirstModule.so", second.filePath("libqSlicerFirstModule.so")));
    QVERIFY(QFile::copy(HANDEYE_TEST_PLUGINS_DIR "/libqSlicerForeignModule.so", second.filePath("libqSlicerForeignModule.so")));
    const QString picture = first.filePath("desktop.png");
    const Run started = this->desktop({ "--no-splash", "--additional-module-paths", first.path(), second.path(),
      first.filePath("nowhere"), "--module", "First", "--size", "900x600", "--screenshot", picture, "--exit-after-startup" });
    QCOMPARE(started.code, 0);
    for (const char* const name : { "HandEyeCalibration", "Witness", "First" })
    {
      QVERIFY2(started.output.contains(QString("Loading module \"%1\"\n").arg(name)), qPrintable(started.output));
    }
    QVERIFY(!started.output.contains("Foreign"));
    QCOMPARE(QImage(picture).size(), QSize(900, 600));
  }

  void fineScreens_GetAllTheirPixels()
  {
    this->Environment.insert("QT_SCALE_FACTOR", "2");
    const QString picture = this->Folder.filePath("fine.png");
    const Run started = this->desktop({ "--no-splash", "--size", "1200x700", "--screenshot", picture, "--exit-after-startup" });
    QCOMPARE(started.code, 0);
    QCOMPARE(QImage(picture).size(), QSize(2400, 1400));
  }

  void screenshotThatCannotBeWritten_IsAnError()
  {
    const Run started =
      this->desktop({ "--no-splash", "--screenshot", "/no/such/folder/a.png", "--screenshot-delay", "0", "--exit-after-startup" });
    QCOMPARE(started.code, 1);
    QVERIFY2(started.errors.contains("/no/such/folder/a.png"), qPrintable(started.errors));
  }

  // The desktop knows nothing of what a module does: neither its sources nor the program.
  void desktop_KnowsNothingOfTheModule()
  {
    const QDir sources(HANDEYE_SOURCE_DIR "/Module/Host");
    const QStringList files = sources.entryList({ "*.h", "*.cxx" }, QDir::Files);
    QVERIFY(files.size() > 40);
    static const QRegularExpression ours("hand.?eye", QRegularExpression::CaseInsensitiveOption);
    for (const QString& name : files)
    {
      for (QString line : QString::fromUtf8(contents(sources.filePath(name))).split('\n'))
      {
        line.remove("lib/handeye/modules").remove("/handeye/modules").remove("HandEyeCalibration contributors");
        QVERIFY2(!ours.match(line).hasMatch(), qPrintable(name + ": " + line));
      }
    }
    const QByteArray program = contents(HANDEYE_DESKTOP);
    QVERIFY(program.contains("qSlicerLoadableModule"));
    for (const char* const word : { "markerToCamera", "vtkSlicerHandEyeCalibrationLogic", "HandEyeCalibrationPanel", "opencv" })
    {
      QVERIFY2(!program.contains(word), word);
    }
    QVERIFY(contents(HANDEYE_MODULE).contains("vtkSlicerHandEyeCalibrationLogic"));
  }

  // The base classes are in one place: the plugin and the program must mean the same meta-objects.
  void plugin_DefinesNothingOfTheBase()
  {
    const Run symbols = run("nm", { "-DC", "--defined-only", HANDEYE_MODULE }, this->Environment);
    QCOMPARE(symbols.code, 0);
    QVERIFY(symbols.output.contains("qt_plugin_instance"));
    QVERIFY(!symbols.output.contains(" qSlicerLoadableModule::staticMetaObject"));
    QVERIFY(!symbols.output.contains("vtkSlicerModuleLogic::New"));
    QVERIFY(!symbols.output.contains("OSMesa"));
    const Run missing = run("ldd", { "-r", HANDEYE_MODULE }, this->Environment);
    QVERIFY2(!missing.output.contains("undefined symbol") && !missing.errors.contains("undefined symbol"),
      qPrintable(missing.output + missing.errors));
  }

private:
  Run desktop(const QStringList& arguments) const { return run(HANDEYE_DESKTOP, arguments, this->Environment); }
  void takeDisplayAway()
  {
    for (const char* const name : { "DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM" })
    {
      this->Environment.remove(name);
    }
  }

  QTemporaryDir Folder;
  QProcessEnvironment Environment;
};

QTEST_MAIN(DesktopProgramTest)
#include "DesktopProgramTest.moc"
