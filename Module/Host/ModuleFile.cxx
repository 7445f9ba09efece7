// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModuleFile.h"

#include "SharedLibraryFile.h"
#include "qSlicerLoadableModule.h"

#include <QCoreApplication>
#include <QFileInfo>
#include <QJsonObject>
#include <QPluginLoader>
#include <QRegularExpression>

namespace desktop
{
namespace
{

QString tr(const char* text)
{
  return QCoreApplication::translate("ModuleFile", text);
}

}  // namespace

ModuleFile inspectModuleFile(const QString& path)
{
  ModuleFile file;
  file.path = path;
  static const QRegularExpression pattern(QStringLiteral("^libqSlicer(.+)Module\\.so$"));
  const QRegularExpressionMatch match = pattern.match(QFileInfo(path).fileName());
  if (!match.hasMatch())
  {
    file.status = ModuleFile::Status::OtherName;
    file.reason = tr("its name is not that of a module, libqSlicer<Name>Module.so");
    return file;
  }
  file.name = match.captured(1);
  file.reason = sharedLibraryProblem(path);
  if (!file.reason.isEmpty())
  {
    file.status = ModuleFile::Status::Damaged;
    return file;
  }
  const QString expected = QStringLiteral(qSlicerLoadableModule_iid);
  const QJsonObject metadata = QPluginLoader(path).metaData();
  const QString found = metadata.value(QStringLiteral("IID")).toString();
  file.status = found == expected ? ModuleFile::Status::Usable : ModuleFile::Status::Foreign;
  if (found.isEmpty())
  {
    file.reason = tr("it is a library, but no Qt plugin");
  }
  else if (found != expected)
  {
    file.reason = tr("it is a plugin of another interface: \"%1\" instead of \"%2\"").arg(found, expected);
  }
  return file;
}

}  // namespace desktop
