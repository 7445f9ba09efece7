// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerAbstractCoreModule.h"
#include "qSlicerBaseQTGUIExport.h"

#include <QIcon>

class QAction;

/// Stands in for 3D Slicer's class of this name: a module with an icon, and an action that stands for it in menus and tool bars.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerAbstractModule : public qSlicerAbstractCoreModule
{
  Q_OBJECT
  Q_PROPERTY(QIcon icon READ icon)

public:
  typedef qSlicerAbstractCoreModule Superclass;

  explicit qSlicerAbstractModule(QObject* parent = nullptr);

  virtual QIcon icon() const;

  /// Title and icon; its data is the name. The module's own.
  QAction* action();

private:
  Q_DISABLE_COPY(qSlicerAbstractModule)

  QAction* Action = nullptr;
};
