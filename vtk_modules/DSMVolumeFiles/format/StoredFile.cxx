// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/StoredFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CopyBox.h"

#include <cstring>
#include <utility>

namespace vol
{

void StoredFile::ReadChunk(
  std::size_t array, int step, const rt::Index3& chunk, std::byte* out) const
{
  const FileArray& what = this->Arrays[array];
  const Storage& storage = this->Storages[array];
  const std::size_t sampleBytes = what.GetSampleBytes();
  const rt::Box box = what.Grid.GetBox(chunk);
  const auto count = static_cast<std::size_t>(box.GetCount());
  const std::optional<Place> place = this->FindChunk(array, step, chunk);
  if (!place)
  {
    for (std::size_t sample = 0; sample < count; ++sample)
    {
      std::memcpy(out + sample * sampleBytes, storage.Fill.data(), sampleBytes);
    }
    return;
  }
  const rt::Box stored =
    storage.HasWholeChunks ? rt::Box{ box.Min, box.Min + what.Grid.ChunkSamples } : box;
  const std::size_t storedBytes = static_cast<std::size_t>(stored.GetCount()) * sampleBytes;
  const std::size_t allBytes = storedBytes * storage.Slices;
  const bool isAll = stored.Max == box.Max && storage.Slices == 1;
  try
  {
    if (storage.Codec.IsPlain() && isAll && place->Bytes == allBytes)
    {
      place->File->Read(place->Offset, out, allBytes);
      return;
    }
    std::vector<std::byte> bytes(place->Bytes);
    place->File->Read(place->Offset, bytes.data(), bytes.size());
    if (isAll)
    {
      storage.Codec.Decode(std::move(bytes), place->SkippedSteps, out, allBytes);
      return;
    }
    std::vector<std::byte> samples(allBytes);
    storage.Codec.Decode(std::move(bytes), place->SkippedSteps, samples.data(), samples.size());
    CopyBox(box, samples.data() + place->Slice * storedBytes, stored, out, box, sampleBytes);
  }
  catch (const dsm::Error& error)
  {
    throw dsm::Error("Chunk (" + std::to_string(chunk.x) + ", " + std::to_string(chunk.y) + ", " +
      std::to_string(chunk.z) + ") of the array '" + what.Name + "' in '" + place->File->GetPath() +
      "' cannot be read: " + error.what());
  }
}

} // namespace vol
