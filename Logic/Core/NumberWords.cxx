// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NumberWords.h"

#include <iomanip>
#include <sstream>

namespace handeye
{

std::string fixedDigits(double value, int digits)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string significantDigits(double value, int digits)
{
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

}  // namespace handeye
