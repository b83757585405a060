// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/FragmentDigests.h"

#include <cstring>

namespace dsm
{

namespace
{

/// One step of each half: multiplied by an odd number, then the high bits folded down; both can be undone.
std::uint64_t MixFirst(std::uint64_t state, std::uint64_t word)
{
  state = (state ^ word) * 0x9fb21c651e98df25u;
  return state ^ state >> 32;
}

std::uint64_t MixSecond(std::uint64_t state, std::uint64_t word)
{
  state = ((state << 27 | state >> 37) + word) * 0xd6e8feb86659fd93u;
  return state ^ state >> 29;
}

} // namespace

void ByteDigest::AddWord(std::uint64_t word)
{
  this->Halves[0] = MixFirst(this->Halves[0], word);
  this->Halves[1] = MixSecond(this->Halves[1], word);
}

void ByteDigest::Add(const std::byte* bytes, std::size_t count)
{
  // Interleaved, as a processor does several multiplications at once that do not wait for one another.
  constexpr std::size_t lanes = 4;
  constexpr std::size_t step = lanes * sizeof(std::uint64_t);
  std::array<std::uint64_t, lanes> first{ 1, 2, 3, 4 };
  std::array<std::uint64_t, lanes> second{ 5, 6, 7, 8 };
  std::size_t at = 0;
  for (; at + step <= count; at += step)
  {
    std::array<std::uint64_t, lanes> words;
    std::memcpy(words.data(), bytes + at, step);
    for (std::size_t lane = 0; lane < lanes; ++lane)
    {
      first[lane] = MixFirst(first[lane], words[lane]);
      second[lane] = MixSecond(second[lane], words[lane]);
    }
  }
  for (std::size_t lane = 0; lane < lanes; ++lane)
  {
    this->Halves[0] = MixFirst(this->Halves[0], first[lane]);
    this->Halves[1] = MixSecond(this->Halves[1], second[lane]);
  }
  for (; at < count; at += sizeof(std::uint64_t))
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, count - at < sizeof(word) ? count - at : sizeof(word));
    this->AddWord(word);
  }
  this->AddWord(count);
}

void FragmentDigests::Add(const Fragment& fragment)
{
  if (fragment.Block < this->Digests.size())
  {
    this->Digests[fragment.Block].Add(fragment.Bytes.data(), fragment.Bytes.size());
  }
}

bool NotingFragmentSource::Next(Fragment& fragment)
{
  const bool any = this->Source.Next(fragment);
  if (any)
  {
    this->Digests.Add(fragment);
  }
  return any;
}

} // namespace dsm
