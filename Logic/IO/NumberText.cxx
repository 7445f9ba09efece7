// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NumberText.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace handeye::io
{

namespace
{

constexpr std::size_t LongestQuotation = 40;

char lower(char c)
{
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string_view withoutPlus(std::string_view text)
{
  const bool hasPlus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  return hasPlus ? text.substr(1) : text;
}

/// How the C runtime of older Visual Studios writes numbers that are none: 1.#IND, -1.#QNAN, 1.#INF
bool isMicrosoftNotANumber(std::string_view text)
{
  const std::string_view magnitude = text.substr(0, 1) == "-" ? text.substr(1) : text;
  return magnitude.size() >= 6 && magnitude.substr(0, 3) == "1.#";
}

}  // namespace

std::string_view trimmed(std::string_view text)
{
  constexpr std::string_view blanks = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos)
  {
    return {};
  }
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> splitWords(std::string_view text, std::string_view separators)
{
  std::vector<std::string_view> words;
  std::size_t begin = text.find_first_not_of(separators);
  while (begin != std::string_view::npos)
  {
    const std::size_t end = text.find_first_of(separators, begin);
    words.push_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
    begin = end == std::string_view::npos ? end : text.find_first_not_of(separators, end);
  }
  return words;
}

std::optional<double> parseDouble(std::string_view text)
{
  text = withoutPlus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool isWhole = end == text.data() + text.size();
  if (error == std::errc() && isWhole)
  {
    return value;
  }
  if (error == std::errc::result_out_of_range && isWhole)
  {
    const double sign = text[0] == '-' ? -1 : 1;
    const bool isTiny = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
    return isTiny ? sign * 0.0 : sign * std::numeric_limits<double>::infinity();
  }
  if (isMicrosoftNotANumber(text))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::nullopt;
}

std::optional<long long> parseInteger(std::string_view text)
{
  text = withoutPlus(text);
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
  {
    return std::nullopt;
  }
  return value;
}

std::string formatDouble(double value)
{
  char buffer[64];
  const auto result =
    std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::general, std::numeric_limits<double>::max_digits10);
  return std::string(buffer, result.ptr);
}

bool equalsIgnoreCase(std::string_view a, std::string_view b)
{
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string printable(std::string_view text, std::size_t longest)
{
  std::string result;
  for (char c : text.substr(0, longest))
  {
    result += c >= 0x20 && c < 0x7f ? c : '?';
  }
  return result + (text.size() > longest ? "..." : "");
}

std::string inQuotes(std::string_view text)
{
  return "'" + printable(text, LongestQuotation) + "'";
}

}  // namespace handeye::io
