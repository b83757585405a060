// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_MemorySource_h
#define vol_MemorySource_h

#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/ByteSource.h"
#include "DSMVolumeFiles/base/FileError.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

/// Bytes of a file, or of a key of a store, that are in memory. Any thread.
class MemorySource : public StampedSource
{
public:
  MemorySource(std::string path, ByteBuffer bytes, std::uint64_t stamp)
    : Path(std::move(path))
    , Bytes(std::move(bytes))
    , Stamp(stamp)
  {
  }

  const std::string& GetPath() const override { return this->Path; }
  std::uint64_t GetBytes() const override { return this->Bytes.size(); }
  std::uint64_t GetStamp() const override { return this->Stamp; }
  void Prefetch(std::vector<Piece>) const override {}

  void Read(const std::vector<Piece>& pieces, std::byte* out) const override
  {
    for (const Piece& piece : pieces)
    {
      if (piece.Offset > this->Bytes.size() || piece.Bytes > this->Bytes.size() - piece.Offset)
      {
        throw FileError(this->Path,
          "ends at byte " + std::to_string(this->Bytes.size()) + ", where more are expected.");
      }
      out = std::copy_n(this->Bytes.data() + piece.Offset, piece.Bytes, out);
    }
  }

private:
  std::string Path;
  ByteBuffer Bytes;
  std::uint64_t Stamp;
};

} // namespace vol

#endif
