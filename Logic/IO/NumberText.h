// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace handeye::io
{

/// Numbers in text, with a decimal point whatever the locale; for the files of this layer.

/// Without blanks, tabs and line ends at both ends.
std::string_view trimmed(std::string_view text);

/// The pieces between separators, none of them empty.
std::vector<std::string_view> splitWords(std::string_view text, std::string_view separators = " \t\r\n");

/// The whole of `text` as a number; "nan", "inf" and what Windows makes of them ("-1.#IND") are numbers that are not finite.
std::optional<double> parseDouble(std::string_view text);

/// The whole of `text` as an integer; nothing where it does not fit.
std::optional<long long> parseInteger(std::string_view text);

/// 17 significant digits: parseDouble() gives the same bits.
std::string formatDouble(double value);

bool equalsIgnoreCase(std::string_view a, std::string_view b);

/// Text from a file as a message may show it: shortened, printable ASCII.
std::string printable(std::string_view text, std::size_t longest = 200);

/// The same in quotes, and short.
std::string inQuotes(std::string_view text);

}  // namespace handeye::io
