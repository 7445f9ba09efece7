// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopTestMain.h"
#include "ModuleFile.h"
#include "ModuleLoader.h"
#include "SharedLibraryFile.h"
#include "qSlicerAbstractModuleWidget.h"
#include "qSlicerLoadableModule.h"

#include <QTemporaryDir>

#include <random>
#include <unistd.h>

using desktop::inspectModuleFile;
using desktop::ModuleFile;
using desktop::ModuleLoader;

namespace
{

QString plugin(const QString& name)
{
  return QStringLiteral(HANDEYE_TEST_PLUGINS_DIR "/libqSlicer%1Module.so").arg(name);
}

QByteArray contents(const QString& path)
{
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

void write(const QString& path, const QByteArray& bytes)
{
  QFile file(path);
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(bytes);
}

/// What is printed to the standard output while it lives.
class PrintedText
{
public:
  PrintedText()
    : Former(dup(1))
  {
    fflush(stdout);
    File.open();
    dup2(File.handle(), 1);
  }
  ~PrintedText()
  {
    dup2(Former, 1);
    close(Former);
  }
  QString text()
  {
    fflush(stdout);
    return QString::fromUtf8(contents(File.fileName()));
  }

private:
  QTemporaryFile File;
  int Former;
};

QStringList names(const ModuleLoader& loader)
{
  QStringList names;
  for (const qSlicerLoadableModule* const module : loader.modules())
  {
    names << module->name();
  }
  return names;
}

QString reasonFor(const ModuleLoader& loader, const QString& fileName)
{
  for (const auto& problem : loader.problems())
  {
    if (QFileInfo(problem.path).fileName() == fileName)
    {
      return problem.reason;
    }
  }
  return {};
}

}  // namespace

class DesktopModulesTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    this->Folder = std::make_unique<QTemporaryDir>();
    QVERIFY(this->Folder->isValid());
    qApp->setProperty("calls", QStringList());
    qunsetenv("FOREIGN_PLUGIN_WAS_MADE");
  }

  void module_LoadsAsInSlicer()
  {
    this->take("Witness");
    PrintedText printed;
    ModuleLoader loader;
    loader.load({ this->Folder->path() });
    QCOMPARE(printed.text(), QString("Loading module \"Witness\"\n"));
    QCOMPARE(names(loader), QStringList{ "Witness" });
    QVERIFY(loader.problems().isEmpty());
    qSlicerLoadableModule* const module = loader.module("Witness");
    QVERIFY(module);
    QCOMPARE(module->title(), QString("Witness"));
    QCOMPARE(module->path(), this->file("libqSlicerWitnessModule.so"));
    QVERIFY(module->logic());
    QVERIFY(!loader.module("Other"));
  }

  void life_IsInTheOrderOfTheContract()
  {
    this->take("Witness");
    {
      ModuleLoader loader;
      loader.load({ this->Folder->path() });
      QCOMPARE(calls(), QStringList({ "module", "logic", "setup of module" }));
      QVERIFY(loader.module("Witness")->widgetRepresentation());
      QCOMPARE(loader.module("Witness")->widgetRepresentation(), loader.module("Witness")->widgetRepresentation());
    }
    QCOMPARE(
      calls(), QStringList({ "module", "logic", "setup of module", "widget", "setup of widget with logic", "~module", "~widget" }));
  }

  void brokenOnes_AreReportedAndSkipped()
  {
    for (const char* const name : { "Witness", "Foreign", "Pretender", "Plain", "Incomplete", "Throwing", "Orphan" })
    {
      this->take(name);
    }
    write(this->file("libqSlicerGarbageModule.so"), QByteArray(5000, 'x'));
    write(this->file("libqSlicerEmptyModule.so"), {});
    write(this->file("libqSlicerTextModule.so"), "module = HandEye\n");
    const QByteArray whole = contents(plugin("Witness"));
    write(this->file("libqSlicerHalfModule.so"), whole.left(whole.size() / 2));
    write(this->file("libqSlicerAlmostModule.so"), whole.left(whole.size() - 1));
    write(this->file("libWitness.so"), whole);
    write(this->file("notes.txt"), "not looked at");

    ModuleLoader loader;
    loader.load({ this->Folder->path() });
    QCOMPARE(names(loader), QStringList{ "Witness" });
    const QVector<QPair<QString, QString>> expected = {
      { "libqSlicerForeignModule.so", "plugin of another interface: \"org.example.SomethingElse/2.0\"" },
      { "libqSlicerPretenderModule.so", "does not derive from qSlicerLoadableModule" },
      { "libqSlicerPlainModule.so", "no Qt plugin" },
      { "libqSlicerIncompleteModule.so", "thereIsNoFunctionOfThisName" },
      { "libqSlicerThrowingModule.so", "the moon is in the wrong phase" },
      { "libqSlicerOrphanModule.so", "needs modules that are not here: Nowhere" },
      { "libqSlicerGarbageModule.so", "not a shared library" },
      { "libqSlicerEmptyModule.so", "not a shared library" },
      { "libqSlicerTextModule.so", "not a shared library" },
      { "libqSlicerHalfModule.so", "cut short" },
      { "libqSlicerAlmostModule.so", "cut short" },
      { "libWitness.so", "libqSlicer<Name>Module.so" },
    };
    for (const auto& [name, words] : expected)
    {
      QVERIFY2(reasonFor(loader, name).contains(words), qPrintable(name + ": " + reasonFor(loader, name)));
    }
    QCOMPARE(loader.problems().size(), expected.size());
  }

  void foreignPlugin_IsNeverExecuted()
  {
    this->take("Foreign");
    ModuleLoader loader;
    loader.load({ this->Folder->path() });
    QVERIFY(!qEnvironmentVariableIsSet("FOREIGN_PLUGIN_WAS_MADE"));
    this->take("Pretender");
    loader.load({ this->Folder->path() });
    // The counter-check: the variable would tell.
    QVERIFY(qEnvironmentVariableIsSet("FOREIGN_PLUGIN_WAS_MADE"));
  }

  void everyCut_IsSeenBeforeLoading()
  {
    const QByteArray whole = contents(plugin("Witness"));
    QVERIFY(whole.size() > 10000);
    QVERIFY(desktop::sharedLibraryProblem(plugin("Witness")).isEmpty());
    for (int size = 0; size < whole.size(); size += size < 2000 ? 37 : whole.size() / 40)
    {
      write(this->file("libqSlicerCutModule.so"), whole.left(size));
      const ModuleFile cut = inspectModuleFile(this->file("libqSlicerCutModule.so"));
      QCOMPARE(cut.status, ModuleFile::Status::Damaged);
      QVERIFY(!cut.reason.isEmpty());
    }
  }

  void damagedHeaders_AreLookedAtWithoutHarm()
  {
    const QByteArray whole = contents(plugin("Witness"));
    std::mt19937 random(7);
    int refused = 0;
    for (int round = 0; round < 400; ++round)
    {
      QByteArray damaged = whole;
      for (int i = 0; i < 4; ++i)
      {
        damaged[int(random() % 700)] = char(random());
      }
      write(this->file("libqSlicerDamagedModule.so"), damaged);
      refused += inspectModuleFile(this->file("libqSlicerDamagedModule.so")).isUsable() ? 0 : 1;
    }
    QVERIFY2(refused > 100, qPrintable(QString::number(refused)));
  }

  void dependencies_ComeFirst()
  {
    this->take("First");
    this->take("Needy");
    QFile::rename(this->file("libqSlicerFirstModule.so"), this->file("libqSlicerZModule.so"));
    {
      ModuleLoader alone;
      alone.load({ this->Folder->path() });
      QVERIFY(reasonFor(alone, "libqSlicerNeedyModule.so").contains("First"));
    }
    QFile::rename(this->file("libqSlicerZModule.so"), this->file("libqSlicerFirstModule.so"));
    // By name Needy would come second anyway: from two folders it comes first.
    QTemporaryDir other;
    QFile::rename(this->file("libqSlicerFirstModule.so"), other.filePath("libqSlicerFirstModule.so"));
    ModuleLoader loader;
    loader.load({ this->Folder->path(), other.path() });
    QCOMPARE(names(loader), QStringList({ "First", "Needy" }));
  }

  void sameName_IsTakenOnce()
  {
    this->take("Witness");
    QTemporaryDir other;
    QFile::copy(plugin("Witness"), other.filePath("libqSlicerWitnessModule.so"));
    ModuleLoader loader;
    loader.load({ this->Folder->path(), other.path() });
    QCOMPARE(names(loader), QStringList{ "Witness" });
    QCOMPARE(loader.problems().size(), 1);
    QCOMPARE(loader.problems()[0].path, other.filePath("libqSlicerWitnessModule.so"));
  }

  void sameFileUnderTwoNames_IsTakenOnce()
  {
    this->take("Witness");
    QVERIFY(QFile::link(this->file("libqSlicerWitnessModule.so"), this->file("libqSlicerZebraModule.so")));
    ModuleLoader loader;
    loader.load({ this->Folder->path() });
    QCOMPARE(names(loader), QStringList{ "Witness" });
    QVERIFY(reasonFor(loader, "libqSlicerZebraModule.so").contains("loaded before"));
  }

  void missingFolder_IsReported()
  {
    ModuleLoader loader;
    loader.load({ this->file("nowhere") });
    QCOMPARE(loader.problems().size(), 1);
    QVERIFY(loader.problems()[0].reason.contains("does not exist"));
  }

private:
  QString file(const QString& name) const { return this->Folder->filePath(name); }
  void take(const QString& name) { QVERIFY(QFile::copy(plugin(name), this->file("libqSlicer" + name + "Module.so"))); }
  static QStringList calls() { return qApp->property("calls").toStringList(); }

  std::unique_ptr<QTemporaryDir> Folder;
};

DESKTOP_TEST_MAIN(DesktopModulesTest)
#include "DesktopModulesTest.moc"
