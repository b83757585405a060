// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_FileSamples_h
#define vol_FileSamples_h

#include "DSMBricks/build/VoxelSource.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include <cstddef>
#include <memory>
#include <utility>

namespace vol
{

/// All samples of an array on points, of one component, in a file, read through a cache of chunks, which must outlive
/// it. Any thread.
class FileSamples final : public bricks::VoxelSource
{
public:
  /// `scattered`: boxes are read here and there, rather than one beside the other.
  FileSamples(std::shared_ptr<const VolumeFile> file, std::size_t array, int step,
    ChunkCache& cache, bool scattered = false)
    : File(std::move(file))
    , Array(array)
    , Step(step)
    , Cache(cache)
    , Scattered(scattered)
  {
  }
  bricks::Box GetCells() const override
  {
    return { bricks::Index3(0), this->File->GetGeometry().Points - bricks::Index3(1) };
  }
  void ReadSamples(const bricks::Box& points, std::byte* out) const override
  {
    this->Scattered ? this->Cache.ReadScattered(this->File, this->Array, this->Step, points, out)
                    : this->Cache.ReadBox(this->File, this->Array, this->Step, points, out);
  }

private:
  std::shared_ptr<const VolumeFile> File;
  std::size_t Array;
  int Step;
  ChunkCache& Cache;
  bool Scattered;
};

} // namespace vol

#endif
