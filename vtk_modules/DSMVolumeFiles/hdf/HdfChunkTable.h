// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunkTable_h
#define vol_HdfChunkTable_h

#include "DSMVolumeFiles/hdf/HdfChunkIndex.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vol
{

/// Table of the chunks of an HDF5 dataset, in memory. It has entries for stored chunks only, so its size depends on
/// the entries in the file, whatever the dimensions are.
class HdfChunkTable
{
public:
  /// Probably so many will be added.
  void Reserve(std::uint64_t count);
  /// In any order. `number`: along the dataset's axes, of which the last one is the fastest.
  void Add(std::uint64_t number, const HdfChunk& chunk);
  /// After the last one was added. Returns false where a chunk was added twice.
  bool Sort();
  /// Null if the chunk is missing. Any thread.
  const HdfChunk* Find(std::uint64_t number) const;

  std::size_t GetCount() const { return this->Entries.size(); }
  std::uint64_t GetBytes() const;
  /// Shifts the bits of skipped filters by one, for a filter that is put in front of all others.
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
