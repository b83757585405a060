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

/// What a brick file is to hold.
struct BrickFileLayout
{
  FileGeometry Geometry;
  /// Their grids' chunks are of BrickEdge samples along each axis, or of as many as there are.
  std::vector<FileArray> Arrays;
  int BrickEdge = 16;
  Compression Pressed = Compression::None;
  /// Of chunks that are not compressed: whether they have a halo, too. One that lies behind its chunk does not when the
  /// array is copied to another file.
  bool HasHaloRecords = true;

  /// What the chunks of an array go through. Throws dsm::Error when this build lacks the compression.
  ChunkCodec CreateCodec(std::size_t array) const;
  /// Whether the chunks of an array, which begin bricks, have a halo (ChunkGrid::GetHalo): so a brick is read in
  /// one piece.
  bool HasHalo(std::size_t array) const;
  /// Of HaloRecord, behind each chunk; 0: none, as where the halo is in the chunk.
  std::size_t GetHaloRecordBytes(std::size_t array) const;
};

/// A chunk as the file has it.
struct EncodedChunk
{
  ByteBuffer Bytes;
  ByteBuffer HaloRecord; ///< where the layout has them
};

/// Writes a volume that any HDF5 reader opens, as VTK's ImageData (VTKHDF), with an index of ranges beside it (the
/// group DSM; docs/files.md). Until it is whole, it consists of PartFiles. One rank's; one thread at a time.
class BrickFileWriter
{
public:
  /// What happens to the files of a writer that does not finish.
  enum class Unfinished
  {
    Keep,  ///< A later process resumes.
    Remove ///< The destructor removes them, and the constructor refuses to replace files that a process can resume.
  };

  /// Goes on with PATH.part when that was begun for the same layout and `source` (a text that tells of which
  /// values) and is whole up to where it has come; else begins anew. Throws dsm::Error; then it has removed what it has
  /// begun, and has not touched the files of another process or program.
  BrickFileWriter(std::string path, const BrickFileLayout& layout, const std::string& source,
    Unfinished unfinished);
  ~BrickFileWriter();
  BrickFileWriter(const BrickFileWriter&) = delete;
  BrickFileWriter& operator=(const BrickFileWriter&) = delete;

  /// Chunks of an array that the file has, which are its first ones, in the order of their numbers.
  std::int64_t GetChunks(std::size_t array) const;

  /// Adds the next chunks of an array, whose values have these ranges; they stay if the process ends. Throws
  /// dsm::Error when the disk is full, or fails; the writer is of no use then.
  void Add(std::size_t array, const std::vector<EncodedChunk>& chunks, const ValueRanges& ranges);

  /// When all chunks are there: PATH.part may be opened until Finish. Throws dsm::Error.
  void Close();
  /// After Close: adds what is known of the bricks of each array (bricks::VoxelIndex as it is kept; empty: nothing) and
  /// the first coarser levels, which are brick files at PartFiles::GetLevel, and gives the file its name. Throws dsm::Error.
  void Finish(const std::vector<std::vector<std::byte>>& indices, int levels);

private:
  class Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace vol

#endif
