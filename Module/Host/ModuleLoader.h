// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>
#include <QStringList>
#include <QVector>

#include <memory>
#include <vector>

class QPluginLoader;
class qSlicerLoadableModule;

namespace desktop
{

/// Finds modules in folders, loads and initializes them. A file that cannot be used is reported with its reason and skipped; the others
/// are loaded all the same.
///
/// For each module "Loading module \"<Name>\"" goes to the standard output, as in 3D Slicer, before anything of it is executed. Modules come
/// after those that they depend on, else in the order of folders and names. Of two modules of one name the first one is taken.
///
/// Modules are objects of their plugins and live until the loader goes; the libraries stay loaded, because Qt and VTK keep pointers into
/// what was registered from there. Not for several threads.
class ModuleLoader : public QObject
{
  Q_OBJECT

public:
  struct Problem
  {
    QString path;    ///< the file, or the folder
    QString reason;  ///< a sentence
  };

  explicit ModuleLoader(QObject* parent = nullptr);
  ~ModuleLoader() override;

  /// Loads what the folders hold. A folder that is not there is a problem, too.
  void load(const QStringList& folders);

  const QVector<qSlicerLoadableModule*>& modules() const { return this->Modules; }
  qSlicerLoadableModule* module(const QString& name) const;
  const QVector<Problem>& problems() const { return this->Problems; }

signals:
  void loading(const QString& name);
  void problemFound(const QString& path, const QString& reason);

private:
  struct Loaded
  {
    std::unique_ptr<QPluginLoader> plugin;
    qSlicerLoadableModule* module = nullptr;
  };

  void addProblem(const QString& path, const QString& reason);
  void loadFolder(const QString& folder, std::vector<Loaded>& loaded);
  void loadFile(const QString& path, std::vector<Loaded>& loaded);
  void initializeAll(std::vector<Loaded> loaded);
  bool initializeOne(qSlicerLoadableModule& module);

  std::vector<std::unique_ptr<QPluginLoader>> Plugins;
  QVector<qSlicerLoadableModule*> Modules;
  QVector<Problem> Problems;
  QStringList Names;  // of everything that was loaded, usable or not
};

}  // namespace desktop
