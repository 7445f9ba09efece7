// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace handeye::devices
{

/// The checksum of OpenIGTLink's bodies: CRC-64 of ECMA-182 (polynomial 0x42F0E1EBA9EA3693, highest bit first, no inversion).
///
/// libopenigtlink's crc64() gives the same number byte by byte: 15 ms for a frame of full HD, which is most of a frame's time at
/// 60 Hz. This one folds 64 bytes at a time with carry-less multiplication where the processor has it, otherwise it takes 8 bytes
/// a step from tables.
/// Thread-safe.
/// Reference: Gopal et al., "Fast CRC computation for generic polynomials using PCLMULQDQ instruction", Intel 2009.
std::uint64_t crc64Ecma(const void* bytes, std::size_t count, std::uint64_t crc = 0);

/// The same by tables alone; for tests.
std::uint64_t crc64EcmaByTables(const void* bytes, std::size_t count, std::uint64_t crc = 0);

}  // namespace handeye::devices
