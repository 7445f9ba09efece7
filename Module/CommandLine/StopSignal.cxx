// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StopSignal.h"

#include <csignal>

namespace handeye::cli
{

namespace
{

volatile std::sig_atomic_t asked = 0;

extern "C" void ask(int signal)
{
  asked = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catchStopSignals()
{
  std::signal(SIGINT, ask);
  std::signal(SIGTERM, ask);
}

bool isStopAsked()
{
  return asked != 0;
}

}  // namespace handeye::cli
