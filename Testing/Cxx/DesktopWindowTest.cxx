// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopWindow.h"
#include "DesktopTestMain.h"
#include "Icons.h"
#include "LogWindow.h"
#include "ModuleSelector.h"
#include "NoticeBar.h"
#include "RecentFiles.h"
#include "SceneView.h"
#include "ShortcutsDialog.h"
#include "StreamLights.h"
#include "ViewArea.h"

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkCubeSource.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include <QClipboard>
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

#include <thread>

using desktop::DesktopWindow;
using Light = NavigationHost::StreamLight;
using Stream = NavigationHost::Stream;

namespace
{

QByteArray contents(const QString& path)
{
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

Stream stream(const QString& name, Light light, double rateHz, double ageSec, const QString& message = {})
{
  Stream result;
  result.name = name;
  result.source = "127.0.0.1:18944";
  result.light = light;
  result.rateHz = rateHz;
  result.ageSec = ageSec;
  result.message = message;
  return result;
}

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

class DesktopWindowTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    QSettings().clear();
    desktop::applyTheme(desktop::Theme::Light);
    qApp->setProperty("calls", QStringList());
    this->Folder = std::make_unique<QTemporaryDir>();
    for (const char* const name : { "Witness", "First" })
    {
      const QString file = QString("libqSlicer%1Module.so").arg(name);
      QVERIFY(QFile::copy(HANDEYE_TEST_PLUGINS_DIR "/" + file, this->Folder->filePath(file)));
    }
    this->open();
  }

  void cleanup()
  {
    this->Window.reset();
    this->Folder.reset();
  }

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

