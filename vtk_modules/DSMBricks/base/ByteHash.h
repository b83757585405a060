// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ByteHash_h
#define bricks_ByteHash_h

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// 64-bit FNV-1a over words of eight bytes, with a fold that carries their high bits down: for all
/// practical purposes, equal only for equal bytes.
class ByteHash
{
public:
  void Add(const void* data, std::size_t bytes)
  {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t index = 0; index < bytes; index += sizeof(std::uint64_t))
    {
      std::uint64_t word = 0;
      std::memcpy(&word, at + index, std::min(sizeof(word), bytes - index));
      this->Value = AddWord(this->Value, word);
    }
  }

  std::uint64_t Get() const { return this->Value; }

  /// One step: the hash of what `state` is the hash of, and a word behind it.
  static std::uint64_t AddWord(std::uint64_t state, std::uint64_t word)
  {
    state = (state ^ word) * 0x100000001b3ull;
    return state ^ state >> 32;
  }

private:
  std::uint64_t Value = 0xcbf29ce484222325ull;
};

} // namespace bricks

#endif
