// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModuleLoader.h"

#include "ModuleFile.h"
#include "qSlicerLoadableModule.h"

#include <QDir>
#include <QFileInfo>
#include <QPluginLoader>

#include <algorithm>
#include <cstdio>
#include <exception>

namespace desktop
{

ModuleLoader::ModuleLoader(QObject* parent)
  : QObject(parent)
{
}

ModuleLoader::~ModuleLoader()
{
  // Later modules may use earlier ones.
  std::for_each(this->Modules.rbegin(), this->Modules.rend(), [](qSlicerLoadableModule* module) { delete module; });
}

qSlicerLoadableModule* ModuleLoader::module(const QString& name) const
{
  for (qSlicerLoadableModule* const module : this->Modules)
  {
    if (module->name() == name)
    {
      return module;
    }
  }
  return nullptr;
}

void ModuleLoader::load(const QStringList& folders)
{
  std::vector<Loaded> loaded;
  for (const QString& folder : folders)
  {
    this->loadFolder(folder, loaded);
  }
  this->initializeAll(std::move(loaded));
}

void ModuleLoader::addProblem(const QString& path, const QString& reason)
{
  this->Problems.append({ path, reason });
  emit this->problemFound(path, reason);
}

void ModuleLoader::loadFolder(const QString& folder, std::vector<Loaded>& loaded)
{
  const QFileInfo info(folder);
  if (!info.isDir() || !info.isReadable())
  {
    this->addProblem(
      folder, info.exists() ? tr("this folder of modules cannot be read") : tr("this folder of modules does not exist"));
    return;
  }
  const QFileInfoList files = QDir(folder).entryInfoList({ QStringLiteral("*.so") }, QDir::Files | QDir::System, QDir::Name);
  for (const QFileInfo& file : files)
  {
    this->loadFile(file.absoluteFilePath(), loaded);
  }
}

void ModuleLoader::loadFile(const QString& path, std::vector<Loaded>& loaded)
{
  const ModuleFile file = inspectModuleFile(path);
  if (!file.isUsable())
  {
    this->addProblem(path, file.reason);
    return;
  }
  if (this->Names.contains(file.name))
  {
    this->addProblem(path, tr("a module of the name \"%1\" was loaded before, from another folder").arg(file.name));
    return;
  }
  this->Names << file.name;
  std::printf("Loading module \"%s\"\n", qPrintable(file.name));
  std::fflush(stdout);
  emit this->loading(file.name);
  try
  {
    Loaded entry;
    entry.plugin = std::make_unique<QPluginLoader>(path);
    // What is missing in a library is said now, and not when it is called for.
    entry.plugin->setLoadHints(QLibrary::ResolveAllSymbolsHint | QLibrary::PreventUnloadHint);
    QObject* const root = entry.plugin->instance();
    entry.module = qobject_cast<qSlicerLoadableModule*>(root);
    // A plugin has one root object, however many names its file has.
    if (entry.module && !entry.module->name().isEmpty())
    {
      this->addProblem(path, tr("the same file was loaded before, as \"%1\"").arg(entry.module->name()));
      return;
    }
    if (entry.module)
    {
      entry.module->setName(file.name);
      entry.module->setPath(path);
      loaded.push_back(std::move(entry));
      return;
    }
    this->addProblem(
      path, root ? tr("its plugin is no module: it does not derive from qSlicerLoadableModule") : entry.plugin->errorString());
  }
  catch (const std::exception& error)
  {
    this->addProblem(path, tr("it failed while it was loaded: %1").arg(QString::fromUtf8(error.what())));
  }
}

void ModuleLoader::initializeAll(std::vector<Loaded> loaded)
{
  // Each round takes what has all it depends on; what is left in the end waits for something that never comes.
  bool progress = true;
  while (progress && !loaded.empty())
  {
    progress = false;
    for (auto entry = loaded.begin(); entry != loaded.end(); ++entry)
    {
      const QStringList needed = entry->module->dependencies();
      if (std::all_of(needed.begin(), needed.end(), [this](const QString& name) { return this->module(name) != nullptr; }))
      {
        if (this->initializeOne(*entry->module))
        {
          this->Modules.append(entry->module);
        }
        this->Plugins.push_back(std::move(entry->plugin));
        loaded.erase(entry);
        progress = true;
        break;
      }
    }
  }
  for (Loaded& entry : loaded)
  {
    this->addProblem(entry.module->path(),
      tr("it needs modules that are not here: %1").arg(entry.module->dependencies().join(QStringLiteral(", "))));
    delete entry.module;
    this->Plugins.push_back(std::move(entry.plugin));
  }
}

bool ModuleLoader::initializeOne(qSlicerLoadableModule& module)
{
  const QString path = module.path();
  QString message;
  try
  {
    module.initialize(nullptr);
    return true;
  }
  catch (const std::exception& error)
  {
    message = QString::fromUtf8(error.what());
  }
  delete &module;
  this->addProblem(path, tr("it failed while it was set up: %1").arg(message));
  return false;
}

}  // namespace desktop
