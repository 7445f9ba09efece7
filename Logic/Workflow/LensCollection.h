// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "LensViewCollector.h"

#include <opencv2/core.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// Views of a board from one picture after the other, as they come: looks for the board, and takes what LensViewCollector takes.
///
/// Not safe to share between threads.
class LensCollection
{
public:
  explicit LensCollection(const BoardDescription& board, const LensViewCollectorOptions& options = {});

  /// What became of a picture.
  struct Look
  {
    bool isTaken = false;
    std::string message;  ///< for the person who holds the board
  };

  /// One picture; views are numbered in the order in which they are taken, from 0.
  /// @throws std::runtime_error with a sentence for a picture of another size than the first
  Look add(const cv::Mat& image);

  const BoardDescription& board() const { return board_; }
  int width() const { return collector_ ? width_ : 0; }  ///< px; 0 before the first picture
  int height() const { return collector_ ? height_ : 0; }
  int pictureCount() const { return pictures_; }
  int withBoardCount() const { return withBoard_; }

  /// Null before the first picture.
  const LensViewCollector* collector() const { return collector_ ? &*collector_ : nullptr; }
  std::vector<LensView> views() const { return collector_ ? collector_->views() : std::vector<LensView>(); }
  /// What the board was in each of the views.
  const std::vector<BoardDetection>& detections() const { return detections_; }

  /// How many pictures were not taken, by the word for the reason: "not_found", "moving", ...
  const std::map<std::string, int>& notTaken() const { return notTaken_; }
  /// The sentence that was said most often of pictures without the board; empty if all have it.
  std::string commonestReason() const;

private:
  BoardDescription board_;
  LensViewCollectorOptions options_;
  std::optional<LensViewCollector> collector_;
  std::vector<BoardDetection> detections_;
  std::map<std::string, int> notTaken_, reasons_;
  int width_ = 0, height_ = 0, pictures_ = 0, withBoard_ = 0;
};

}  // namespace handeye
