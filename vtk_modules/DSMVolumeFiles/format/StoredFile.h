// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_StoredFile_h
#define vol_StoredFile_h

#include "DSMCore/base/Error.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/base/SpaceOrder.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/PackedValues.h"
#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>
#include <optional>
#include <vector>

namespace vol
{

/// A volume whose chunks are, each by itself, somewhere in files. The formats say where.
class StoredFile : public VolumeFile
{
public:
  void ReadChunk(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override;
  bool ReadPart(std::size_t array, int step, const bricks::Index3& chunk, const bricks::Box& part,
    std::byte* out) const override;
  bool ReadWithHalo(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override;

  void Prefetch(std::size_t array, int step, const std::vector<ChunkPart>& parts) const override;
  bool IsFill(std::size_t array, int step, const bricks::Box& box) const override;

protected:
  using VolumeFile::VolumeFile;

  /// Place of the bytes of a chunk.
  struct Place
  {
    std::shared_ptr<const PositionedFile> File;
    std::uint64_t Offset = 0;
    std::size_t Bytes = 0;
    unsigned SkippedSteps = 0; ///< bits of the codec steps that were skipped
    std::size_t Slice = 0;     ///< which of Storage::Slices
  };

  /// How the chunks of an array are kept.
  struct Storage
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
    /// As many boxes of samples are in one piece of stored bytes, one behind the other: a chunk of an array with
    /// more axes than three.
    std::size_t Slices = 1;
    /// Chunks, which are whole ones then, and of one slice, probably have a halo.
    bool HasHalo = false;
    /// Size of the HaloRecord behind each chunk, in bytes; 0: the halo is in the chunk.
    std::size_t HaloRecordBytes = 0;
  };

  /// None: all samples of the chunk have the fill value. `chunk` is one of GetStoredGrid.
  virtual std::optional<Place> FindChunk(
    std::size_t array, int step, const bricks::Index3& chunk) const = 0;

  /// Returns whether FindChunk would return nothing, if that is known without a look at the file system.
  virtual bool IsMissing(std::size_t, int /*step*/, const bricks::Index3& /*chunk*/) const
  {
    return false;
  }

  /// How the array is cut in the file.
  ChunkGrid GetStoredGrid(std::size_t array) const;

  /// Divides each chunk into several of neighboring rows, if the chunks that a brick lies in are large
  /// together, as slices are, and if rows of a chunk can be read separately. Then readers hold only the rows
  /// that they need.
  static void CutPlainChunks(FileArray& array, Storage& storage);

  std::vector<Storage> Storages; ///< one for each array

  /// Returns the bytes of a sample's numbers in the file.
  std::size_t GetStoredBytes(std::size_t array) const;
  /// Makes values of so many samples of an array: `read(to)` reads their numbers.
  void Unpack(std::size_t array, std::int64_t samples, std::byte* out,
    const dsm::FunctionRef<void(std::byte* to)>& read) const;

private:
  /// As ReadChunk, with numbers as they are stored.
  void ReadStored(std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const;
  /// Repeats the bytes of `fill` until `out` has so many bytes.
  static void FillWith(const std::vector<std::byte>& fill, std::byte* out, std::size_t bytes);
  /// Throws dsm::Error when the stored size of a chunk cannot be right for its `bytes`. Called before memory is
  /// allocated for the chunk.
  void CheckStored(std::size_t array, const Place& place, std::size_t bytes) const;
  /// Which chunk of the file a chunk is of, or a part of.
  bricks::Index3 FindStored(std::size_t array, const bricks::Index3& chunk) const;
  /// The samples of a chunk of the file, those beyond the volume's ends included where it has them.
  bricks::Box GetStoredBox(std::size_t array, const bricks::Index3& whole) const;
  /// The rows of a part of a chunk of the file; none where that can only be read as a whole.
  std::vector<PositionedFile::Piece> FindPieces(std::size_t array, const Place& place,
    const bricks::Index3& whole, const bricks::Box& part) const;
  /// Reads pieces that have so many bytes in total.
  static void ReadPieces(const Storage& storage, const Place& place,
    const std::vector<PositionedFile::Piece>& pieces, std::byte* out, std::size_t bytes);
};

} // namespace vol

#endif
