// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QColor>
#include <QIcon>
#include <QString>

class QPalette;

namespace handeye
{

/// How something stands: what a person has to make of a text, a mark or a number. Always shown by a shape as well as by a colour.
enum class Level
{
  Info,     ///< neither good nor bad
  Good,     ///< as it should be
  Warning,  ///< usable, but to be looked at
  Error     ///< not usable
};

/// Whether a palette has light text on a dark ground.
bool isDark(const QPalette& palette);

/// The colour of a level for text and marks on a palette's window; contrast of at least 4.5 to 1 with the ground.
QColor levelColor(Level level, const QPalette& palette);

/// A colour for the index-th series of a plot on a palette's base; told apart also with a red-green weakness.
QColor seriesColor(int index, const QPalette& palette);

/// An icon of our own: "capture", "undo", ... (the names of the files in Resources/Icons, without ending); visible on light and on
/// dark ground. A name that is not there gives a null icon.
QIcon icon(const QString& name);

/// What a projection error means: good below 1 px mean, to be looked at (`fair`) below 3, and not to be worked with (`poor`) above; the
/// limits of `handeye calibrate` and `validate`. Nothing for an error that is not known.
Level errorLevel(double meanPx);

/// "info", "ok", "warning", "error": a shape for each level.
QIcon levelIcon(Level level);

/// The colour of a link on a palette's window, readable: the palette's own where it has the contrast, which those of dark desktops often
/// have not.
QColor linkColor(const QPalette& palette);

/// A message of the layers below, which is a clause, as it stands alone: with a capital, and a full stop unless it ends with a mark.
QString asSentence(const QString& message);

/// "1 sample", "4 samples": one of two texts by a count; %1 in the second is the count. English needs no translation file then.
QString counted(int count, const QString& one, const QString& many);

/// A number with a fixed count of digits and its unit in the language of the person: "0.42 px"; an en dash if it is not finite.
QString withUnit(double value, int digits, const QString& unit);

}  // namespace handeye
