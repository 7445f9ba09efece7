// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <string>

class vtkRenderWindow;

namespace handeye::test
{

/// Compares with Testing/Baseline/<suite>.<test><name>.png as VTK's own image tests do (shifts by a pixel are forgiven). A missing
/// baseline is a failure that leaves the picture in Testing/Output, to look at.
void expectLikeBaseline(const cv::Mat& picture, const std::string& name, double threshold);

/// What a window shows in this size, top row first, BGR.
cv::Mat renderedWindow(vtkRenderWindow* window, int width, int height);

/// The largest difference of any channel of any pixel; infinity for pictures of different sizes.
double largestDifference(const cv::Mat& a, const cv::Mat& b);

}  // namespace handeye::test
