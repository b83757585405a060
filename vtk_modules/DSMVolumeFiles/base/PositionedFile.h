// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_PositionedFile_h
#define vol_PositionedFile_h

#include "DSMVolumeFiles/base/ByteSource.h"
#include "DSMVolumeFiles/base/Descriptor.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// An open file that is read at given places. Any thread.
class PositionedFile final : public StampedSource
{
public:
  /// Throws dsm::Error when it cannot be opened; WouldWait (WithoutWaiting), as a disk has to be asked.
  explicit PositionedFile(std::string path);

  const std::string& GetPath() const override { return this->Path; }
  /// A directory has a stamp, but no bytes that can be read.
  bool IsDirectory() const { return this->OfDirectory; }
  /// When it was opened.
  std::uint64_t GetBytes() const override { return this->Bytes; }
  /// Differs, for all practical purposes, when another file is there, or this one was written to: of
  /// inode, size and time of change, when it was opened. The same on all hosts that share a file system.
  std::uint64_t GetStamp() const override { return this->Stamp; }
  /// Returns the stamp of the file that is at a path now; 0 if there is none.
  static std::uint64_t FindStampOf(const std::string& path);
  /// Returns whether the file is unchanged since it was opened.
  bool IsUnchanged() const;
  /// Throws dsm::Error when the file has changed.
  void CheckUnchanged() const;

  /// Reads so many bytes from `offset` on; throws dsm::Error, which names file and place, when there are
  /// fewer, when reading fails, or when the file was written to since it was opened; WouldWait (WithoutWaiting).
  void Read(std::uint64_t offset, std::byte* out, std::size_t bytes) const;

  /// Likewise, but also reads a file that has changed since it was opened.
  void ReadUnchecked(std::uint64_t offset, std::byte* out, std::size_t bytes) const;

  /// Likewise, for many pieces in ascending order of offset; their bytes are stored one piece behind the
  /// other. Pieces with less than two pages between them are read together, including the gap: the rows of a
  /// box are many, and small.
  void Read(const std::vector<Piece>& pieces, std::byte* out) const override;

  /// The system may read them to its own cache already, of a large file with what is in the same 32 KiB; does not
  /// wait for it.
  void Prefetch(std::uint64_t offset, std::size_t bytes) const;
  /// Likewise, for pieces in any order, grouped as by Read.
  void Prefetch(std::vector<Piece> pieces) const override;

private:
  /// Several pieces that are read together: those from First up to Last, and bytes from Begin up to End.
  struct Run
  {
    std::vector<Piece>::const_iterator First;
    std::vector<Piece>::const_iterator Last;
    std::uint64_t Begin;
    std::uint64_t End;
  };
  /// Offsets ascend; pieces may overlap.
  static Run FindRun(const std::vector<Piece>& pieces, std::vector<Piece>::const_iterator first);

  std::string Path;
  Descriptor Whole;
  Descriptor
    Scattered; ///< the same file, in which the system does not read ahead; none: it is small
  bool OfDirectory = false;
  std::uint64_t Bytes = 0;
  std::uint64_t Stamp = 0;
};

} // namespace vol

#endif
