// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Source.h"

#include <filesystem>
#include <optional>
#include <string>

namespace handeye::io
{
class Recording;
}

namespace handeye::devices
{

struct ReplayOptions
{
  std::filesystem::path recording;
  double speed = 1;                 ///< 2: twice as fast; 0: as fast as it is taken
  bool needsTracking = true;        ///< otherwise pictures alone will do
  bool isStepwise = false;          ///< a frame for each step()
  bool isLooping = false;           ///< from the beginning again, with times that go on
  std::string imageName = "Image";  ///< of the image samples
  double framesPerSec = 30;         ///< for recordings that have no times
  SampleBufferOptions buffer{ 4096, std::size_t(256) << 20, true };

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// Plays a recording (sequence metafile, or folder) as if it were live: each frame's poses and then its image, with the frame's time.
/// A pose that the recording says is not valid is delivered as not valid. Ends with the state Finished, unless it loops. A frame that
/// cannot be read is left out and counted as refused; a recording that cannot be opened is Finished at once. Both say so in the status.
class ReplaySource : public Source
{
public:
  explicit ReplaySource(const ReplayOptions& options);
  ~ReplaySource() override;

  std::string name() const override { return options_.recording.string(); }

  /// Stepwise: lets the next frame go. May be called ahead.
  void step();

protected:
  void run() override;

private:
  bool waitForTurn(double streamSec, double startSec);
  void deliverFrame(const io::Recording& recording, int frame, double timeSec);
  std::optional<double> playOnce(const io::Recording& recording, double startSec, double loopOffsetSec);
  void play(const io::Recording& recording);

  ReplayOptions options_;
  std::mutex stepMutex_;
  std::condition_variable stepped_;
  int steps_ = 0;

  void wake() override;
};

}  // namespace handeye::devices
