// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_FileSamples_h
#define vol_FileSamples_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/build/VoxelSource.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include <cstddef>
#include <memory>

namespace vol
{

/// Samples of an array in a file, of one component or the magnitude of all, read through a cache of chunks, which must
/// outlive it. Any thread.
class FileSamples final : public bricks::VoxelSource
{
public:
  static constexpr int Magnitude = -1;
  /// Part of the array to read.
  struct Part
  {
    bricks::Box Samples; ///< in the file's indices; those of the source count from the first one
    int Component = 0;   ///< also Magnitude
    bricks::ScalarType Type; ///< the array's; of a magnitude Float32 or Float64
  };

  /// `scattered`: boxes are read here and there, rather than one beside the other.
  FileSamples(const ArrayStep& of, const Part& part, ChunkCache& cache, bool scattered = false);
  /// All samples of an array on points that has one component.
  FileSamples(const ArrayStep& of, ChunkCache& cache, bool scattered = false);

  bricks::Box GetCells() const override;
  void ReadSamples(const bricks::Box& points, std::byte* out) const override;
  bool IsFill(const bricks::Box& points) const override;

private:
  void ReadBox(const bricks::Box& points, std::byte* out) const;

  ArrayStep Of;
  Part Read;
  ChunkCache& Cache;
  bool Scattered;
};

} // namespace vol

#endif
