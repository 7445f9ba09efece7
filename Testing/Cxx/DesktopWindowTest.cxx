// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopFixture.h"
#include "Icons.h"
#include "LogWindow.h"
#include "ModuleSelector.h"
#include "NoticeBar.h"
#include "RecentFiles.h"
#include "ShortcutsDialog.h"
#include "ViewArea.h"

#include <vtkRenderer.h>

#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMimeData>
#include <QPushButton>
#include <QTemporaryDir>
#include <QTextBrowser>

#include <QToolButton>

using desktop::DesktopWindow;

namespace
{

void drop(QWidget& window, const QStringList& paths)
{
  QMimeData data;
  QList<QUrl> urls;
  for (const QString& path : paths)
  {
    urls << QUrl::fromLocalFile(path);
  }
  data.setUrls(urls);
  QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window, &enter);
  QVERIFY(enter.isAccepted());
  QVERIFY(window.findChild<QLabel*>("DropHint"));
  QDropEvent event(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window, &event);
  QVERIFY(event.isAccepted());
  QVERIFY(!window.findChild<QLabel*>("DropHint"));
}

}  // namespace

class DesktopWindowTest : public DesktopFixture
{
  Q_OBJECT

private slots:
  void init() { this->setUp(); }
  void cleanup() { this->tearDown(); }

  void panel_IsEnteredAndLeft()
  {
    QVERIFY(this->Window->showModule("Witness"));
    QCOMPARE(calls().mid(3), QStringList({ "widget", "setup of widget with logic", "enter with host" }));
    QLabel* const video = this->Window->findChild<QLabel*>("WitnessVideo");
    QVERIFY(video && video->isVisible());
    QVERIFY(this->Window->showModule("First"));
    QCOMPARE(calls().last(), QString("exit"));
    QVERIFY(!video->isVisible());
    QVERIFY(this->Window->findChild<QLabel*>("NoVideo")->isVisible());
    QVERIFY(this->Window->showModule("Witness"));
    QCOMPARE(calls().mid(6), QStringList({ "exit", "enter with host" }));
    this->Window.reset();
    QCOMPARE(calls().mid(8), QStringList({ "exit", "~widget", "~module" }));
  }

  void selector_GoesBackForwardAndSearches()
  {
    auto* const selector = this->Window->findChild<desktop::ModuleSelector*>();
    QVERIFY(!this->Window->showModule("Nobody"));
    QVERIFY(this->Window->showModule("Witness"));
    QVERIFY(this->Window->showModule("First"));
    QVERIFY(!selector->forwardAction()->isEnabled());
    selector->backAction()->trigger();
    QCOMPARE(selector->currentModule(), QString("Witness"));
    QVERIFY(!selector->backAction()->isEnabled());
    selector->forwardAction()->trigger();
    QCOMPARE(selector->currentModule(), QString("First"));

    auto* const search = selector->findChild<QLineEdit*>("ModuleSearch");
    selector->findAction()->trigger();
    QTRY_VERIFY(search->hasFocus());
    QTest::keyClicks(search, "witn");
    QTest::keyClick(search, Qt::Key_Return);
    QCOMPARE(selector->currentModule(), QString("Witness"));
    QTest::keyClicks(search, "small");  // a category
    QTest::keyClick(search, Qt::Key_Return);
    QCOMPARE(selector->currentModule(), QString("First"));
    QTest::keyClicks(search, "no such thing");
    QTest::keyClick(search, Qt::Key_Return);
    QCOMPARE(selector->currentModule(), QString("First"));
  }

  void selector_HasMenusByCategory()
  {
    auto* const button = this->Window->findChild<QToolButton*>("ModuleButton");
    auto* const tests = button->menu()->findChild<QMenu*>("Tests");
    QVERIFY(tests);
    QCOMPARE(tests->actions().last()->text(), QString("Witness"));
    auto* const small = tests->findChild<QMenu*>("Small");
    QVERIFY(small);
    small->actions().first()->trigger();
    QCOMPARE(this->Window->findChild<desktop::ModuleSelector*>()->currentModule(), QString("First"));
    QCOMPARE(button->text(), QString("First of all"));
  }

  void help_IsTheModules()
  {
    this->Window->showModule("Witness");
    auto* const help = this->Window->findChild<QTextBrowser*>("ModuleHelp");
    QVERIFY(!help->isVisible());
    QTest::mouseClick(this->Window->findChild<QToolButton*>("ModuleHelpButton"), Qt::LeftButton);
    QVERIFY(help->isVisible());
    QVERIFY(help->toPlainText().contains("Helps the tests."));
    QVERIFY(help->toPlainText().contains("A <b>tester</b>"));  // a name is not HTML
  }

