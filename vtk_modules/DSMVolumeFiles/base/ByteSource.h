// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ByteSource_h
#define vol_ByteSource_h

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// Bytes of a file, or of several ones behind one another, that are read at given places. Any thread.
class ByteSource
{
public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Path for messages.
  virtual const std::string& GetPath() const = 0;
  virtual std::uint64_t GetBytes() const = 0;

  struct Piece
  {
    std::uint64_t Offset;
    std::size_t Bytes;
  };
  /// Reads pieces in ascending order of offset; their bytes are stored one piece behind the other. Throws dsm::Error,
  /// which names file and place, when there are fewer, when reading fails, or when a file was written to since it was
  /// opened; WouldWait (WithoutWaiting).
  virtual void Read(const std::vector<Piece>& pieces, std::byte* out) const = 0;
  /// The system may read pieces, in any order, to its own cache already; does not wait for it.
  virtual void Prefetch(std::vector<Piece> pieces) const = 0;
  /// The caller found damage in bytes that it read: copies of them that are kept elsewhere are not used again.
  virtual void Doubt() const {}
};

/// Bytes of one file, or of one key of a store.
class StampedSource : public ByteSource
{
public:
  /// Differs, for all practical purposes, when other bytes are there.
  virtual std::uint64_t GetStamp() const = 0;
};

} // namespace vol

#endif
