// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ChunkStorage_h
#define vol_ChunkStorage_h

#include "DSMVolumeFiles/base/SpaceOrder.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/PackedValues.h"
#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vol
{

/// Chunks are cut, or read in parts, if those that a box lies in take more than this together, in bytes.
constexpr std::uint64_t MostChunkBytesTogether = std::uint64_t(16) << 20;

/// How the chunks of an array are kept.
struct ChunkStorage
{
  ChunkCodec Codec;
  PackedValues Packed;
  /// Numbers of a chunk that is not stored: one sample, or one component if all are equal.
  std::vector<std::byte> Fill;
  /// Samples along each axis of a chunk in the file, where it is shown as several (CutPlainChunks); else 0.
  bricks::Index3 StoredSamples{ 0 };
  /// Chunks at the volume's ends are as large as all others; else they end with it.
  bool HasWholeChunks = true;
  SpaceOrder Order = FastestX; ///< of the samples of a chunk
  /// All samples of a component follow one another in a chunk that is shown as several; else the components of a
  /// sample do.
  bool ComponentsApart = false;
  /// As many boxes of samples are in one piece of stored bytes, one behind the other: a chunk of an array with
  /// more axes than three.
  std::size_t Slices = 1;
  /// Chunks, which are whole ones then, and of one slice, probably have a halo.
  bool HasHalo = false;
  /// Size of the HaloRecord behind each chunk, in bytes; 0: the halo is in the chunk.
  std::size_t HaloRecordBytes = 0;
};

/// Cuts `samples` of so many bytes each into boxes of at most 1 MiB: samples that are close in space are in few of
/// them.
ChunkGrid CutIntoBoxes(const bricks::Index3& samples, std::size_t sampleBytes);
/// Cuts them into rows that follow one another, or planes if a plane is small.
ChunkGrid CutIntoRows(const bricks::Index3& samples, std::size_t sampleBytes);

/// Divides each chunk into several of neighboring rows, if the chunks that a brick lies in are large
/// together, as slices are, and if rows of a chunk can be read separately. Then readers hold only the rows
/// that they need.
void CutPlainChunks(FileArray& array, ChunkStorage& storage);

} // namespace vol

#endif
