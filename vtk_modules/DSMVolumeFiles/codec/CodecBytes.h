// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_CodecBytes_h
#define vol_CodecBytes_h

#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

/// Helpers that the codecs share.
namespace vol::CodecBytes
{

/// Behind the compressed chunk, a halo has its size and this number, both of 32 bits, beside it: a skippable frame of
/// Zstandard (RFC 8878), "D" of those that are free for any use.
constexpr std::uint32_t HaloMagic = 0x184D2A50 + 0xD;
constexpr std::size_t HaloHeader = 2 * sizeof(std::uint32_t);

/// Little-endian, as AddNumber. `place` and the three bytes behind it must be there.
inline std::uint32_t GetNumber(const ByteBuffer& bytes, std::size_t place)
{
  std::uint32_t value = 0;
  for (std::size_t byte = sizeof(value); byte-- > 0;)
  {
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[place + byte]);
  }
  return value;
}

inline void AddNumber(ByteBuffer& bytes, std::uint32_t value)
{
  for (int byte = 0; byte < 4; ++byte)
  {
    bytes.push_back(static_cast<std::byte>(value >> (8 * byte) & 0xff));
  }
}

/// Returns the size of the buffer to decode to: no more than wanted, and no more than possible.
inline std::size_t GetRoom(const ByteBuffer& stored, std::uint64_t growth, std::size_t most)
{
  return static_cast<std::size_t>(MultiplyWithin(most, { stored.size(), growth }).value_or(most));
}

/// Returns the part of the bytes that begins and ends at these places.
inline ByteBuffer GetPart(const ByteBuffer& bytes, std::size_t first, std::size_t last)
{
  return ByteBuffer(bytes.begin() + static_cast<std::ptrdiff_t>(first),
    bytes.begin() + static_cast<std::ptrdiff_t>(last));
}

} // namespace vol::CodecBytes

#endif
