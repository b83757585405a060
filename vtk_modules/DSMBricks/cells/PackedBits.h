// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PackedBits_h
#define bricks_PackedBits_h

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// Returns how many bits a number has.
constexpr int CountBits(std::uint32_t number)
{
  int bits = 0;
  while (std::uint64_t(number) >> bits != 0)
  {
    ++bits;
  }
  return bits;
}

/// Returns at least 56 bits of `bytes`, from number `first` on, as the lowest ones. Eight bytes are read.
inline std::uint64_t ReadBits(const std::byte* bytes, std::size_t first)
{
  std::uint64_t word;
  std::memcpy(&word, bytes + first / 8, sizeof(word));
  return word >> first % 8;
}

/// Adds a number of at most 56 bits to bits that are zero. Eight bytes are written.
inline void WriteBits(std::byte* bytes, std::size_t first, std::uint64_t number)
{
  std::uint64_t word;
  std::memcpy(&word, bytes + first / 8, sizeof(word));
  word |= number << first % 8;
  std::memcpy(bytes + first / 8, &word, sizeof(word));
}

} // namespace bricks

#endif
