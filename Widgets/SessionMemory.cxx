// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SessionMemory.h"

#include "Look.h"

#include <nlohmann/json.hpp>

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>
#include <QStringList>

#include <algorithm>

namespace handeye
{

namespace
{

const QString LastKey = QStringLiteral("last");

QSettings memory()
{
  return QSettings(sessionsFolder() + QStringLiteral("/sessions.ini"), QSettings::IniFormat);
}

nlohmann::json readJson(const QString& path)
{
  QFile file(path);
  return nlohmann::json::parse(file.open(QIODevice::ReadOnly) ? file.readAll().toStdString() : std::string(), nullptr, false);
}

/// A result that was taken back is a document without one, and one that failed says so.
bool isUsableResult(const nlohmann::json& document)
{
  return document.is_object() && document.value("status", nlohmann::json("ok")) == "ok";
}

/// Of the samples' files, those that were not deleted.
int sampleCountOf(const QString& folder)
{
  const nlohmann::json deleted = readJson(folder + QStringLiteral("/documents/deleted.json"));
  const nlohmann::json ids = deleted.is_object() ? deleted.value("samples", nlohmann::json()) : nlohmann::json();
  const QStringList files = QDir(folder + QStringLiteral("/samples")).entryList({ QStringLiteral("*.json") }, QDir::Files);
  return int(std::count_if(files.begin(), files.end(),
    [&ids](const QString& file)
    { return std::find(ids.begin(), ids.end(), nlohmann::json(QFileInfo(file).baseName().toInt())) == ids.end(); }));
}

QString tr(const char* text)
{
  return QCoreApplication::translate("handeye::SessionSummary", text);
}

}  // namespace

QString sessionsFolder()
{
  return QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) + QStringLiteral("/HandEyeCalibration");
}

SessionSummary summarizeSession(const QString& folder)
{
  SessionSummary summary;
  summary.folder = folder;
  const QDir documents(folder + QStringLiteral("/documents"));
  const auto has = [&](const char* name)
  {
    const QFileInfo file(documents.filePath(QLatin1String(name) + QStringLiteral(".json")));
    if (!file.exists())
    {
      return false;
    }
    summary.changed = summary.changed.isValid() ? std::max(summary.changed, file.lastModified()) : file.lastModified();
    return isUsableResult(readJson(file.filePath()));
  };
  summary.sampleCount = sampleCountOf(folder);
  summary.hasStylus = has("stylus");
  summary.isCalibrated = has("calibration");
  summary.isValidated = has("validation") && summary.isCalibrated;
  summary.isRegistered = has("phantom");
  return summary;
}

QString toString(const SessionSummary& summary)
{
  QStringList parts;
  if (summary.sampleCount > 0)
  {
    parts << counted(summary.sampleCount, tr("1 sample"), tr("%1 samples"));
  }
  else if (summary.hasStylus && !summary.isCalibrated)
  {
    parts << tr("stylus pivoted");
  }
  for (const auto& [is, words] : { std::pair(summary.isCalibrated, tr("calibrated")),
         std::pair(summary.isValidated, tr("validated")), std::pair(summary.isRegistered, tr("phantom registered")) })
  {
    if (is)
    {
      parts << words;
    }
  }
  return parts.join(QStringLiteral(", "));
}

void rememberSession(const QString& folder)
{
  QDir().mkpath(sessionsFolder());
  memory().setValue(LastKey, QDir(folder).absolutePath());
}

std::optional<SessionSummary> rememberedSession(const QString& openFolder)
{
  const QString folder = memory().value(LastKey).toString();
  if (folder.isEmpty() || QDir(folder) == QDir(openFolder) || !QFileInfo::exists(folder + QStringLiteral("/session.json")))
  {
    return std::nullopt;
  }
  const SessionSummary summary = summarizeSession(folder);
  return summary.isUsed() ? std::optional(summary) : std::nullopt;
}

}  // namespace handeye
