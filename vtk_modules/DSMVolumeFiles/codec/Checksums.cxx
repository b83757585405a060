// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/Checksums.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace vol
{

std::uint32_t GetFletcher32(const std::byte* bytes, std::size_t count)
{
  // As many words as cannot overflow the sums.
  constexpr std::size_t batch = 360;
  std::uint32_t sum = 0;
  std::uint32_t sumOfSums = 0;
  const auto fold = [](std::uint32_t value) { return (value & 0xffff) + (value >> 16); };
  for (std::size_t at = 0; at < count;)
  {
    const std::size_t end = std::min(count, at + 2 * batch);
    for (; at < end; at += 2)
    {
      const auto high = std::to_integer<std::uint32_t>(bytes[at]);
      const auto low = at + 1 < count ? std::to_integer<std::uint32_t>(bytes[at + 1]) : 0u;
      sum += high << 8 | low;
      sumOfSums += sum;
    }
    sum = fold(sum);
    sumOfSums = fold(sumOfSums);
  }
  return fold(sumOfSums) << 16 | fold(sum);
}

std::uint32_t GetCrc32c(const std::byte* bytes, std::size_t count)
{
  static const std::array<std::uint32_t, 256> table = []
  {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t byte = 0; byte < 256; ++byte)
    {
      std::uint32_t value = byte;
      for (int bit = 0; bit < 8; ++bit)
      {
        value = value >> 1 ^ (value & 1 ? 0x82f63b78u : 0u);
      }
      entries[byte] = value;
    }
    return entries;
  }();
  std::uint32_t value = ~0u;
  for (std::size_t at = 0; at < count; ++at)
  {
    value = value >> 8 ^ table[(value ^ std::to_integer<std::uint32_t>(bytes[at])) & 0xff];
  }
  return ~value;
}

std::uint32_t GetLookup3(const std::byte* bytes, std::size_t count)
{
  const auto rotate = [](std::uint32_t value, int bits)
  { return value << bits | value >> (32 - bits); };
  std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(count);
  std::uint32_t b = a;
  std::uint32_t c = a;
  // Bytes beyond the end count as 0.
  const auto getWord = [&](std::size_t place)
  {
    std::uint32_t word = 0;
    for (std::size_t byte = 0; byte < 4 && place + byte < count; ++byte)
    {
      word |= std::to_integer<std::uint32_t>(bytes[place + byte]) << (8 * byte);
    }
    return word;
  };
  std::size_t at = 0;
  const auto addWords = [&]
  {
    a += getWord(at);
    b += getWord(at + 4);
    c += getWord(at + 8);
  };
  const auto turn = [&] { std::tie(a, b, c) = std::make_tuple(b, c, a); };
  for (; count - at > 12; at += 12)
  {
    addWords();
    for (const int bits : { 4, 6, 8, 16, 19, 4 })
    {
      a = (a - c) ^ rotate(c, bits);
      c += b;
      turn();
    }
  }
  if (at < count)
  {
    addWords();
    for (const int bits : { 14, 11, 25, 16, 4, 14, 24 })
    {
      c = (c ^ b) - rotate(b, bits);
      turn();
    }
    return b; // that of the last turn
  }
  return c;
}

} // namespace vol
