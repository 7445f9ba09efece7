// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QStringList>

namespace desktop
{

/// What has to be said before there is a QApplication: pixels of fine screens, the OpenGL format that VTK needs, the names that settings
/// are stored under.
void prepareApplication();

/// After it: icons and where they come from.
void finishApplication();

QString applicationVersion();

/// Folders of the modules that belong to this program, relative to where it is: the build tree and the installation look alike. Those
/// that exist; the first one that would be looked in if none does.
QStringList defaultModuleFolders();

}  // namespace desktop
