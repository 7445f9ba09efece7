// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace handeye
{

/// Points with a line that determine a pose, with one to spare against the several solutions that three have.
constexpr std::size_t MinimalSet = 4;

/// Sets of `MinimalSet` indices below `count`: all combinations where they are few, otherwise 300 draws, always the same. Internal.
std::vector<std::vector<int>> minimalSets(int count);

}  // namespace handeye
