// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nothing but the headers that the tests share: CMake precompiles them for this file.
