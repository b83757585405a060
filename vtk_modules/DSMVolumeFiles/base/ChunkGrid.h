// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ChunkGrid_h
#define vol_ChunkGrid_h

#include "DSMRayTracing/base/Box.h"

#include <cstdint>

namespace vol
{

/// How an array is cut into chunks: boxes of samples, all alike but those that the volume's end cuts off.
/// Indices count from the array's first sample; x is the fastest axis.
struct ChunkGrid
{
  rt::Index3 Samples{ 0 };
  rt::Index3 ChunkSamples{ 1 };

  /// Chunks along each axis.
  rt::Index3 GetCounts() const
  {
    return (this->Samples + this->ChunkSamples - rt::Index3(1)) / this->ChunkSamples;
  }
  std::int64_t GetCount() const
  {
    const rt::Index3 counts = this->GetCounts();
    return counts.x * counts.y * counts.z;
  }
  std::int64_t GetNumber(const rt::Index3& chunk) const
  {
    const rt::Index3 counts = this->GetCounts();
    return (chunk.z * counts.y + chunk.y) * counts.x + chunk.x;
  }
  rt::Index3 GetChunk(std::int64_t number) const
  {
    const rt::Index3 counts = this->GetCounts();
    return { number % counts.x, number / counts.x % counts.y, number / (counts.x * counts.y) };
  }
  /// The samples of a chunk that belong to the volume.
  rt::Box GetBox(const rt::Index3& chunk) const
  {
    const rt::Index3 first = chunk * this->ChunkSamples;
    return { first, glm::min(first + this->ChunkSamples, this->Samples) };
  }
};

} // namespace vol

#endif
