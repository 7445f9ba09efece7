// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensCollection.h"

#include "BoardPattern.h"

#include <algorithm>
#include <stdexcept>

namespace handeye
{

LensCollection::LensCollection(const BoardDescription& board, const LensViewCollectorOptions& options)
  : board_(board)
  , options_(options)
{
  options.check();
}

LensCollection::Look LensCollection::add(const cv::Mat& image)
{
  if (!collector_)
  {
    collector_.emplace(image.cols, image.rows, options_);
    width_ = image.cols;
    height_ = image.rows;
  }
  if (image.cols != width_ || image.rows != height_)
  {
    const auto size = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
    throw std::runtime_error("the picture's size changed from " + size(width_, height_) + " to " + size(image.cols, image.rows) +
      " px; a lens is calibrated at one size: forget the views and start again");
  }
  ++pictures_;
  const BoardDetection detection = detectBoard(image, board_);
  const LensViewVerdict verdict = collector_->add(int(detections_.size()), detection);
  withBoard_ += detection.isUsable() ? 1 : 0;
  if (verdict.isTaken())
  {
    detections_.push_back(detection);
    return { true, verdict.message };
  }
  ++notTaken_[detection.isUsable() ? toString(verdict.status) : toString(detection.status)];
  if (!detection.isUsable())
  {
    ++reasons_[detection.message];
  }
  return { false, verdict.message };
}

std::string LensCollection::commonestReason() const
{
  const auto most = std::max_element(
    reasons_.begin(), reasons_.end(), [](const auto& left, const auto& right) { return left.second < right.second; });
  return most == reasons_.end() ? std::string() : most->first;
}

}  // namespace handeye
