// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ByteDigest_h
#define dsm_ByteDigest_h

#include <array>
#include <cstddef>
#include <cstdint>

namespace dsm
{

/// A hash of 128 bits, of bytes that nobody made up to deceive it: two halves that mix the same words in
/// unlike ways. Each step can be undone when the word is known, so bytes that differ in one word never
/// have the same.
class ByteDigest
{
public:
  void Add(const std::byte* bytes, std::size_t count);

  bool operator==(const ByteDigest& other) const { return this->State == other.State; }
  bool operator!=(const ByteDigest& other) const { return !(*this == other); }

private:
  std::array<std::uint64_t, 2> State{ 0x9e3779b97f4a7c15u, 0xc2b2ae3d27d4eb4fu };
};

} // namespace dsm

#endif