  void lights_SayTheStateInWordsAndForm()
  {
    using desktop::StreamLightWidget;
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Live, 59.8, 0.0123)), QString("60 Hz, 12 ms"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Live, 4.96, -1)), QString("5.0 Hz"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Live, 0, -1)), QString("live"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Stale, 60, 1.24)), QString("stale 1.2 s"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Lost, 0, 75)), QString("lost 75 s"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Lost, 0, -1)), QString("lost"));
    const QString words = StreamLightWidget::description(stream("StylusToTracker", Light::Stale, 0, 1.24, "The tool is hidden."));
    QVERIFY(words.contains("StylusToTracker: stale") && words.contains("127.0.0.1:18944") && words.contains("The tool is hidden."));

    // The forms differ, not the colours alone.
    QVector<QImage> forms;
    for (const Light light : { Light::Live, Light::Stale, Light::Lost })
    {
      const QImage image = desktop::streamLightPixmap(light, 16, 2).toImage();
      QCOMPARE(image.size(), QSize(32, 32));
      forms.append(image.createAlphaMask());
    }
    for (int i = 0; i < 3; ++i)
    {
      int different = 0;
      for (int y = 0; y < 32; ++y)
      {
        for (int x = 0; x < 32; ++x)
        {
          different += forms[i].pixel(x, y) != forms[(i + 1) % 3].pixel(x, y) ? 1 : 0;
        }
      }
      QVERIFY2(different > 100, qPrintable(QString::number(different)));
    }
  }

  void lights_ThatDoNotFitAreCounted()
  {
    auto* const lights = this->Window->findChild<desktop::StreamLights*>();
    QVector<Stream> streams;
    for (int i = 0; i < 20; ++i)
    {
      streams.append(stream(QString("Tool%1ToTracker").arg(i), i == 17 ? Light::Lost : Light::Live, 30, 0.01));
    }
    this->Window->setStreams(streams);
    const auto shown = lights->findChildren<desktop::StreamLightWidget*>();
    QVERIFY(shown.size() >= 3 && shown.size() < 20);
    QVERIFY(lights->sizeHint().width() < this->Window->width());
    const auto& rest = shown.last();
    QVERIFY(rest->toolTip().contains("Tool17ToTracker: lost"));
    QVERIFY(rest->toolTip().startsWith(QString("+%1: lost").arg(20 - (shown.size() - 1))));
    this->Window->setStreams({});
    QVERIFY(lights->findChildren<desktop::StreamLightWidget*>().isEmpty());
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

  void layouts_ShowWhatTheySay()
  {
    auto* const video = this->Window->findChild<desktop::VideoView*>();
    auto* const scene = this->Window->findChild<desktop::SceneView*>();
    const QVector<QPair<bool, bool>> expected = { { true, false }, { false, true }, { true, true }, { true, true } };
    for (int layout = 0; layout < 4; ++layout)
    {
      QTest::keyClick(this->Window.get(), Qt::Key(Qt::Key_1 + layout), Qt::ControlModifier);
      QCoreApplication::processEvents();
      QCOMPARE(video->isVisible(), expected[layout].first);
      QCOMPARE(scene->isVisible(), expected[layout].second);
    }
    QVERIFY(video->mapToGlobal(QPoint()).y() < scene->mapToGlobal(QPoint()).y());
    QVERIFY(qAbs(video->width() - scene->width()) < 3);
  }

  void videoWidget_StaysTheModules()
  {
    auto* const mine = new QLabel("mine");
    QPointer<QLabel> watched = mine;
    this->Window->setVideoWidget(mine);
    QVERIFY(mine->isVisible());
    this->Window.reset();
    QVERIFY(watched);
    delete mine;
    this->open();
    auto* const gone = new QLabel("gone");
    this->Window->setVideoWidget(gone);
    delete gone;
    QCoreApplication::processEvents();
    this->Window->setVideoWidget(nullptr);
    QVERIFY(this->Window->findChild<QLabel*>("NoVideo")->isVisible());
  }

  void scene_DrawsOnceForManyRequests()
  {
    auto* const scene = this->Window->findChild<desktop::SceneView*>();
    QTest::qWait(200);
    const int before = scene->renderCount();
    for (int i = 0; i < 1000; ++i)
    {
      this->Window->requestSceneRender();
    }
    QTRY_VERIFY(scene->renderCount() > before);
    QTest::qWait(100);
    QCOMPARE(scene->renderCount(), before + 1);
  }

  void sceneCamera_ShowsEverythingButNotTheFloorForIt()
  {
    vtkNew<vtkCubeSource> cube;
    cube->SetCenter(2000, 0, 0);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(cube->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkRenderer* const renderer = this->Window->sceneRenderer();
    renderer->AddActor(actor);
    this->Window->resetSceneCamera();
    double focus[3];
    renderer->SetWorldPoint(2000, 0, 0, 1);
    renderer->WorldToView();
    renderer->GetViewPoint(focus);
    QVERIFY(qAbs(focus[0]) < 0.05 && qAbs(focus[1]) < 0.05);  // the near half of a cube looks larger than the far one
    renderer->RemoveActor(actor);
  }

  void sceneCamera_FollowsUntilSomebodyTurnsIt()
  {
    vtkNew<vtkCubeSource> cube;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(cube->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkRenderer* const renderer = this->Window->sceneRenderer();
    renderer->AddActor(actor);
    const auto distanceFrom = [&](double x)
    {
      renderer->SetWorldPoint(x, 0, 0, 1);
      renderer->WorldToView();
      const double* const view = renderer->GetViewPoint();
      return std::max(std::abs(view[0]), std::abs(view[1]));
    };
    auto* const scene = this->Window->findChild<desktop::SceneView*>();
    const auto moveTo = [&](double x)
    {
      const int before = scene->renderCount();
      actor->SetPosition(x, 0, 0);
      this->Window->requestSceneRender();
      QTRY_VERIFY(scene->renderCount() > before);
    };
    moveTo(0);
    moveTo(3000);
    QVERIFY(distanceFrom(3000) < 1);
    auto* const view = scene->findChild<QVTKOpenGLNativeWidget*>();
    QTest::mousePress(view, Qt::LeftButton, Qt::NoModifier, QPoint(100, 100));
    QTest::mouseMove(view, QPoint(110, 100));
    QTest::mouseRelease(view, Qt::LeftButton, Qt::NoModifier, QPoint(110, 100));
    moveTo(90000);
    QVERIFY(distanceFrom(90000) > 1);
    QTest::mouseClick(scene->findChild<QToolButton*>("SceneReset"), Qt::LeftButton);
    QVERIFY(distanceFrom(90000) < 1);
    renderer->RemoveActor(actor);
  }

  void log_FiltersCopiesAndSaves()
  {
    using Level = NavigationHost::LogLevel;
    this->Window->logModel()->clear();
    this->Window->log(Level::Info, "first");
    this->Window->log(Level::Warning, "second");
    this->Window->log(Level::Error, "third");
    qWarning("from Qt");
    std::thread thread([this] { this->Window->logModel()->append(Level::Info, "from a thread"); });
    thread.join();
    QTRY_COMPARE(this->Window->logModel()->rowCount(), 5);
    auto* const log = this->Window->findChild<desktop::LogWindow*>();
    QCOMPARE(log->text().count('\n'), 5);
    log->setLowestLevel(1);
    QCOMPARE(log->text().count('\n'), 3);
    QVERIFY(!log->text().contains("first") && log->text().contains("Warning  second") && log->text().contains("from Qt"));
    log->copy();
    QCOMPARE(QApplication::clipboard()->text(), log->text());
    QVERIFY(log->save(this->Folder->filePath("log.txt")));
    QCOMPARE(QString::fromUtf8(contents(this->Folder->filePath("log.txt"))), log->text());
    QVERIFY(!log->save(this->Folder->filePath("no/such/folder/log.txt")));
    QVERIFY(log->text().contains("could not be saved"));
    QCOMPARE(this->Window->findChild<QToolButton*>("LogButton")->text(), QString("2 errors"));
  }

  void log_DoesNotGrowWithoutEnd()
  {
    this->Window->logModel()->clear();
    this->Window->logModel()->setMaximumCount(100);
    for (int i = 0; i < 250; ++i)
    {
      this->Window->log(NavigationHost::LogLevel::Info, QString::number(i));
    }
    QCOMPARE(this->Window->logModel()->rowCount(), 100);
    QCOMPARE(this->Window->logModel()->index(0, desktop::LogModel::TextColumn).data().toString(), QString("150"));
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

private:
  void open()
  {
    this->Window.reset();
    qApp->setProperty("calls", QStringList());
    this->Window = std::make_unique<DesktopWindow>();
    this->Window->loadModules({ this->Folder->path() });
    this->Window->resize(1280, 800);
    this->Window->show();
    QVERIFY(QTest::qWaitForWindowExposed(this->Window.get()));
    this->Window->activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(this->Window.get()));
  }
  static QStringList calls() { return qApp->property("calls").toStringList(); }

  std::unique_ptr<QTemporaryDir> Folder;
  std::unique_ptr<DesktopWindow> Window;
};

DESKTOP_TEST_MAIN(DesktopWindowTest)
#include "DesktopWindowTest.moc"
