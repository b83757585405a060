// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ByteDigest_h
#define dsm_ByteDigest_h

#include <array>
#include <cstddef>
#include <cstdint>

namespace dsm
{

/// Returns the 64-bit XXH3 hash of bytes; the same on all machines. It is not safe against crafted input.
/// `seed`: for example the hash of the bytes before.
std::uint64_t HashBytes(const void* data, std::size_t bytes, std::uint64_t seed = 0);

/// A hash of 128 bits (XXH3): equal, for all practical purposes, only for equal bytes that were added in equal parts.
class ByteDigest
{
public:
  void Add(const std::byte* bytes, std::size_t count);

  bool operator==(const ByteDigest& other) const { return this->State == other.State; }
  bool operator!=(const ByteDigest& other) const { return !(*this == other); }

private:
  std::array<std::uint64_t, 2> State{};
};

} // namespace dsm

#endif
