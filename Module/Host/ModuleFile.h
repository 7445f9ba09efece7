// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>

namespace desktop
{

/// What can be said of a file in a folder of modules without loading it: its name, its ELF headers, and the metadata that Qt's moc put into
/// it. Nothing of the file is executed.
struct ModuleFile
{
  enum class Status
  {
    Usable,
    OtherName,  ///< not libqSlicer<Name>Module.so
    Damaged,    ///< no whole shared library
    Foreign     ///< no Qt plugin, or a plugin of another interface
  };

  QString path;
  QString name;  ///< of the module, from the file name; empty for OtherName
  Status status = Status::Damaged;
  QString reason;  ///< a sentence for a person; empty if usable

  bool isUsable() const { return this->status == Status::Usable; }
};

ModuleFile inspectModuleFile(const QString& path);

}  // namespace desktop
