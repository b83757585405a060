// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrParts.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <utility>

namespace vol
{

namespace
{

constexpr std::uint64_t MostIndexBytes = std::uint64_t(16) << 20;

/// Files whose stamps are kept, and about what one takes with its path.
constexpr std::uint64_t MostStamps = std::uint64_t(1) << 16;
constexpr std::uint64_t StampBytes = 200;

} // namespace

void ZarrParts::CheckUnchanged(const StampedSource& file)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Stamps.size() >= MostStamps)
  {
    this->Stamps.clear();
  }
  const auto known = this->Stamps.emplace(file.GetPath(), file.GetStamp()).first;
  if (known->second != file.GetStamp())
  {
    throw FileError(file.GetPath(), "changed or was replaced after it was opened. Reload it.");
  }
}

void ZarrParts::CheckNeverThere(const std::string& path)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Stamps.count(path) != 0)
  {
    throw FileError(path, "was deleted after it was opened.");
  }
}

ZarrParts::Index ZarrParts::GetIndex(
  const ZarrMetadata::Sharding& shards, const StampedSource& file)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  const auto known = this->Indices.find(file.GetPath());
  if (known != this->Indices.end())
  {
    this->Order.splice(this->Order.begin(), this->Order, known->second);
    return known->second->Offsets;
  }
  const Index offsets = ReadIndex(shards, file);
  this->Order.push_front({ file.GetPath(), offsets });
  this->Indices[file.GetPath()] = this->Order.begin();
  this->IndexBytes += shards.IndexBytes + StampBytes;
  while (this->IndexBytes > MostIndexBytes && this->Order.size() > 1)
  {
    this->IndexBytes -= this->Order.back().Offsets->size() * sizeof(std::uint64_t) + StampBytes;
    this->Indices.erase(this->Order.back().Path);
    this->Order.pop_back();
  }
  return offsets;
}

std::uint64_t ZarrParts::CountBytes(std::uint64_t files, std::uint64_t indexBytes)
{
  const std::uint64_t indices = indexBytes == 0
    ? 0
    : std::max(indexBytes,
        MultiplyWithin(MostIndexBytes, { files, indexBytes + StampBytes })
          .value_or(MostIndexBytes));
  return std::min(MostStamps, files) * StampBytes + indices;
}

ZarrParts::Index ZarrParts::ReadIndex(
  const ZarrMetadata::Sharding& shards, const StampedSource& file)
{
  if (file.GetBytes() < shards.IndexBytes)
  {
    throw FileError(file.GetPath(), "is truncated.");
  }
  ByteBuffer stored(shards.IndexBytes);
  const std::uint64_t first = shards.IndexIsFirst ? 0 : file.GetBytes() - stored.size();
  file.Read({ { first, stored.size() } }, stored.data());
  const std::size_t count = shards.IndexBytes / sizeof(std::uint64_t); // a checksum is less
  auto offsets = std::make_shared<std::vector<std::uint64_t>>(count / 2 * 2);
  try
  {
    shards.IndexCodec.Decode(std::move(stored), 0, reinterpret_cast<std::byte*>(offsets->data()),
      offsets->size() * sizeof(std::uint64_t));
  }
  catch (const dsm::Error& error)
  {
    file.Doubt();
    throw FileError(
      file.GetPath(), "is a shard with an invalid index: " + std::string(error.what()));
  }
  return offsets;
}

} // namespace vol
