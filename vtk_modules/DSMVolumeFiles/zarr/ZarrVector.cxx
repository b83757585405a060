// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrVector.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/zarr/ZarrMetadata.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>

namespace vol
{

namespace
{

/// Numbers of one chunk, as they are stored.
ByteBuffer ReadChunk(
  const ZarrStore& store, const ZarrMetadata& data, const std::string& path, std::size_t count)
{
  const std::size_t width = data.Fill.size();
  ByteBuffer numbers(count * width);
  const std::uint64_t most = data.Codec.CountMostStored(numbers.size(), 0);
  const auto file = store.Open(path, { ZarrStore::Manner::Kind::Whole, most });
  if (!file)
  {
    for (std::size_t index = 0; index < count; ++index)
    {
      std::memcpy(numbers.data() + index * width, data.Fill.data(), width);
    }
    return numbers;
  }
  try
  {
    if (file->GetBytes() > most)
    {
      throw dsm::Error("it has too many bytes.");
    }
    ByteBuffer stored(static_cast<std::size_t>(file->GetBytes()));
    file->Read({ { 0, stored.size() } }, stored.data());
    data.Codec.Decode(std::move(stored), 0, numbers.data(), numbers.size());
  }
  catch (const dsm::Error& error)
  {
    throw FileError(path, std::string("cannot be read: ") + error.what());
  }
  return numbers;
}

} // namespace

std::vector<double> ReadZarrVector(
  const ZarrStore& store, const std::string& folder, std::uint64_t most)
{
  std::vector<double> found;
  const std::optional<ZarrMetadata> data = ReadZarrMetadata(store, folder);
  const bool isRight = data && data->Shape.size() == 1 && data->ChunkShape.size() == 1 &&
    data->Shape[0] > 0 && data->ChunkShape[0] > 0 && !data->Shards &&
    static_cast<std::uint64_t>(data->Shape[0]) <= std::min(most, FileLimits::Coordinates);
  // A chunk may be larger than the array.
  if (!isRight || data->ChunkShape[0] > std::max<std::int64_t>(data->Shape[0], 1 << 16))
  {
    return found;
  }
  const auto chunk = static_cast<std::size_t>(data->ChunkShape[0]);
  for (std::int64_t first = 0; first < data->Shape[0]; first += data->ChunkShape[0])
  {
    const std::int64_t number = first / data->ChunkShape[0];
    const ByteBuffer numbers = ReadChunk(store, *data, folder + "/" + data->GetKey(&number), chunk);
    const auto count = std::min(chunk, static_cast<std::size_t>(data->Shape[0] - first));
    for (std::size_t index = 0; index < count; ++index)
    {
      found.push_back(data->Packed.ToNumber(numbers.data() + index * data->Fill.size()));
    }
  }
  return found;
}

} // namespace vol
