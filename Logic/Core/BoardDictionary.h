// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"

#include <opencv2/aruco/charuco.hpp>

#include <optional>
#include <string>

namespace handeye
{

/// OpenCV's ArUco dictionaries by name. Internal.

/// The number that OpenCV gives a dictionary, by its name without "DICT_"; nothing for an unknown one.
std::optional<int> findDictionary(const std::string& name);

/// How many markers it has.
int dictionarySize(int dictionary);

/// One marker with its black border, a pixel per module: 0 is black.
cv::Mat markerModules(const std::string& dictionary, int marker);

/// OpenCV's board of ours, whose corners have our numbers.
cv::Ptr<cv::aruco::CharucoBoard> makeCharucoBoard(const BoardDescription& board);

}  // namespace handeye
