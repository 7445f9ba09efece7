// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string_view>

namespace handeye::io
{

/// The YAML and XML in which cameras are written, as JSON trees.
///
/// These are OpenCV's FileStorage formats and the plain YAML of ROS. They are read with yaml-cpp and pugixml, not with
/// cv::FileStorage, because that of OpenCV 4.6 crashes on damaged files: `<?xml vion=` alone is enough.
///
/// Numbers become numbers, everything else strings; tags, anchors and attributes are passed over.
/// All functions throw FileError naming the line. The nesting is limited, so that no file can use up the stack.

/// The first document of the file. Aliases are refused, for a few lines of them can stand for any amount of values.
nlohmann::json parseYamlTree(const std::filesystem::path& path, std::string_view text);

/// Elements as maps; elements named `_` as a list; several words of text as a list of them. The root's name is left out.
nlohmann::json parseXmlTree(const std::filesystem::path& path, std::string_view text);

/// A number where it is one, otherwise a string; without quotation marks around it.
nlohmann::json scalarFromText(std::string_view text);

constexpr int DeepestNesting = 40;

}  // namespace handeye::io