  void skippedFiles_AreSaidInTheWindow()
  {
    QFile file(this->Folder->filePath("libqSlicerBrokenModule.so"));
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("nonsense");
    file.close();
    this->open();
    const QString notice = this->Window->findChild<desktop::NoticeBar*>()->text();
    QVERIFY2(notice.contains("libqSlicerBrokenModule.so was skipped: it is not a shared library"), qPrintable(notice));
    QVERIFY(this->Window->findChild<desktop::NoticeBar*>()->isVisible());
    QCOMPARE(this->Window->logModel()->count(NavigationHost::LogLevel::Warning), 1);
    QCOMPARE(this->Window->findChild<QToolButton*>("LogButton")->text(), QString("1 warning"));
    QVERIFY(this->Window->showModule("Witness"));
  }

  void droppedFiles_GoToTheModule()
  {
    const QString good = this->Folder->filePath("a.good");
    const QString bad = this->Folder->filePath("b.bad");
    for (const QString& path : { good, bad })
    {
      QFile file(path);
      QVERIFY(file.open(QIODevice::WriteOnly));
    }
    auto* const notices = this->Window->findChild<desktop::NoticeBar*>();
    drop(*this->Window, { good });
    QTRY_VERIFY(notices->text().contains("no module takes files now"));
    this->Window->showModule("Witness");
    drop(*this->Window, { good, bad });
    QTRY_VERIFY(calls().contains("open " + bad));
    QVERIFY(calls().contains("open " + good));
    QVERIFY2(notices->text().contains("b.bad was not opened: the module could make nothing of it"), qPrintable(notices->text()));
    QCOMPARE(this->Window->findChild<desktop::RecentFiles*>()->paths(), QStringList{ good });
    QVERIFY(!this->Window->openPath(this->Folder->filePath("nothing.good")));
    QVERIFY(notices->text().contains("is not there"));
  }

  void droppedText_IsNotTaken()
  {
    QMimeData data;
    data.setText("https://example.org");
    QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    enter.ignore();
    QApplication::sendEvent(this->Window.get(), &enter);
    QVERIFY(!enter.isAccepted());
  }

  void recentFiles_AreRememberedNewestFirst()
  {
    auto* const recent = this->Window->findChild<desktop::RecentFiles*>();
    for (int i = 0; i < 12; ++i)
    {
      this->Window->addRecentFile(this->Folder->filePath(QString("%1.good").arg(i)));
    }
    this->Window->addRecentFile(this->Folder->filePath("5.good"));
    QCOMPARE(recent->paths().size(), desktop::RecentFiles::maximumCount);
    QCOMPARE(recent->paths()[0], this->Folder->filePath("5.good"));
    QCOMPARE(recent->paths()[1], this->Folder->filePath("11.good"));
    QFile file(this->Folder->filePath("5.good"));
    QVERIFY(file.open(QIODevice::WriteOnly));
    this->open();
    this->Window->showModule("Witness");
    QMenu menu;
    this->Window->findChild<desktop::RecentFiles*>()->attach(&menu);
    QVERIFY(menu.actions()[0]->isEnabled());
    QVERIFY(!menu.actions()[1]->isEnabled());
    QVERIFY(menu.actions()[1]->text().contains("not there any more"));
    menu.actions()[0]->trigger();
    QVERIFY(calls().contains("open " + this->Folder->filePath("5.good")));
    menu.actions().last()->trigger();
    QVERIFY(this->Window->findChild<desktop::RecentFiles*>()->paths().isEmpty());
  }

  void themes_ChangeEverythingAtOnce()
  {
    auto darkness = [this] { return qGray(this->Window->grab().toImage().pixel(this->Window->width() / 2, 3)); };
    double light[3], dark[3];
    this->Window->sceneRenderer()->GetBackground(light);
    const int before = darkness();
    desktop::DesktopSettings settings = this->Window->settings();
    settings.theme = desktop::Theme::Dark;
    this->Window->setSettings(settings);
    QCoreApplication::processEvents();
    QVERIFY(desktop::isDark());
    this->Window->sceneRenderer()->GetBackground(dark);
    QVERIFY(light[0] > 0.5 && dark[0] < 0.3);
    QVERIFY(before > 180 && darkness() < 80);
    this->open();
    QCOMPARE(this->Window->settings().theme, desktop::Theme::Dark);
  }

