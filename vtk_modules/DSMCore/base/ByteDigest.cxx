// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/ByteDigest.h"

#include "DSMCore/base/InterleavedHash.h"

#include <algorithm>
#include <cstring>

namespace dsm
{

namespace
{

using Halves = std::array<std::uint64_t, 2>;

/// One step of each half: multiplied by an odd number, then the high bits folded down; both can be undone.
void Mix(Halves& state, std::uint64_t first, std::uint64_t second)
{
  state[0] = (state[0] ^ first) * 0x9fb21c651e98df25u;
  state[0] ^= state[0] >> 32;
  state[1] = ((state[1] << 27 | state[1] >> 37) + second) * 0xd6e8feb86659fd93u;
  state[1] ^= state[1] >> 29;
}

} // namespace

void ByteDigest::Add(const std::byte* bytes, std::size_t count)
{
  const auto mixWord = [](Halves& state, std::uint64_t word) { Mix(state, word, word); };
  std::array<Halves, 4> lanes{ { { 1, 5 }, { 2, 6 }, { 3, 7 }, { 4, 8 } } };
  std::size_t at = HashInterleaved(bytes, count, lanes, mixWord);
  for (const auto& [first, second] : lanes)
  {
    Mix(this->State, first, second);
  }
  for (; at < count; at += sizeof(std::uint64_t))
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, std::min(sizeof(word), count - at));
    mixWord(this->State, word);
  }
  mixWord(this->State, count);
}

} // namespace dsm
