// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace handeye
{

/// Numbers for the sentences that results carry. Internal.

/// With this many digits behind the point: "0.70".
std::string fixedDigits(double value, int digits);

/// With this many digits that count, whatever the size: "0.00123".
std::string significantDigits(double value, int digits);

}  // namespace handeye
