// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_BrickFileWriter_h
#define vol_BrickFileWriter_h

#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

enum class Compression
{
  None,
  Deflate, ///< that every HDF5 library reads
  Zstd     ///< smaller and faster; others need HDF5's plugin for it
};

/// Contents of a brick file.
struct BrickFileLayout
{
  FileGeometry Geometry;
  /// Their grids' chunks are of BrickEdge samples along each axis, or of as many as there are.
  std::vector<FileArray> Arrays;
  int BrickEdge = 16;
  Compression Pressed = Compression::None;
  /// If true, uncompressed chunks also have a halo. A halo that lies behind its chunk is lost when the array is
  /// copied to another file.
  bool HasHaloRecords = true;

  /// Returns the codec for the chunks of an array. Throws dsm::Error when this build does not have the compression.
  ChunkCodec CreateCodec(std::size_t array) const;
  /// Returns whether the chunks of an array, which begin bricks, have a halo (ChunkGrid::GetHalo), so that a brick
  /// is read in one piece.
  bool HasHalo(std::size_t array) const;
  /// Returns the size of the HaloRecord behind each chunk, in bytes; 0 if there is none, or if the halo is in the
  /// chunk.
  std::size_t GetHaloRecordBytes(std::size_t array) const;
};

/// A chunk as the file has it.
struct EncodedChunk
{
  ByteBuffer Bytes;
  ByteBuffer HaloRecord; ///< empty if the layout has no halo records
};

/// Writes a volume that any HDF5 reader opens, as VTK's ImageData (VTKHDF), with an index of ranges beside it (the
/// group DSM; docs/files.md). Until it is whole, it consists of PartFiles. One rank's; one thread at a time.
class BrickFileWriter
{
public:
  /// Handling of the files of a writer that does not finish.
  enum class Unfinished
  {
    Keep,  ///< A later process resumes.
    Remove ///< The destructor removes them, and the constructor refuses to replace files that a process can resume.
  };

  /// Resumes PATH.part if it was begun for the same layout and `source` (a text that identifies the values)
  /// and is complete up to its end; otherwise starts again. Throws dsm::Error; then it has removed its own
  /// new files, and has not touched the files of another process or program.
  static std::unique_ptr<BrickFileWriter> Make(std::string path, const BrickFileLayout& layout,
    const std::string& source, Unfinished unfinished);
  virtual ~BrickFileWriter() = default;
  BrickFileWriter(const BrickFileWriter&) = delete;
  BrickFileWriter& operator=(const BrickFileWriter&) = delete;

  /// Chunks of an array that the file has, which are its first ones, in the order of their numbers.
  virtual std::int64_t GetChunks(std::size_t array) const = 0;

  /// Adds the next chunks of an array, whose values have these ranges; they stay if the process ends. Throws
  /// dsm::Error when the disk is full, or fails; the writer is of no use then.
  virtual void Add(
    std::size_t array, const std::vector<EncodedChunk>& chunks, const ValueRanges& ranges) = 0;

  /// When all chunks are there: PATH.part may be opened until Finish. Throws dsm::Error.
  virtual void Close() = 0;
  /// After Close: adds what is known of the bricks of each array (bricks::VoxelIndex as it is kept; empty: nothing)
  /// and the first coarser levels, which are brick files at PartFiles::GetLevel, and gives the file its name.
  /// Throws dsm::Error.
  virtual void Finish(const std::vector<std::vector<std::byte>>& indices, int levels) = 0;

protected:
  BrickFileWriter() = default;
};

} // namespace vol

#endif
