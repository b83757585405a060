// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/StoredFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CopyBox.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace vol
{

ChunkGrid StoredFile::GetStoredGrid(std::size_t array) const
{
  const ChunkGrid& grid = this->Arrays[array].Grid;
  const bricks::Index3& stored = this->Storages[array].StoredSamples;
  return stored == bricks::Index3(0) ? grid : ChunkGrid{ grid.Samples, stored };
}

bricks::Index3 StoredFile::FindStored(std::size_t array, const bricks::Index3& chunk) const
{
  return this->Arrays[array].Grid.GetBox(chunk).Min / this->GetStoredGrid(array).ChunkSamples;
}

bricks::Box StoredFile::GetStoredBox(std::size_t array, const bricks::Index3& whole) const
{
  const ChunkGrid grid = this->GetStoredGrid(array);
  const bricks::Box box = grid.GetBox(whole);
  return this->Storages[array].HasWholeChunks ? bricks::Box{ box.Min, box.Min + grid.ChunkSamples }
                                              : box;
}

std::size_t StoredFile::GetStoredBytes(std::size_t array) const
{
  return bricks::GetBytes(this->Storages[array].Packed.GetStored()) *
    static_cast<std::size_t>(this->Arrays[array].Components);
}

void StoredFile::Unpack(std::size_t array, std::int64_t samples, std::byte* out,
  const dsm::FunctionRef<void(std::byte* to)>& read) const
{
  const FileArray& what = this->Arrays[array];
  const PackedValues& packed = this->Storages[array].Packed;
  const std::size_t values =
    static_cast<std::size_t>(samples) * static_cast<std::size_t>(what.Components);
  if (packed.ArePacked())
  {
    ByteBuffer numbers(static_cast<std::size_t>(samples) * this->GetStoredBytes(array));
    read(numbers.data());
    packed.Unpack(numbers.data(), values, out);
    return;
  }
  read(out);
  if (what.Valid.Exclude(what.Type))
  {
    bricks::ReplaceMissing(what.Valid, what.Type, out, values);
  }
}

void StoredFile::ReadChunk(
  std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const
{
  this->Unpack(array, this->Arrays[array].Grid.GetBox(chunk).GetCount(), out,
    [&](std::byte* to) { this->ReadStored(array, step, chunk, to); });
}

void StoredFile::ReadStored(
  std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const
{
  const FileArray& what = this->Arrays[array];
  const ChunkStorage& storage = this->Storages[array];
  const std::size_t sampleBytes = this->GetStoredBytes(array);
  const bricks::Box box = what.Grid.GetBox(chunk);
  const auto count = static_cast<std::size_t>(box.GetCount());
  const bricks::Index3 whole = this->FindStored(array, chunk);
  const std::optional<Place> place = this->FindChunk(array, step, whole);
  if (!place)
  {
    Repeat(storage.Fill.data(), storage.Fill.size(), out, count * sampleBytes);
    return;
  }
  const bricks::Box stored = this->GetStoredBox(array, whole);
  const std::size_t storedBytes = static_cast<std::size_t>(stored.GetCount()) * sampleBytes;
  const std::size_t allBytes = storedBytes * storage.Slices;
  const bool isAll = stored.Min == box.Min && stored.Max == box.Max && storage.Slices == 1 &&
    storage.Order == FastestX;
  try
  {
    // Unwanted parts of a large uncompressed chunk are not read.
    const bool inRows =
      storage.StoredSamples != bricks::Index3(0) || (!isAll && allBytes > MostChunkBytesTogether);
    const auto rows =
      inRows ? this->FindPieces(array, *place, whole, box) : std::vector<ByteSource::Piece>{};
    if (!rows.empty())
    {
      this->ReadPieces(array, *place, rows, out, count * sampleBytes);
      return;
    }
    if (storage.Codec.IsPlain() && isAll && place->Bytes == allBytes)
    {
      place->File->Read({ { place->Offset, allBytes } }, out);
      return;
    }
    this->CheckStored(array, *place, allBytes);
    ByteBuffer bytes(place->Bytes);
    place->File->Read({ { place->Offset, bytes.size() } }, bytes.data());
    if (isAll)
    {
      storage.Codec.Decode(std::move(bytes), place->SkippedSteps, out, allBytes);
      return;
    }
    ByteBuffer samples(allBytes);
    storage.Codec.Decode(std::move(bytes), place->SkippedSteps, samples.data(), samples.size());
    const std::byte* const slice = samples.data() + place->Slice * storedBytes;
    if (storage.Order != FastestX)
    {
      CopyOrdered(slice, stored.GetSize(), storage.Order, out, box.GetSize(), sampleBytes);
    }
    else
    {
      CopyBox(box, slice, stored, out, box, sampleBytes);
    }
  }
  catch (const dsm::Error& error)
  {
    place->File->Doubt();
    throw FileError(this->NamePlace(array, *place, chunk, whole), error);
  }
}

void StoredFile::CheckStored(std::size_t array, const Place& place, std::size_t bytes) const
{
  const ChunkStorage& storage = this->Storages[array];
  const FileArray& what = this->Arrays[array];
  // Only the decoder knows whether the chunk has a halo.
  const std::uint64_t most = storage.Codec.CountMostStored(bytes,
    storage.Codec.KeepsHalo() ? what.Grid.CountMostOfHalo() * this->GetStoredBytes(array) : 0);
  if (place.Bytes > most)
  {
    throw dsm::Error("it has " + std::to_string(place.Bytes) + " bytes instead of " +
      (storage.Codec.IsPlain() ? "" : "at most ") + std::to_string(most) +
      ". The file is damaged.");
  }
  const std::uint64_t has = place.File->GetBytes();
  if (place.Offset > has || place.Bytes > has - place.Offset)
  {
    throw dsm::Error("it has " + std::to_string(place.Bytes) + " bytes at offset " +
      std::to_string(place.Offset) + ", which exceeds the file's " + std::to_string(has) +
      " bytes. The file is truncated or its header is wrong.");
  }
  if (storage.Codec.CountMostDecoded(place.Bytes) < bytes)
  {
    throw dsm::Error("it has " + std::to_string(place.Bytes) + " bytes instead of " +
      std::to_string(bytes) +
      (storage.Codec.KeepsPlaces() ? "." : ", more than it can expand to."));
  }
}

FileError::Place StoredFile::NamePlace(std::size_t array, const Place& place,
  const bricks::Index3& chunk, const bricks::Index3& whole) const
{
  // Values in one piece have no chunks but those that are shown.
  const bool isOne = this->Storages[array].StoredSamples == this->Arrays[array].Grid.Samples;
  return { place.File->GetPath(), this->Arrays[array].Name, isOne ? chunk : whole };
}

std::vector<ByteSource::Piece> StoredFile::FindPieces(
  std::size_t array, const Place& place, const bricks::Index3& whole, const bricks::Box& part) const
{
  const ChunkStorage& storage = this->Storages[array];
  const auto planes =
    static_cast<std::size_t>(storage.ComponentsApart ? this->Arrays[array].Components : 1);
  const std::size_t sampleBytes = this->GetStoredBytes(array) / planes;
  const bricks::Box stored = this->GetStoredBox(array, whole);
  const bricks::Index3 size = stored.GetSize();
  std::vector<ByteSource::Piece> pieces;
  const std::uint64_t planeBytes = static_cast<std::uint64_t>(stored.GetCount()) * sampleBytes;
  const std::uint64_t sliceBytes = planeBytes * planes;
  if (!storage.Codec.KeepsPlaces() || storage.Order != FastestX ||
    place.Bytes != sliceBytes * storage.Slices)
  {
    return pieces;
  }
  const std::uint64_t first = place.Offset + place.Slice * sliceBytes;
  const bricks::Box rows{ part.Min - stored.Min, part.Max - stored.Min };
  // Whole rows follow one another.
  const std::int64_t together = part.GetSize().x == size.x ? part.GetSize().y : 1;
  const auto bytes = static_cast<std::size_t>(part.GetSize().x * together) * sampleBytes;
  for (std::size_t plane = 0; plane < planes; ++plane)
  {
    for (std::int64_t z = rows.Min.z; z < rows.Max.z; ++z)
    {
      for (std::int64_t y = rows.Min.y; y < rows.Max.y; y += together)
      {
        const auto before = static_cast<std::uint64_t>((z * size.y + y) * size.x + rows.Min.x);
        pieces.push_back({ first + plane * planeBytes + before * sampleBytes, bytes });
      }
    }
  }
  return pieces;
}

void StoredFile::ReadPieces(std::size_t array, const Place& place,
  const std::vector<ByteSource::Piece>& pieces, std::byte* out, std::size_t bytes) const
{
  const ChunkStorage& storage = this->Storages[array];
  if (storage.Codec.IsPlain() && !storage.ComponentsApart)
  {
    place.File->Read(pieces, out);
    return;
  }
  ByteBuffer stored(bytes);
  place.File->Read(pieces, stored.data());
  if (!storage.ComponentsApart)
  {
    storage.Codec.Decode(std::move(stored), place.SkippedSteps, out, bytes);
    return;
  }
  ByteBuffer apart(bytes);
  storage.Codec.Decode(std::move(stored), place.SkippedSteps, apart.data(), bytes);
  const std::size_t width = bricks::GetBytes(storage.Packed.GetStored());
  const std::size_t sampleBytes = this->GetStoredBytes(array);
  const std::byte* from = apart.data();
  for (std::size_t component = 0; component < sampleBytes; component += width)
  {
    for (std::size_t at = component; at < bytes; at += sampleBytes, from += width)
    {
      std::copy_n(from, width, out + at);
    }
  }
}

bool StoredFile::ReadPart(std::size_t array, int step, const bricks::Index3& chunk,
  const bricks::Box& part, std::byte* out) const
{
  const bricks::Index3 whole = this->FindStored(array, chunk);
  const std::optional<Place> place = this->FindChunk(array, step, whole);
  const auto pieces =
    place ? this->FindPieces(array, *place, whole, part) : std::vector<ByteSource::Piece>{};
  if (pieces.empty())
  {
    return false;
  }
  const std::int64_t count = part.GetCount();
  this->Unpack(array, count, out,
    [&](std::byte* to)
    {
      try
      {
        this->ReadPieces(
          array, *place, pieces, to, static_cast<std::size_t>(count) * this->GetStoredBytes(array));
      }
      catch (const dsm::Error& error)
      {
        place->File->Doubt();
        throw FileError(this->NamePlace(array, *place, chunk, whole), error);
      }
    });
  return true;
}

bool StoredFile::ReadWithHalo(
  std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const
{
  const FileArray& what = this->Arrays[array];
  const ChunkStorage& storage = this->Storages[array];
  const std::optional<Place> place =
    storage.HasHalo ? this->FindChunk(array, step, chunk) : std::nullopt;
  if (!place)
  {
    return false;
  }
  const std::size_t sampleBytes = this->GetStoredBytes(array);
  const bricks::Box box = what.Grid.GetBox(chunk);
  const bricks::Box all = what.Grid.GetBoxWithHalo(chunk);
  const bricks::Box stored{ box.Min, box.Min + what.Grid.ChunkSamples };
  const std::size_t storedBytes = static_cast<std::size_t>(stored.GetCount()) * sampleBytes;
  ByteBuffer halo;
  ByteBuffer samples;
  try
  {
    const std::size_t behind = storage.HaloRecordBytes;
    const std::uint64_t has = place->File->GetBytes();
    this->CheckStored(array, *place, storedBytes);
    if (behind > has - place->Offset - place->Bytes)
    {
      return false; // as below
    }
    halo.resize(static_cast<std::size_t>(all.GetCount() - box.GetCount()) * sampleBytes);
    samples.resize(storedBytes);
    ByteBuffer bytes(place->Bytes + behind);
    place->File->Read({ { place->Offset, bytes.size() } }, bytes.data());
    bool isThere = behind == 0 ||
      HaloRecord::Take(bytes.data() + place->Bytes, behind, what.Grid.GetNumber(chunk), halo);
    bytes.resize(place->Bytes);
    isThere = isThere &&
      storage.Codec.Decode(std::move(bytes), place->SkippedSteps, samples.data(), samples.size(),
        behind == 0 ? &halo : nullptr);
    if (!isThere)
    {
      return false; // another program has written it anew
    }
  }
  catch (const dsm::Error& error)
  {
    throw FileError({ place->File->GetPath(), what.Name, chunk }, error);
  }
  this->Unpack(array, all.GetCount(), out,
    [&](std::byte* to)
    {
      CopyBox(box, samples.data(), stored, to, all, sampleBytes);
      const std::byte* from = halo.data();
      for (const bricks::Box& part : what.Grid.GetHalo(chunk))
      {
        CopyBox(part, from, part, to, all, sampleBytes);
        from += static_cast<std::size_t>(part.GetCount()) * sampleBytes;
      }
    });
  return true;
}

bool StoredFile::IsFill(std::size_t array, int step, const bricks::Box& box) const
{
  bool isFill = !box.IsEmpty();
  bricks::ForEachIndex(this->GetStoredGrid(array).GetChunks(box),
    [&](const bricks::Index3& chunk) { isFill = isFill && this->IsMissing(array, step, chunk); });
  return isFill;
}

void StoredFile::Prefetch(std::size_t array, int step, const std::vector<ChunkPart>& parts) const
{
  std::map<std::shared_ptr<const ByteSource>, std::vector<ByteSource::Piece>> found;
  for (const auto& [chunk, part] : parts)
  {
    const bricks::Index3 whole = this->FindStored(array, chunk);
    const std::optional<Place> place = this->FindChunk(array, step, whole);
    if (!place)
    {
      continue;
    }
    auto rows = this->FindPieces(array, *place, whole, part);
    if (rows.empty())
    {
      rows.push_back({ place->Offset, place->Bytes + this->Storages[array].HaloRecordBytes });
    }
    auto& pieces = found[place->File];
    pieces.insert(pieces.end(), rows.begin(), rows.end());
  }
  for (auto& [file, pieces] : found)
  {
    file->Prefetch(std::move(pieces));
  }
}

} // namespace vol
