// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ApplicationSetup.h"
#include "DesktopOptions.h"
#include "DesktopWindow.h"
#include "ModuleLoader.h"
#include "Theme.h"

#include <QApplication>
#include <QFileInfo>
#include <QPainter>
#include <QSplashScreen>
#include <QTimer>

#include <cstdio>
#include <memory>

namespace
{

using desktop::DesktopOptions;

QString tr(const char* text)
{
  return QCoreApplication::translate("main", text);
}

int refuse(const QString& message)
{
  std::fprintf(stderr, "NavigationDesktop: %s\n", qPrintable(message));
  return 2;
}

// What needs no display; below zero: go on.
int answerWithoutDisplay(int argc, char** argv)
{
  QStringList arguments;
  for (int i = 0; i < argc; ++i)
  {
    arguments << QString::fromLocal8Bit(argv[i]);
  }
  if (arguments.contains(QStringLiteral("--help")) || arguments.contains(QStringLiteral("-h")))
  {
    const QCoreApplication application(argc, argv);
    std::printf("%s", qPrintable(DesktopOptions::help()));
    return 0;
  }
  if (arguments.contains(QStringLiteral("--version")) || arguments.contains(QStringLiteral("-v")))
  {
    std::printf("NavigationDesktop %s\n", qPrintable(desktop::applicationVersion()));
    return 0;
  }
  const bool hasPlatform = arguments.contains(QStringLiteral("-platform")) || qEnvironmentVariableIsSet("QT_QPA_PLATFORM");
  if (!hasPlatform && qEnvironmentVariableIsEmpty("DISPLAY") && qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY"))
  {
    return refuse(
      tr("there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set). Start it on a desktop, or under xvfb-run."));
  }
  return -1;
}

QPixmap splashPicture()
{
  constexpr int width = 420;
  constexpr int height = 220;
  QPixmap picture(width, height);
  picture.fill(QColor(0x22, 0x2b, 0x33));
  QPainter painter(&picture);
  painter.drawPixmap(30, 55, QApplication::windowIcon().pixmap(110, 110));
  painter.setPen(Qt::white);
  QFont font = painter.font();
  font.setPointSizeF(font.pointSizeF() * 1.7);
  painter.setFont(font);
  painter.drawText(QRect(165, 60, 250, 60), Qt::AlignLeft | Qt::AlignVCenter, QStringLiteral("NavigationDesktop"));
  painter.setFont(QFont());
  painter.setPen(QColor(0xb8, 0xc2, 0xcc));
  painter.drawText(
    QRect(165, 112, 250, 40), Qt::AlignLeft | Qt::AlignTop, tr("%1, not a medical device").arg(desktop::applicationVersion()));
  return picture;
}

// After the start: the screenshot, the end. The exit code is 1 if the picture could not be written.
void finishStartup(const DesktopOptions& options, desktop::DesktopWindow& window)
{
  int code = 0;
  if (!options.screenshot.isEmpty() && !window.grab().save(options.screenshot))
  {
    const QString message =
      tr("the screenshot could not be written as %1; expected a file that ends in .png or .jpg in a folder that exists.")
        .arg(options.screenshot);
    std::fprintf(stderr, "NavigationDesktop: %s\n", qPrintable(message));
    code = 1;
  }
  if (options.exitAfterStartup)
  {
    window.close();
    QCoreApplication::exit(code);
  }
}

int run(QApplication& application, const DesktopOptions& options)
{
  const desktop::DesktopSettings settings = desktop::DesktopSettings::load();
  desktop::applyTheme(options.theme.isEmpty() ? settings.theme : desktop::themeFromName(options.theme));
  std::unique_ptr<QSplashScreen> splash;
  if (settings.showSplash && !options.noSplash)
  {
    splash = std::make_unique<QSplashScreen>(splashPicture());
    splash->show();
    application.processEvents();
  }
  desktop::DesktopWindow window;
  window.setDemonstration(options.demonstration);
  if (splash)
  {
    QObject::connect(window.loader(), &desktop::ModuleLoader::loading, splash.get(),
      [&](const QString& name)
      { splash->showMessage(tr("Loading module %1").arg(name), Qt::AlignBottom | Qt::AlignHCenter, Qt::white); });
  }
  window.restoreGeometryOfLastTime();
  if (options.size.isValid())
  {
    window.setWindowState(Qt::WindowNoState);
    window.resize(options.size);
  }
  window.loadModules(desktop::defaultModuleFolders() + options.additionalModulePaths + settings.moduleFolders);
  window.show();
  if (!window.showModule(options.module))
  {
    window.showModule(QString());
  }
  if (splash)
  {
    splash->finish(&window);
  }
  for (const QString& file : options.files)
  {
    window.openPath(file);
  }
  const bool isAwaited = !options.screenshot.isEmpty();
  if (isAwaited || options.exitAfterStartup)
  {
    const int delayMs = isAwaited ? qRound(options.screenshotDelaySec * 1000) : 0;
    QTimer::singleShot(delayMs, &window, [&] { finishStartup(options, window); });
  }
  return application.exec();
}

}  // namespace

int main(int argc, char** argv)
{
  const int answer = answerWithoutDisplay(argc, argv);
  if (answer >= 0)
  {
    return answer;
  }
  desktop::prepareApplication();
  QApplication application(argc, argv);
  desktop::finishApplication();
  const DesktopOptions options = DesktopOptions::parse(application.arguments());
  if (options.checkDisplay)
  {
    return 0;
  }
  if (options.action == DesktopOptions::Action::Refuse)
  {
    return refuse(options.message);
  }
  return run(application, options);
}
