// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace handeye::io
{

/// One line of numbers of a text table.
struct TableRow
{
  long long line;  ///< from 1
  std::vector<double> values;
};

/// The rows of a text table, see TextTables.h. @throws FileError for anything that is not a finite number
std::vector<TableRow> parseTable(const std::filesystem::path& path, std::string_view text);

}  // namespace handeye::io
