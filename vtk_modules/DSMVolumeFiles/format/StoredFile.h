// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_StoredFile_h
#define vol_StoredFile_h

#include "DSMCore/base/Error.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMVolumeFiles/base/ByteSource.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/format/ChunkStorage.h"
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
    std::shared_ptr<const ByteSource> File;
    std::uint64_t Offset = 0;
    std::size_t Bytes = 0;
    unsigned SkippedSteps = 0; ///< bits of the codec steps that were skipped
    std::size_t Slice = 0;     ///< which of ChunkStorage::Slices
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

  std::vector<ChunkStorage> Storages; ///< one for each array

  /// Returns the bytes of a sample's numbers in the file.
  std::size_t GetStoredBytes(std::size_t array) const;
  /// Makes values of so many samples of an array: `read(to)` reads their numbers.
  void Unpack(std::size_t array, std::int64_t samples, std::byte* out,
    const dsm::FunctionRef<void(std::byte* to)>& read) const;

private:
  /// As ReadChunk, with numbers as they are stored.
  void ReadStored(std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const;
  /// Throws dsm::Error when the stored size of a chunk cannot be right for its `bytes`. Called before memory is
  /// allocated for the chunk.
  void CheckStored(std::size_t array, const Place& place, std::size_t bytes) const;
  /// Which chunk of the file a chunk is of, or a part of.
  bricks::Index3 FindStored(std::size_t array, const bricks::Index3& chunk) const;
  /// The samples of a chunk of the file, those beyond the volume's ends included where it has them.
  bricks::Box GetStoredBox(std::size_t array, const bricks::Index3& whole) const;
  /// The rows of a part of a chunk of the file; none if the chunk can only be read entirely.
  std::vector<ByteSource::Piece> FindPieces(std::size_t array, const Place& place,
    const bricks::Index3& whole, const bricks::Box& part) const;
  /// Reads pieces that have so many bytes in total.
  void ReadPieces(std::size_t array, const Place& place,
    const std::vector<ByteSource::Piece>& pieces, std::byte* out, std::size_t bytes) const;
  /// Where an error is, in a chunk of an array, which is `whole` of the file's.
  FileError::Place NamePlace(std::size_t array, const Place& place, const bricks::Index3& chunk,
    const bricks::Index3& whole) const;
};

} // namespace vol

#endif
