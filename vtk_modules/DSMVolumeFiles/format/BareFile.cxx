// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/BareFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/format/StoredFile.h"

#include <algorithm>

namespace vol
{

namespace
{

constexpr std::int64_t ChunkBytes = 1 << 20;

class BareFile final : public StoredFile
{
public:
  BareFile(const std::string& path, const BareValues& values, const FileGeometry& geometry)
    : StoredFile(path)
    , File(std::make_shared<PositionedFile>(values.Path))
  {
    this->Geometry = geometry;
    this->Geometry.Points = values.Samples;
    this->Stamp = this->File->GetStamp();
    FileArray array;
    array.Name = values.Name;
    array.Type = values.Type;
    array.Components = values.Components;
    array.Grid = CutIntoRows(values.Samples, array.GetSampleBytes());
    const auto need =
      static_cast<std::uint64_t>(rt::Box{ rt::Index3(0), values.Samples }.GetCount()) *
      array.GetSampleBytes();
    const std::uint64_t has = this->File->GetBytes();
    this->First =
      values.Offset >= 0 ? static_cast<std::uint64_t>(values.Offset) : has - std::min(has, need);
    if (this->First > has || need > has - this->First)
    {
      throw dsm::Error("The file '" + values.Path + "' has " + std::to_string(has) +
        " bytes, but " + std::to_string(need) + " of values behind " + std::to_string(this->First) +
        " of header are expected. Check the sizes and the type of the values.");
    }
    Storage storage;
    const std::size_t width = rt::GetBytes(values.Type);
    if (values.BigEndian && width > 1)
    {
      storage.Codec = ChunkCodec({ { CodecStep::Kind::SwapBytes, width } });
    }
    storage.HasWholeChunks = false;
    this->Storages.push_back(std::move(storage));
    this->Arrays.push_back(std::move(array));
  }

protected:
  std::optional<Place> FindChunk(std::size_t, int, const rt::Index3& chunk) const override
  {
    const FileArray& array = this->Arrays.front();
    const rt::Box box = array.Grid.GetBox(chunk);
    const rt::Index3 samples = array.Grid.Samples;
    const auto before = static_cast<std::uint64_t>((box.Min.z * samples.y + box.Min.y) * samples.x);
    const std::size_t bytes = array.GetSampleBytes();
    return Place{ this->File, this->First + before * bytes,
      static_cast<std::size_t>(box.GetCount()) * bytes, 0 };
  }

private:
  std::shared_ptr<const PositionedFile> File;
  std::uint64_t First = 0;
};

} // namespace

ChunkGrid CutIntoRows(const rt::Index3& samples, std::size_t sampleBytes)
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

std::shared_ptr<const VolumeFile> OpenBareFile(
  const std::string& path, const BareValues& values, const FileGeometry& geometry)
{
  if (values.Samples.x < 1 || values.Samples.y < 1 || values.Samples.z < 1)
  {
    throw dsm::Error(
      "The file '" + path + "' does not tell how many samples it has along each axis; enter them.");
  }
  return std::make_shared<BareFile>(path, values, geometry);
}

} // namespace vol
