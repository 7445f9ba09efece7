// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace handeye::cli
{

/// From now on, Ctrl+C and a polite kill only ask: what is written is finished first. A second time ends the program.
void catchStopSignals();
bool isStopAsked();

}  // namespace handeye::cli
