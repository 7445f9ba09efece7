// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopOptions.h"

#include <QCommandLineParser>
#include <QCoreApplication>

namespace desktop
{
namespace
{

QString tr(const char* text)
{
  return QCoreApplication::translate("DesktopOptions", text);
}

const QString pathsOption = QStringLiteral("additional-module-paths");

void addOptions(QCommandLineParser& parser)
{
  parser.setApplicationDescription(tr("A desktop that loads modules of surgical navigation, in the manner of 3D Slicer."));
  parser.addPositionalArgument(
    QStringLiteral("files"), tr("Files and folders to hand to the module."), QStringLiteral("[-- files...]"));
  parser.addOptions({
    { { QStringLiteral("h"), QStringLiteral("help") }, tr("Shows this help.") },
    { { QStringLiteral("v"), QStringLiteral("version") }, tr("Shows the version.") },
    { pathsOption, tr("Looks for modules in these folders too: everything up to the next option."), tr("folders...") },
    { QStringLiteral("module"), tr("Begins with the module of this name."), tr("name") },
    { QStringLiteral("demo"), tr("A demonstration: modules begin with what they can simulate.") },
    { QStringLiteral("theme"), tr("system, light or dark, for this time."), tr("theme") },
    { QStringLiteral("size"), tr("Size of the window in pixels, for instance 1280x800."), tr("WxH") },
    { QStringLiteral("screenshot"), tr("Writes a picture of the window into this file (.png, .jpg) after the start."), tr("file") },
    { QStringLiteral("screenshot-delay"), tr("Waits so long before; 1.5 unless said otherwise."), tr("seconds") },
    { QStringLiteral("no-splash"), tr("Shows no picture while starting.") },
    { QStringLiteral("check-display"), tr("Ends at once: with 0 if there is a display that windows can be opened on.") },
    { QStringLiteral("exit-after-startup"), tr("Ends after the modules are loaded and the screenshot, if any, is written.") },
  });
}

// "--additional-module-paths A B C" becomes three options with one value each, which is what Qt knows.
QStringList withOnePathEach(const QStringList& arguments)
{
  const QString option = QStringLiteral("--") + pathsOption;
  QStringList result;
  bool inside = false;
  for (const QString& argument : arguments)
  {
    if (inside && !argument.startsWith(QLatin1Char('-')))
    {
      result << option << argument;
      continue;
    }
    inside = argument == option;
    if (!inside)
    {
      result << argument;
    }
  }
  return result;
}

DesktopOptions refused(const QString& message)
{
  DesktopOptions options;
  options.action = DesktopOptions::Action::Refuse;
  options.message = message;
  return options;
}

// Empty if all is well.
QString readValues(const QCommandLineParser& parser, DesktopOptions& options)
{
  if (parser.isSet(QStringLiteral("size")))
  {
    const QString text = parser.value(QStringLiteral("size"));
    const QStringList numbers = text.split(QLatin1Char('x'));
    options.size = numbers.size() == 2 ? QSize(numbers[0].toInt(), numbers[1].toInt()) : QSize();
    if (options.size.width() < 320 || options.size.height() < 240 || options.size.width() > 16384 || options.size.height() > 16384)
    {
      return tr("--size %1: expected width and height in pixels, like 1280x800, from 320x240 on.").arg(text);
    }
  }
  if (parser.isSet(QStringLiteral("screenshot-delay")))
  {
    bool isNumber = false;
    options.screenshotDelaySec = parser.value(QStringLiteral("screenshot-delay")).toDouble(&isNumber);
    if (!isNumber || !(options.screenshotDelaySec >= 0 && options.screenshotDelaySec <= 600))
    {
      return tr("--screenshot-delay %1: expected seconds, 0 to 600.").arg(parser.value(QStringLiteral("screenshot-delay")));
    }
  }
  options.theme = parser.value(QStringLiteral("theme"));
  if (parser.isSet(QStringLiteral("theme")) &&
    !QStringList{ QStringLiteral("system"), QStringLiteral("light"), QStringLiteral("dark") }.contains(options.theme))
  {
    return tr("--theme %1: expected system, light or dark.").arg(options.theme);
  }
  return {};
}

}  // namespace

DesktopOptions DesktopOptions::parse(const QStringList& arguments)
{
  QCommandLineParser parser;
  addOptions(parser);
  if (!parser.parse(withOnePathEach(arguments)))
  {
    return refused(parser.errorText() + QLatin1Char('.'));
  }
  const QString paths = QStringLiteral("--") + pathsOption;
  const int at = arguments.indexOf(paths);
  if (at >= 0 && (at + 1 == arguments.size() || arguments[at + 1].startsWith(QLatin1Char('-'))))
  {
    return refused(tr("%1: expected one or more folders after it.").arg(paths));
  }
  DesktopOptions options;
  options.action = parser.isSet(QStringLiteral("help")) ? Action::ShowHelp
    : parser.isSet(QStringLiteral("version"))           ? Action::ShowVersion
                                                        : Action::Run;
  options.additionalModulePaths = parser.values(pathsOption);
  options.module = parser.value(QStringLiteral("module"));
  options.screenshot = parser.value(QStringLiteral("screenshot"));
  options.demonstration = parser.isSet(QStringLiteral("demo"));
  options.noSplash = parser.isSet(QStringLiteral("no-splash"));
  options.exitAfterStartup = parser.isSet(QStringLiteral("exit-after-startup"));
  options.checkDisplay = parser.isSet(QStringLiteral("check-display"));
  options.files = parser.positionalArguments();
  const QString problem = readValues(parser, options);
  return problem.isEmpty() ? options : refused(problem);
}

QString DesktopOptions::help()
{
  QCommandLineParser parser;
  addOptions(parser);
  return parser.helpText();
}

}  // namespace desktop
