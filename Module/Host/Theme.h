// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QPalette>
#include <QString>

namespace desktop
{

/// How the desktop looks: as the system has it, or light, or dark.
enum class Theme
{
  System,
  Light,
  Dark
};

/// Sets style and palette of the application. Widgets get a QEvent::PaletteChange; links in labels get their colour anew.
void applyTheme(Theme theme);

/// The palette, with links of our own where its own could not be read: a dark palette of the system often has the blue of a light one.
QPalette withReadableLinks(const QPalette& palette);

/// Whether text is light on dark now.
bool isDark();

/// "system", "light", "dark", as settings and options have them.
QString themeName(Theme theme);
/// System for anything else.
Theme themeFromName(const QString& name);

}  // namespace desktop
