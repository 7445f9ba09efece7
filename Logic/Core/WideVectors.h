// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Before a function with a plain loop over numbers: compiled twice, for any processor and for those with AVX2, and the right one taken when
/// the program starts. Where the compiler cannot do that, compiled once.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&                           \
  !defined(__SANITIZE_THREAD__)
#define HANDEYE_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define HANDEYE_WIDE_VECTORS
#endif
