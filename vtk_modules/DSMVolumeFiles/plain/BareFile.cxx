// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/BareFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/StoredFile.h"
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

class BareFile final : public StoredFile
{
public:
  BareFile(const std::string& path, const BareValues& values, const FileGeometry& geometry,
    const OpenOptions& options)
    : StoredFile(path)
    , Files(values.Paths)
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
      this->Bytes = std::make_shared<ValueBytes>(path, std::move(parts), packed.PartBytes);
    }
    else if (!options.OnlyHeader)
    {
      this->NameHeader(
        [&]
        {
          this->Bytes = std::make_shared<ValueBytes>(
            path, std::vector<ValuePart>{ UnpackOnce(packed, options.GoesOn) }, need);
        });
    }
    ChunkStorage storage;
    storage.Packed = PackedValues(values.Type);
    storage.StoredSamples = values.Samples;
    storage.HasWholeChunks = false;
    storage.ComponentsApart = values.ComponentsApart;
    const std::size_t width = bricks::GetBytes(values.Type);
    if (values.BigEndian && width > 1)
    {
      storage.Codec = ChunkCodec({ { "swap", width } });
    }
    this->Storages.push_back(std::move(storage));
    this->Arrays.push_back(std::move(array));
  }

  std::vector<std::string> GetFiles(int) const override
  {
    std::vector<std::string> files{ this->Path };
    files.insert(files.end(), this->Files.begin(), this->Files.end());
    return files;
  }

protected:
  /// All values are one piece, of which the chunks are parts.
  std::optional<Place> FindChunk(std::size_t, int, const bricks::Index3&) const override
  {
    if (!this->Bytes)
    {
      throw FileError(this->Path, "cannot be read: only its header was opened.");
    }
    return Place{ this->Bytes, 0, static_cast<std::size_t>(this->Bytes->GetBytes()) };
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

  std::vector<std::string> Files;
  std::shared_ptr<const ValueBytes> Bytes; ///< null: only the header was wanted
};

} // namespace

std::shared_ptr<VolumeFile> OpenBareFile(const std::string& path, const BareValues& values,
  const FileGeometry& geometry, const OpenOptions& options)
{
  return std::make_shared<BareFile>(path, values, geometry, options);
}

} // namespace vol
