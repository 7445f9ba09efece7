// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NavigationHost.h"

#include <QApplication>
#include <QWidget>

/// The desktop that a module was loaded by: the first top-level window that is one. Null in another application.
inline NavigationHost* findNavigationHost()
{
  const QWidgetList windows = QApplication::topLevelWidgets();
  for (QWidget* window : windows)
  {
    if (auto* host = qobject_cast<NavigationHost*>(window))
    {
      return host;
    }
  }
  return nullptr;
}
