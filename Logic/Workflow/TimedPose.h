// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"

#include <string>
#include <vector>

namespace handeye
{

/// The pose of a tool that belongs to the image of a frame: at the frame's time plus the latency, interpolated between the
/// recording's frames. Without a latency (0) it is the frame's own, as recorded; the recording need not have times then. A latency that the
/// recording says was applied when it was made is not applied again: what is missing is.
/// A moment outside of the recording, in a gap, or beside a frame in which the tool was not seen gives no pose, with the reason.
/// @param frame of the recording; @throws std::out_of_range for a frame that there is not
io::TransformSample poseOfFrame(const io::Recording& recording, int frame, const std::string& name, double latencySec);

/// What a person should know of a latency: that the recording has one already, and what is done. Nothing where it has none.
/// @throws io::FileError where a latency is asked for that cannot be applied: frames more than half a second apart, as a session's are
std::vector<std::string> latencyNotes(const io::Recording& recording, double latencySec);

}  // namespace handeye
