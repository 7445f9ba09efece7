// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

namespace handeye::devices
{

/// A text field of fixed size: up to the first zero or the field's end, without blanks behind.
inline std::string fixedText(const char* bytes, std::size_t size)
{
  std::string text(bytes, strnlen(bytes, size));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace handeye::devices
