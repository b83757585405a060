// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunkTable_h
#define vol_HdfChunkTable_h

#include "DSMVolumeFiles/format/HdfChunkIndex.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vol
{

/// Where the chunks of an HDF5 dataset are, in memory: of those that are there only, so that it takes as much memory as
/// the file has entries for them, whatever its dimensions say.
class HdfChunkTable
{
public:
  /// Probably so many will be added.
  void Reserve(std::uint64_t count);
  /// In any order. `number`: along the dataset's axes, of which the last one is the fastest.
  void Add(std::uint64_t number, const HdfChunk& chunk);
  /// After the last one was added. Returns false where a chunk was added twice.
  bool Sort();
  /// Null where the chunk is not there. Any thread.
  const HdfChunk* Find(std::uint64_t number) const;

  std::size_t GetCount() const { return this->Entries.size(); }
  std::uint64_t GetBytes() const;
  /// Of filters that chunks were written without: the bits of one filter more in front of all.
  void AddFilterInFront();

private:
  struct Entry
  {
    std::uint64_t Number;
    HdfChunk Chunk;
  };
  std::vector<Entry> Entries; ///< in the order of their numbers, once they are sorted
  bool IsSorted = true;       ///< and no number is there twice
};

} // namespace vol

#endif
