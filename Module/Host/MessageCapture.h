// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LogModel.h"

#include <vtkSmartPointer.h>

class vtkOutputWindow;

namespace desktop
{

/// While it lives, messages of Qt and VTK, from any thread, go into a log as well as to the standard error. One at a time.
class MessageCapture
{
public:
  explicit MessageCapture(LogModel& log);
  ~MessageCapture();

  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

private:
  vtkSmartPointer<vtkOutputWindow> FormerWindow;
};

}  // namespace desktop
