// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "JsonWords.h"

#include "NumberText.h"

#include <string_view>

namespace handeye::io
{

std::string jsonProblem(const nlohmann::json::exception& error)
{
  // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while parsing ..."
  const std::string text = error.what();
  const std::size_t code = text.find("] ");
  const std::string words = text[0] == '[' && code != std::string::npos ? text.substr(code + 2) : text;
  constexpr std::string_view at = "parse error at ";
  if (words.rfind(at, 0) == 0)
  {
    return "not JSON: " + printable(words.substr(at.size(), words.find(": ") - at.size()));
  }
  return printable(words);
}

}  // namespace handeye::io
