// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MethodComparison.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace handeye
{

/// A comparison as files: keys and columns for other programs (mm, px, seconds). CSV after RFC 4180: a heading, commas, quotes
/// where a text needs them, points for decimals whatever the language; numbers that do not exist are empty, never 0.

/// What `handeye compare --json` prints.
[[nodiscard]] nlohmann::json comparisonJson(const ComparisonResult& result);

/// One line a method: name, target, status, projection errors, calibrations, seconds, why not.
[[nodiscard]] std::string methodsCsv(const ComparisonResult& result);
/// One line a method, capture and validation sample.
[[nodiscard]] std::string errorsCsv(const ComparisonResult& result, const std::vector<HandEyeSample>& validation);
/// One line a method and size of the random subsets.
[[nodiscard]] std::string subsetsCsv(const ComparisonResult& result);
/// One line a method: the spread over captures or halves.
[[nodiscard]] std::string repeatabilityCsv(const ComparisonResult& result);

/// A text as one field of a CSV line. Internal.
[[nodiscard]] std::string csvField(const std::string& text);
/// A number as the shortest text that reads back the same. Internal.
[[nodiscard]] std::string csvNumber(double value);

}  // namespace handeye
