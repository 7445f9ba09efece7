// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OverlayRecorder.h"

#include <cstddef>
#include <memory>

namespace handeye
{

/// Records the pictures of a live overlay in a thread of its own, so that who draws them need not wait for an encoder.
///
/// Live pictures do not come evenly, and a video file has one rate: each picture takes the place that its time has in the file,
/// and stays until the next one, so that the video lasts as long as what was seen. The metafile beside the video has a frame for
/// each of the video's, with the time and the transforms of the picture that is in it. Where the times go back (a recording that
/// begins anew), or nothing came for more than LongestGapSec, the video goes on without a gap.
///
/// Nothing that was taken is lost: finish() and the destructor write all of it before the files get their names. What cannot be
/// taken is counted and said: pictures that come while `mostWaiting` or 512 MB of them wait for the encoder, those that are faster
/// than the file's rate, those of another size than the first (the picture before stays in their place), and those that wait when
/// there is an error.
///
/// add(), finish() and state() may be called from any thread.
class LiveOverlayRecorder
{
public:
  static constexpr double LongestGapSec = 5;

  struct State
  {
    int pictureCount = 0;  ///< that are in the video
    int frameCount = 0;    ///< of the video: a picture that stayed counts as often as it is there
    int waitingCount = 0;  ///< pictures that were taken and are not written yet
    int leftOutCount = 0;
    std::string leftOutReason;  ///< of the first, a sentence
    std::string encoder;        ///< see OverlayRecorder
    std::string error;          ///< why there is no video, a sentence; it is not recorded any more then
    bool isFinished = false;    ///< the files have their names, or there is an error
  };

  /// @param mostWaiting at least 1
  /// @throws io::FileError, std::invalid_argument as OverlayRecorder does
  explicit LiveOverlayRecorder(
    const std::filesystem::path& video, const OverlayRecorderOptions& options = {}, std::size_t mostWaiting = 90);
  /// Waits until all that was taken is written.
  ~LiveOverlayRecorder();
  LiveOverlayRecorder(const LiveOverlayRecorder&) = delete;
  LiveOverlayRecorder& operator=(const LiveOverlayRecorder&) = delete;

  /// @param bgr 8 bits, 3 channels; shared, not to be written to afterwards
  /// @param timeSec of the picture, in the clock of its source
  /// @return whether it was taken
  bool add(const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms);

  /// Nothing more is taken; what was taken is written, and the files get their names. Does not wait for it.
  void finish();

  State state() const;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
