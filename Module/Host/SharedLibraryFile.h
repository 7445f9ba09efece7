// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>

namespace desktop
{

/// Whether a file is a whole shared library for this machine, by its ELF headers. Looking comes before loading: the dynamic loader maps what
/// the headers promise, and a file that was cut short takes the whole program down with it.
///
/// @return an empty string if nothing is wrong, else a sentence that says what
QString sharedLibraryProblem(const QString& path);

}  // namespace desktop
