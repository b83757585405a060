// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/BareFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/ChunkStorage.h"
#include "DSMVolumeFiles/plain/UnpackedCopy.h"
#include "DSMVolumeFiles/plain/ValueBytes.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

/// Returns the offset behind so many lines of text. Throws dsm::Error.
std::uint64_t SkipLines(const std::string& path, std::int64_t lines, std::uint64_t from)
{
  if (lines == 0)
  {
    return from;
  }
  const std::string text =
    ReadBeginning(path, static_cast<std::size_t>(from) + FileLimits::HeaderBytes);
  for (std::size_t at = static_cast<std::size_t>(from);
       (at = text.find('\n', at)) != std::string::npos;)
  {
    ++at;
    if (--lines == 0)
    {
      return at;
    }
  }
  throw FileError(path,
    "cannot be read: it has fewer lines than are to be skipped before its values, or they take "
    "more "
    "than " +
      std::to_string(FileLimits::HeaderBytes) + " bytes.");
}

class BareFile final : public VolumeFile
{
public:
  BareFile(const std::string& path, const BareValues& values, const FileGeometry& geometry,
    const OpenOptions& options)
    : VolumeFile(path)
    , Files(values.Paths)
    , ComponentsApart(values.ComponentsApart)
  {
    this->Warnings = values.Warnings;
    this->Geometry = geometry;
    this->Geometry.Points = values.Samples;
    FileArray array;
    array.Name = values.Name;
    array.Type = values.Type;
    array.Components = static_cast<int>(std::clamp<std::int64_t>(
      values.Components, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
    array.Grid.Samples = values.Samples;
    CheckSizes(path, array);
    array.Grid = CutIntoBoxes(values.Samples, array.GetSampleBytes());
    const auto need =
      static_cast<std::uint64_t>(bricks::Box{ bricks::Index3(0), values.Samples }.GetCount()) *
      array.GetSampleBytes();
    CompressedValues packed;
    packed.Encoding = values.Encoding;
    packed.Skip = values.Skip;
    packed.PartBytes = need / values.Paths.size();
    for (const std::string& file : values.Paths)
    {
      this->NameHeader(
        [&] { packed.Parts.push_back(this->FindPart(file, values, packed.PartBytes)); });
    }
    // The stamp depends on how the values are read, so results kept for another description do not
    // apply.
    bricks::ByteHash hash;
    std::vector<ValuePart> parts;
    for (const CompressedValues::Part& part : packed.Parts)
    {
      const std::uint64_t place[] = { part.Place.Stamp, part.Place.Offset };
      hash.Add(place, sizeof(place));
      parts.push_back(part.Place);
    }
    const std::uint64_t manner[] = { static_cast<std::uint64_t>(values.Type),
      static_cast<std::uint64_t>(values.Components),
      (values.BigEndian ? 1u : 0u) + (values.ComponentsApart ? 2u : 0u),
      static_cast<std::uint64_t>(values.Encoding), static_cast<std::uint64_t>(values.Skip) };
    hash.Add(manner, sizeof(manner));
    this->Stamp = hash.Get();
    if (values.Encoding == StreamEncoding::Plain)
    {
      this->Bytes = std::make_unique<ValueBytes>(std::move(parts), packed.PartBytes);
    }
    else if (!options.OnlyHeader)
    {
      this->NameHeader(
        [&]
        {
          this->Bytes = std::make_unique<ValueBytes>(
            std::vector<ValuePart>{ UnpackOnce(packed, options.GoesOn) }, need);
        });
    }
    const std::size_t width = bricks::GetBytes(values.Type);
    if (values.BigEndian && width > 1)
    {
      this->Codec = ChunkCodec({ { "swap", width } });
    }
    this->Arrays.push_back(std::move(array));
  }

  std::vector<std::string> GetFiles(int) const override
  {
    std::vector<std::string> files{ this->Path };
    files.insert(files.end(), this->Files.begin(), this->Files.end());
    return files;
  }

  void ReadChunk(std::size_t, int, const bricks::Index3& chunk, std::byte* out) const override
  {
    const FileArray& array = this->Arrays.front();
    const bricks::Box box = array.Grid.GetBox(chunk);
    try
    {
      if (this->Codec.IsPlain())
      {
        this->ReadRows(array, box, out);
        return;
      }
      const auto bytes = static_cast<std::size_t>(box.GetCount()) * array.GetSampleBytes();
      ByteBuffer stored(bytes);
      this->ReadRows(array, box, stored.data());
      this->Codec.Decode(std::move(stored), 0, out, bytes);
    }
    catch (const dsm::Error& error)
    {
      throw FileError({ this->Path, array.Name, chunk }, error);
    }
  }

  bool ReadPart(std::size_t, int, const bricks::Index3& chunk, const bricks::Box& part,
    std::byte* out) const override
  {
    if (!this->Codec.IsPlain())
    {
      return false;
    }
    try
    {
      this->ReadRows(this->Arrays.front(), part, out);
    }
    catch (const dsm::Error& error)
    {
      throw FileError({ this->Path, this->Arrays.front().Name, chunk }, error);
    }
    return true;
  }

  void Prefetch(std::size_t, int, const std::vector<ChunkPart>& parts) const override
  {
    const FileArray& array = this->Arrays.front();
    std::vector<PositionedFile::Piece> pieces;
    for (const auto& [chunk, part] : parts)
    {
      const auto more =
        this->FindPieces(array, this->Codec.IsPlain() ? part : array.Grid.GetBox(chunk));
      pieces.insert(pieces.end(), more.begin(), more.end());
    }
    if (this->Bytes)
    {
      this->Bytes->Prefetch(pieces);
    }
  }

private:
  /// An error of another file names the header, too.
  template <class Call>
  void NameHeader(const Call& call) const
  {
    try
    {
      call();
    }
    catch (const FileError& error)
    {
      if (error.GetPlace().Path == this->Path)
      {
        throw;
      }
      throw FileError({ this->Path, {}, {} }, error);
    }
  }

  /// Looks at a file of values. Throws dsm::Error where it is too short.
  CompressedValues::Part FindPart(
    const std::string& path, const BareValues& values, std::uint64_t need) const
  {
    const PositionedFile file(path);
    if (file.IsDirectory())
    {
      throw FileError(this->Path, "refers to '" + path + "' for its values, which is a directory.");
    }
    const std::uint64_t has = file.GetBytes();
    const auto least = static_cast<std::uint64_t>(values.Least);
    const bool isPlain = values.Encoding == StreamEncoding::Plain;
    const std::uint64_t bytes = isPlain ? need : static_cast<std::uint64_t>(values.PackedBytes);
    const std::uint64_t first = values.Offset < 0
      ? has - std::min(has, bytes)
      : SkipLines(path, values.Lines, least) - least + static_cast<std::uint64_t>(values.Offset);
    if (first < least || first > has || bytes > has - first)
    {
      throw FileError(path,
        "has " + std::to_string(has) + " bytes, but " + std::to_string(bytes) + " of " +
          (isPlain ? "" : "compressed ") + "values after " +
          std::to_string(std::max(least, first)) +
          " of header are expected. Check the dimensions and the type of the values.");
    }
    return { { path, first, file.GetStamp() }, bytes > 0 && !isPlain ? bytes : has - first };
  }

  void ReadRows(const FileArray& array, const bricks::Box& box, std::byte* out) const
  {
    if (!this->Bytes)
    {
      throw dsm::Error("only its header was opened");
    }
    if (!this->ComponentsApart)
    {
      this->Bytes->Read(this->FindPieces(array, box), out);
      return;
    }
    const std::size_t width = bricks::GetBytes(array.Type);
    const std::size_t sampleBytes = array.GetSampleBytes();
    const std::size_t bytes = static_cast<std::size_t>(box.GetCount()) * sampleBytes;
    ByteBuffer apart(bytes);
    this->Bytes->Read(this->FindPieces(array, box), apart.data());
    const std::byte* from = apart.data();
    for (std::size_t component = 0; component < sampleBytes; component += width)
    {
      for (std::size_t at = component; at < bytes; at += sampleBytes, from += width)
      {
        std::copy_n(from, width, out + at);
      }
    }
  }

  /// In the order of the file.
  std::vector<PositionedFile::Piece> FindPieces(
    const FileArray& array, const bricks::Box& box) const
  {
    std::vector<PositionedFile::Piece> pieces;
    const bricks::Index3 samples = array.Grid.Samples;
    const bricks::Index3 size = box.GetSize();
    const int parts = this->ComponentsApart ? array.Components : 1;
    const std::size_t sampleBytes = array.GetSampleBytes() / static_cast<std::size_t>(parts);
    const std::int64_t all = samples.x * samples.y * samples.z;
    // Whole rows follow one another.
    const std::int64_t rows = size.x == samples.x ? size.y : 1;
    const std::size_t bytes = static_cast<std::size_t>(size.x * rows) * sampleBytes;
    for (int part = 0; part < parts; ++part)
    {
      for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
      {
        for (std::int64_t y = box.Min.y; y < box.Max.y; y += rows)
        {
          const auto before =
            static_cast<std::uint64_t>(part * all + (z * samples.y + y) * samples.x + box.Min.x);
          pieces.push_back({ before * sampleBytes, bytes });
        }
      }
    }
    return pieces;
  }

  std::vector<std::string> Files;
  std::unique_ptr<const ValueBytes> Bytes; ///< null: only the header was wanted
  bool ComponentsApart;
  ChunkCodec Codec;
};

} // namespace

std::shared_ptr<VolumeFile> OpenBareFile(const std::string& path, const BareValues& values,
  const FileGeometry& geometry, const OpenOptions& options)
{
  return std::make_shared<BareFile>(path, values, geometry, options);
}

} // namespace vol