  void settings_AreRemembered()
  {
    desktop::DesktopSettings settings;
    settings.theme = desktop::Theme::Light;
    settings.moduleFolders = QStringList{ "/some/where" };
    settings.startModule = "First";
    settings.logLevel = 1;
    settings.showSplash = false;
    this->Window->setSettings(settings);
    QCOMPARE(this->Window->findChild<desktop::LogWindow*>()->lowestLevel(), 1);
    this->open();
    const desktop::DesktopSettings found = this->Window->settings();
    QCOMPARE(found.moduleFolders, settings.moduleFolders);
    QCOMPARE(found.startModule, settings.startModule);
    QCOMPARE(found.logLevel, 1);
    QCOMPARE(found.showSplash, false);
    QVERIFY(this->Window->showModule(QString()));
    QCOMPARE(this->Window->findChild<desktop::ModuleSelector*>()->currentModule(), QString("First"));

    desktop::SettingsDialog dialog(found, { { "First", "First of all" }, { "Witness", "Witness" } }, nullptr);
    QCOMPARE(dialog.settings().startModule, QString("First"));
    QCOMPARE(dialog.settings().moduleFolders, settings.moduleFolders);
    dialog.findChild<QComboBox*>("Theme")->setCurrentIndex(2);
    QCOMPARE(dialog.settings().theme, desktop::Theme::Dark);
  }

  void lastModuleAndGeometry_ComeBack()
  {
    this->Window->showModule("Witness");
    this->Window->resize(1111, 777);
    this->Window->setViewLayout(3);
    this->Window->findChild<QDockWidget*>("LogDock")->show();
    QCoreApplication::processEvents();
    this->Window->close();
    this->open();
    this->Window->restoreGeometryOfLastTime();
    this->Window->showModule(QString());
    QCOMPARE(this->Window->size(), QSize(1111, 777));
    QCOMPARE(this->Window->findChild<desktop::ViewArea*>()->layoutKind(), desktop::ViewArea::Stacked);
    QVERIFY(this->Window->findChild<QDockWidget*>("LogDock")->isVisible());
    QCOMPARE(this->Window->findChild<desktop::ModuleSelector*>()->currentModule(), QString("Witness"));
  }

  void shortcuts_AreListedAndEachOnce()
  {
    const auto shortcuts = desktop::ShortcutsDialog::shortcutsOf(this->Window.get());
    QVERIFY(shortcuts.size() >= 14);
    QStringList keys;
    for (const auto& [text, key] : shortcuts)
    {
      QVERIFY2(!text.isEmpty() && !text.contains('&'), qPrintable(text));
      QVERIFY2(!keys.contains(key) || key == "Ctrl+C", qPrintable(key));
      keys << key;
    }
    QVERIFY(keys.contains("Ctrl+L") && keys.contains("F11") && keys.contains("Ctrl+PgUp"));
  }

  void shortcuts_OneLineEach_WhateverTheyWouldDoNow()
  {
    QWidget window;
    QAction redo("&Redo"), redoOfOther("Redo: leave out a sample");
    for (QAction* const action : { &redo, &redoOfOther })
    {
      action->setShortcuts({ QKeySequence(Qt::CTRL + Qt::Key_Y), QKeySequence(Qt::CTRL + Qt::SHIFT + Qt::Key_Z) });
      action->setParent(&window);
    }
    auto* const page = new QWidget(&window);
    page->setProperty("keysAndWhatTheyDo", QStringList{ "Space\tTake a sample" });
    const QVector<QPair<QString, QString>> expected = { { "Redo", "Ctrl+Y or Ctrl+Shift+Z" }, { "Take a sample", "Space" } };
    QCOMPARE(desktop::ShortcutsDialog::shortcutsOf(&window), expected);
    redo.setParent(nullptr);
    redoOfOther.setParent(nullptr);
  }

  void everyButton_SaysWhatItDoes()
  {
    for (const QAbstractButton* const button : this->Window->findChildren<QAbstractButton*>())
    {
      const bool isOurs = !button->objectName().startsWith("qt_") && !qobject_cast<const QDockWidget*>(button->parent());
      const bool hasText = !button->text().isEmpty() || !button->accessibleName().isEmpty();
      const bool isInside =
        QString(button->metaObject()->className()).contains("QLineEdit") || button->parent()->inherits("QTableView");
      QVERIFY2(!isOurs || isInside || hasText || !button->toolTip().isEmpty(), button->metaObject()->className());
    }
  }

  void host_IsFoundByModules()
  {
    QVERIFY(qobject_cast<NavigationHost*>(static_cast<QObject*>(this->Window.get())));
    QCOMPARE(this->Window->settingsGroup("Witness"), QString("Modules/Witness"));
    QVERIFY(!this->Window->isDemonstration());
    this->Window->setDemonstration(true);
    QVERIFY(this->Window->isDemonstration());
  }
};

DESKTOP_TEST_MAIN(DesktopWindowTest)
#include "DesktopWindowTest.moc"
