// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NavigationHost.h"

#include <QIcon>
#include <QPixmap>

class QColor;

namespace desktop
{

/// An icon of the desktop, drawn in the text colour of the palette as it is now; ask again after a change of theme.
/// @param name "open", "layout-video"...: a file of Resources/Icons/Desktop
QIcon icon(const QString& name);

/// A sign that can be told from the others without its colour: a disc (live), a triangle (stale), a cross (lost).
QPixmap streamLightPixmap(NavigationHost::StreamLight light, int size, double devicePixelRatio);

/// A triangle for warnings, a cross for errors; none for the rest.
QIcon levelIcon(NavigationHost::LogLevel level);

/// Of the lights, readable on light and dark ground.
QColor streamLightColor(NavigationHost::StreamLight light);

}  // namespace desktop
