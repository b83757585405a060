// SPDX-License-Identifier: BSD-3-Clause
#ifndef NumberedWords_h
#define NumberedWords_h

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/store/BlockStore.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

/// Data of which every access can be checked, and the accesses.

namespace AccessTiming
{

/// Every 64-bit word of the data holds its own number, so that every access can be checked.
class NumberSource final : public dsm::FragmentSource
{
public:
  NumberSource(const dsm::BlockDirectory& directory, int rank)
    : Directory(directory)
    , Rank(rank)
  {
  }
  bool Next(dsm::Fragment& fragment) override
  {
    while (
      this->Id < this->Directory.GetCount() && this->Directory.GetOwner(this->Id) != this->Rank)
    {
      ++this->Id;
    }
    if (this->Id >= this->Directory.GetCount())
    {
      return false;
    }
    fragment.Block = this->Id++;
    fragment.Bytes.clear();
    return true;
  }
  double GetProgress() const override { return 0.0; }

private:
  const dsm::BlockDirectory& Directory;
  int Rank;
  dsm::BlockId Id = 0;
};

inline void FillWithNumbers(std::byte* bytes, std::size_t count, std::uint64_t first)
{
  for (std::size_t at = 0; at < count; at += sizeof(first), ++first)
  {
    std::memcpy(bytes + at, &first, sizeof(first));
  }
}

class NumberSink final : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId, std::byte*, std::size_t) override {}
  void Absorb(
    dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte*, std::size_t) override
  {
    FillWithNumbers(block, bytes, id * (bytes / sizeof(std::uint64_t)));
  }
  void Finish(dsm::BlockId, std::byte*, std::size_t) override {}
};

inline std::shared_ptr<dsm::BlockSegment> PublishNumbers(
  dsm::Messenger& messenger, dsm::BlockStore& store, std::uint64_t bytes, std::uint32_t blockBytes)
{
  const dsm::BlockDirectory directory(std::vector<std::uint32_t>(bytes / blockBytes, blockBytes),
    dsm::RoundRobinAssigner(messenger.GetSize()));
  NumberSource source(directory, messenger.GetRank());
  NumberSink sink;
  return store.Publish("the numbers", directory, source, sink);
}

/// xorshift64; the same for the array and the stores.
struct Random
{
  std::uint64_t State;
  std::uint64_t operator()()
  {
    this->State ^= this->State << 13;
    this->State ^= this->State >> 7;
    this->State ^= this->State << 17;
    return this->State;
  }
};

/// Reads words at random: one of `blocks` blocks that `choose` names by a number below it, then a
/// word of it. Dependent: the next place is not known before the word is read, so the processor
/// cannot read ahead. Returns 0 when all words were right.
template <bool Dependent, class Choose, class Get>
std::uint64_t ReadWords(std::uint64_t count, std::uint64_t blocks, std::uint64_t words,
  std::uint64_t seed, const Choose& choose, const Get& get)
{
  Random random{ seed * 0x9e3779b97f4a7c15u + 1 };
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < count; ++i)
  {
    const std::uint64_t number = random();
    const std::uint64_t block = choose(((number >> 32) * blocks) >> 32);
    const std::uint64_t word = number & (words - 1);
    const std::uint64_t error = get(block, word) - (block * words + word);
    if constexpr (Dependent)
    {
      random.State ^= error;
    }
    wrong |= error;
  }
  return wrong;
}

template <class Choose, class Get>
std::uint64_t ReadWords(std::uint64_t count, std::uint64_t blocks, std::uint64_t words,
  std::uint64_t seed, bool dependent, const Choose& choose, const Get& get)
{
  return dependent ? ReadWords<true>(count, blocks, words, seed, choose, get)
                   : ReadWords<false>(count, blocks, words, seed, choose, get);
}

inline void CheckWords(std::uint64_t wrong)
{
  if (wrong != 0)
  {
    throw dsm::Error("A word that was read is not the word that was written.");
  }
}

} // namespace AccessTiming

#endif
