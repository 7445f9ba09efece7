// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "StudyTasks.h"

#include <vector>

namespace handeye::study
{

/// Puts the tasks of a camera together: every repetition and eye becomes a capture of each method. Internal.
void poolTasks(const std::vector<StudyTask>& tasks, int camera, StudyCameraResult& result);

}  // namespace handeye::study
