// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Crc64.h"

#include <array>
#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define HANDEYE_HAS_FOLDING 1
#endif

namespace handeye::devices
{

namespace
{

constexpr std::uint64_t Polynomial = 0x42F0E1EBA9EA3693ULL;

using Tables = std::array<std::array<std::uint64_t, 256>, 8>;

Tables makeTables()
{
  Tables tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte)
  {
    std::uint64_t crc = byte << 56;
    for (int bit = 0; bit < 8; ++bit)
    {
      crc = (crc << 1) ^ ((crc >> 63) != 0 ? Polynomial : 0);
    }
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k)
  {
    for (std::size_t byte = 0; byte < 256; ++byte)
    {
      const std::uint64_t crc = tables[k - 1][byte];
      tables[k][byte] = (crc << 8) ^ tables[0][crc >> 56];
    }
  }
  return tables;
}

std::uint64_t loadBigEndian(const std::uint8_t* bytes)
{
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof(value));
  return __builtin_bswap64(value);
}

#ifdef HANDEYE_HAS_FOLDING

/// x^n modulo the polynomial.
std::uint64_t powerOfX(int n)
{
  std::uint64_t value = 1;
  for (int i = 0; i < n; ++i)
  {
    value = (value << 1) ^ ((value >> 63) != 0 ? Polynomial : 0);
  }
  return value;
}

/// Multiplies a block by x^distance: the high half by x^(distance + 64), the low one by x^distance, both modulo the polynomial.
struct Fold
{
  std::uint64_t low, high;
  explicit Fold(int distance)
    : low(powerOfX(distance))
    , high(powerOfX(distance + 64))
  {
  }
};

__attribute__((target("pclmul,ssse3"))) inline __m128i folded(__m128i block, __m128i factors)
{
  return _mm_xor_si128(_mm_clmulepi64_si128(block, factors, 0x11), _mm_clmulepi64_si128(block, factors, 0x00));
}

/// The first 64 n bytes; leaves in `rest` 16 bytes whose checksum (from 0) is that of all of them.
__attribute__((target("pclmul,ssse3"))) std::size_t foldBlocks(
  const std::uint8_t* bytes, std::size_t count, std::uint64_t crc, std::uint8_t* rest)
{
  static const Fold by512(512), by128(128);
  const __m128i swap = _mm_set_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m128i far = _mm_set_epi64x(std::int64_t(by512.high), std::int64_t(by512.low));
  const __m128i near = _mm_set_epi64x(std::int64_t(by128.high), std::int64_t(by128.low));
  const auto load = [&](std::size_t at) __attribute__((target("pclmul,ssse3")))
  {
    return _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + at)), swap);
  };
  __m128i a = _mm_xor_si128(load(0), _mm_set_epi64x(std::int64_t(crc), 0));
  __m128i b = load(16), c = load(32), d = load(48);
  std::size_t done = 64;
  for (; done + 64 <= count; done += 64)
  {
    a = _mm_xor_si128(folded(a, far), load(done));
    b = _mm_xor_si128(folded(b, far), load(done + 16));
    c = _mm_xor_si128(folded(c, far), load(done + 32));
    d = _mm_xor_si128(folded(d, far), load(done + 48));
  }
  b = _mm_xor_si128(folded(a, near), b);
  c = _mm_xor_si128(folded(b, near), c);
  d = _mm_xor_si128(folded(c, near), d);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(rest), _mm_shuffle_epi8(d, swap));
  return done;
}

bool canFold()
{
  static const bool can = __builtin_cpu_supports("pclmul") != 0 && __builtin_cpu_supports("ssse3") != 0;
  return can;
}

#endif

}  // namespace

std::uint64_t crc64EcmaByTables(const void* bytes, std::size_t count, std::uint64_t crc)
{
  static const Tables tables = makeTables();
  const auto* next = static_cast<const std::uint8_t*>(bytes);
  for (; count >= 8; count -= 8, next += 8)
  {
    const std::uint64_t word = crc ^ loadBigEndian(next);
    crc = 0;
    for (std::size_t k = 0; k < 8; ++k)
    {
      crc ^= tables[k][(word >> (8 * k)) & 0xFF];
    }
  }
  for (; count > 0; --count, ++next)
  {
    crc = (crc << 8) ^ tables[0][(crc >> 56) ^ *next];
  }
  return crc;
}

std::uint64_t crc64Ecma(const void* bytes, std::size_t count, std::uint64_t crc)
{
#ifdef HANDEYE_HAS_FOLDING
  if (count >= 128 && canFold())
  {
    std::uint8_t rest[16];
    const auto* first = static_cast<const std::uint8_t*>(bytes);
    const std::size_t done = foldBlocks(first, count, crc, rest);
    return crc64EcmaByTables(first + done, count - done, crc64EcmaByTables(rest, sizeof(rest)));
  }
#endif
  return crc64EcmaByTables(bytes, count, crc);
}

}  // namespace handeye::devices
