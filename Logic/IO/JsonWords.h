// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace handeye::io
{

/// What is wrong with a JSON text, for a person: "not JSON: line 1, column 5"; of JSON in which something else was found than
/// expected, what the library says of it, without its code. Internal.
std::string jsonProblem(const nlohmann::json::exception& error);

}  // namespace handeye::io
