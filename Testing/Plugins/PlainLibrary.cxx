// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A whole shared library, and no plugin.
extern "C" int plainLibraryAnswer()
{
  return 42;
}
