// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/BareFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/format/StoredFile.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

/// Size in bytes of chunks of rows.
constexpr std::int64_t ChunkBytes = 1 << 18;

/// Size of chunks that are boxes: bytes of a row, and number of rows along y and z.
constexpr std::int64_t RowBytes = 1024;
constexpr std::int64_t Rows = 32;

class BareFile final : public VolumeFile
{
public:
  BareFile(const std::string& path, const BareValues& values, const FileGeometry& geometry)
    : VolumeFile(path)
    , File(std::make_shared<PositionedFile>(values.Path))
  {
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
    if (this->File->IsDirectory())
    {
      throw FileError(
        path, "refers to '" + values.Path + "' for its values, which is a directory.");
    }
    const std::uint64_t has = this->File->GetBytes();
    this->First =
      values.Offset >= 0 ? static_cast<std::uint64_t>(values.Offset) : has - std::min(has, need);
    const auto least = static_cast<std::uint64_t>(values.Least);
    if (this->First < least || this->First > has || need > has - this->First)
    {
      throw FileError(values.Path,
        "has " + std::to_string(has) + " bytes, but " + std::to_string(need) + " of values after " +
          std::to_string(std::max(least, this->First)) +
          " of header are expected. Check the dimensions and the type of the values.");
    }
    // The stamp depends on how the values are read, so results kept for another description do not
    // apply.
    const std::uint64_t manner[] = { this->File->GetStamp(), this->First,
      static_cast<std::uint64_t>(values.Type), static_cast<std::uint64_t>(values.Components),
      values.BigEndian ? 1u : 0u };
    bricks::ByteHash hash;
    hash.Add(manner, sizeof(manner));
    this->Stamp = hash.Get();
    const std::size_t width = bricks::GetBytes(values.Type);
    if (values.BigEndian && width > 1)
    {
      this->Codec = ChunkCodec({ { "swap", width } });
    }
    this->Arrays.push_back(std::move(array));
  }

  std::vector<std::string> GetFiles(int) const override
  {
    return { this->Path, this->File->GetPath() };
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
      throw FileError({ this->File->GetPath(), array.Name, chunk }, error);
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
      throw FileError({ this->File->GetPath(), this->Arrays.front().Name, chunk }, error);
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
    this->File->Prefetch(std::move(pieces));
  }

private:
  void ReadRows(const FileArray& array, const bricks::Box& box, std::byte* out) const
  {
    this->File->Read(this->FindPieces(array, box), out);
  }

  std::vector<PositionedFile::Piece> FindPieces(
    const FileArray& array, const bricks::Box& box) const
  {
    std::vector<PositionedFile::Piece> pieces;
    const bricks::Index3 samples = array.Grid.Samples;
    const bricks::Index3 size = box.GetSize();
    // Whole rows follow one another.
    const std::int64_t rows = size.x == samples.x ? size.y : 1;
    const std::size_t bytes = static_cast<std::size_t>(size.x * rows) * array.GetSampleBytes();
    for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
    {
      for (std::int64_t y = box.Min.y; y < box.Max.y; y += rows)
      {
        const auto before = static_cast<std::uint64_t>((z * samples.y + y) * samples.x + box.Min.x);
        pieces.push_back({ this->First + before * array.GetSampleBytes(), bytes });
      }
    }
    return pieces;
  }

  std::shared_ptr<const PositionedFile> File;
  std::uint64_t First = 0;
  ChunkCodec Codec;
};

} // namespace

ChunkGrid CutIntoBoxes(const bricks::Index3& samples, std::size_t sampleBytes)
{
  const std::int64_t width =
    std::max<std::int64_t>(1, RowBytes / static_cast<std::int64_t>(sampleBytes));
  // Samples of many components take more than a row's bytes each.
  std::int64_t rows = Rows;
  while (rows > 1 &&
    rows * rows * width * static_cast<std::int64_t>(sampleBytes) > RowBytes * Rows * Rows)
  {
    rows /= 2;
  }
  return { samples, glm::min(samples, bricks::Index3(width, rows, rows)) };
}

ChunkGrid CutIntoRows(const bricks::Index3& samples, std::size_t sampleBytes)
{
  const std::int64_t row =
    std::max<std::int64_t>(1, samples.x) * static_cast<std::int64_t>(sampleBytes);
  const std::int64_t rows =
    std::clamp<std::int64_t>(ChunkBytes / row, 1, std::max<std::int64_t>(1, samples.y));
  const std::int64_t planes = rows < samples.y
    ? 1
    : std::clamp<std::int64_t>(ChunkBytes / (row * rows), 1, std::max<std::int64_t>(1, samples.z));
  return { samples, { std::max<std::int64_t>(1, samples.x), rows, planes } };
}

std::shared_ptr<VolumeFile> OpenBareFile(
  const std::string& path, const BareValues& values, const FileGeometry& geometry)
{
  return std::make_shared<BareFile>(path, values, geometry);
}

} // namespace vol
