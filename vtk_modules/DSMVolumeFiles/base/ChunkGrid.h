// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ChunkGrid_h
#define vol_ChunkGrid_h

#include "DSMBricks/base/Box.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <glm/ext/vector_uint3_sized.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace vol
{

/// How an array is cut into chunks: boxes of samples, all alike but those that the volume's end cuts off.
/// Indices count from the array's first sample; x is the fastest axis.
struct ChunkGrid
{
  bricks::Index3 Samples{ 0 };
  bricks::Index3 ChunkSamples{ 1 };

  /// Chunks along each axis.
  bricks::Index3 GetCounts() const
  {
    return (this->Samples + this->ChunkSamples - bricks::Index3(1)) / this->ChunkSamples;
  }
  std::int64_t GetCount() const
  {
    const bricks::Index3 counts = this->GetCounts();
    return counts.x * counts.y * counts.z;
  }
  std::int64_t GetNumber(const bricks::Index3& chunk) const
  {
    const bricks::Index3 counts = this->GetCounts();
    return (chunk.z * counts.y + chunk.y) * counts.x + chunk.x;
  }
  bricks::Index3 GetChunk(std::int64_t number) const
  {
    const bricks::Index3 counts = this->GetCounts();
    return { number % counts.x, number / counts.x % counts.y, number / (counts.x * counts.y) };
  }
  /// Returns whether a box has all samples of the grid, and no others.
  bool IsWhole(const bricks::Box& box) const
  {
    return box.Min == bricks::Index3(0) && box.Max == this->Samples;
  }
  /// Chunks that have samples of a box, which is not empty.
  bricks::Box GetChunks(const bricks::Box& box) const
  {
    return { box.Min / this->ChunkSamples,
      (box.Max - bricks::Index3(1)) / this->ChunkSamples + bricks::Index3(1) };
  }
  /// The samples of a chunk that belong to the volume.
  bricks::Box GetBox(const bricks::Index3& chunk) const
  {
    const bricks::Index3 first = chunk * this->ChunkSamples;
    return { first, glm::min(first + this->ChunkSamples, this->Samples) };
  }
  /// The chunk with the first samples of its upper neighbors along each axis: what a brick that begins with it has.
  bricks::Box GetBoxWithHalo(const bricks::Index3& chunk) const
  {
    const bricks::Index3 first = chunk * this->ChunkSamples;
    return { first, glm::min(first + this->ChunkSamples + bricks::Index3(1), this->Samples) };
  }
  /// The latter alone, in three boxes that do not overlap: beyond the chunk on x, then on y, then on z. At the
  /// volume's ends some are empty.
  std::array<bricks::Box, 3> GetHalo(const bricks::Index3& chunk) const
  {
    const bricks::Box own = this->GetBox(chunk);
    std::array<bricks::Box, 3> halo;
    halo.fill(this->GetBoxWithHalo(chunk));
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto place = static_cast<std::size_t>(axis);
      halo[place].Min[axis] = own.Max[axis];
      for (std::size_t later = place + 1; later < halo.size(); ++later)
      {
        halo[later].Max[axis] = own.Max[axis];
      }
    }
    return halo;
  }
  /// Bytes of the chunks that a box of so many samples along each axis lies in, at most; 2^56 where it would be more,
  /// so that callers can add up what a file declares.
  std::uint64_t CountBytesOfChunks(std::int64_t samples, std::size_t sampleBytes) const
  {
    constexpr std::uint64_t greatest = std::uint64_t(1) << 56;
    const bricks::Index3 most =
      (bricks::Index3(samples - 2) + this->ChunkSamples) / this->ChunkSamples + bricks::Index3(1);
    const glm::u64vec3 chunks(glm::min(most, this->GetCounts()));
    const glm::u64vec3 chunk(glm::min(this->ChunkSamples, this->Samples));
    return MultiplyWithin(
      greatest, { chunks.x, chunks.y, chunks.z, chunk.x, chunk.y, chunk.z, sampleBytes })
      .value_or(greatest);
  }
  /// Samples of it, at most.
  std::size_t CountMostOfHalo() const
  {
    // (x + 1)(y + 1)(z + 1) - xyz. Faces of a chunk whose bytes can be counted have at most 2^62 samples each.
    const glm::u64vec3 own(this->ChunkSamples);
    return own.x * own.y + own.y * own.z + own.z * own.x + own.x + own.y + own.z + 1;
  }
};

} // namespace vol

#endif
