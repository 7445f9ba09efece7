// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace handeye
{

/// Does nothing; a call to it makes the linker take the shim's GLX entry points out of the static library and into the program.
void linkGlxShim();

}  // namespace handeye
