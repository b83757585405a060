// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ZarrFile.h"

#include "DSMCore/base/Error.h"
#include "DSMRayTracing/base/ByteHash.h"
#include "DSMVolumeFiles/format/StoredFile.h"
#include "DSMVolumeFiles/format/ZarrMetadata.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

namespace vol
{

namespace
{

using Json = nlohmann::json;

/// How many axes are in space.
constexpr std::size_t SpaceAxes = 3;

/// An axis before those of space: its place, or none.
struct LeadingAxes
{
  int Time = -1;
  int Channel = -1;
};

LeadingAxes FindLeadingAxes(const Json& axes, std::size_t count)
{
  LeadingAxes found;
  const int leading = static_cast<int>(count - SpaceAxes);
  for (int axis = 0; axis < leading; ++axis)
  {
    const Json known = axes.is_array() && axes.size() == count ? axes[axis] : Json();
    const std::string type = known.is_object() ? known.value("type", "") : "";
    const bool isTime = type == "time" || (type.empty() && leading == 2 && axis == 0);
    (isTime ? found.Time : found.Channel) = axis;
  }
  return found;
}

rt::Index3 GetSpace(const std::vector<std::int64_t>& shape)
{
  const std::size_t last = shape.size() - 1;
  return { shape[last], shape[last - 1], shape[last - 2] };
}

class ZarrFile final : public StoredFile
{
public:
  ZarrFile(const std::string& path, int level)
    : StoredFile(path)
  {
    const Json attributes = ReadZarrAttributes(path);
    const Json ome = attributes.contains("ome") ? attributes["ome"] : attributes;
    const Json scales = ome.value("multiscales", Json::array());
    try
    {
      if (scales.is_array() && !scales.empty())
      {
        this->OpenScale(scales[0], ome, level);
      }
      else
      {
        this->OpenArrays();
      }
    }
    catch (const Json::exception& error)
    {
      throw dsm::Error("The metadata of '" + path + "' are not as they should be (" +
        std::string(error.what()) + ").");
    }
    rt::ByteHash hash;
    for (const Source& source : this->Sources)
    {
      for (const char* name : { "/.zarray", "/zarr.json" })
      {
        if (std::filesystem::exists(source.Folder + name))
        {
          // The folder's, too: most programs replace chunks by others of the same name.
          const std::uint64_t stamps[] = { PositionedFile(source.Folder + name).GetStamp(),
            PositionedFile(source.Folder).GetStamp() };
          hash.Add(stamps, sizeof(stamps));
        }
      }
    }
    this->Stamp = hash.Get();
  }

protected:
  std::optional<Place> FindChunk(
    std::size_t array, int step, const rt::Index3& chunk) const override
  {
    const Source& source = this->Sources[array];
    const ZarrMetadata& data = *source.Data;
    const std::size_t axes = data.Shape.size();
    std::vector<std::int64_t> index(axes, 0);
    for (std::size_t axis = 0; axis < SpaceAxes; ++axis)
    {
      index[axes - 1 - axis] = chunk[static_cast<int>(axis)];
    }
    // A chunk may have several times and channels.
    std::size_t slice = 0;
    for (std::size_t axis = 0; axis + SpaceAxes < axes; ++axis)
    {
      const std::int64_t at = static_cast<int>(axis) == source.Leading.Time ? step : source.Channel;
      index[axis] = at / data.ChunkShape[axis];
      slice = slice * static_cast<std::size_t>(data.ChunkShape[axis]) +
        static_cast<std::size_t>(at % data.ChunkShape[axis]);
    }
    std::optional<Place> place =
      data.Shards ? this->FindInShard(source, index) : FindFile(source, index);
    if (place)
    {
      place->Slice = slice;
    }
    return place;
  }

private:
  /// Where an array of ours comes from.
  struct Source
  {
    std::string Folder;
    std::shared_ptr<const ZarrMetadata> Data;
    LeadingAxes Leading;
    std::int64_t Channel = 0;
  };
  /// Offsets and lengths of the chunks in a shard.
  using Index = std::shared_ptr<const std::vector<std::uint64_t>>;

  void OpenScale(const Json& scale, const Json& ome, int level)
  {
    const Json& datasets = scale.at("datasets");
    this->Levels = static_cast<int>(datasets.size());
    if (level < 0 || level >= this->Levels)
    {
      throw dsm::Error("'" + this->Path + "' has " + std::to_string(this->Levels) +
        " levels of detail; level " + std::to_string(level) + " is none of them.");
    }
    const Json& dataset = datasets.at(static_cast<std::size_t>(level));
    const std::string folder = this->Path + "/" + dataset.at("path").get<std::string>();
    const auto data = Read(folder);
    const LeadingAxes leading = FindLeadingAxes(scale.value("axes", Json()), data->Shape.size());
    this->Locate(scale.value("coordinateTransformations", Json::array()));
    this->Locate(dataset.value("coordinateTransformations", Json::array()));
    const Json channels = ome.value("omero", Json::object()).value("channels", Json::array());
    const auto getName = [&](std::int64_t channel, std::int64_t count)
    {
      const auto number = static_cast<std::size_t>(channel);
      const std::string label =
        channels.is_array() && number < channels.size() ? channels[number].value("label", "") : "";
      return !label.empty() ? label
        : count == 1        ? std::string("values")
                            : "channel " + std::to_string(channel);
    };
    this->Add(folder, data, leading, getName);
  }

  /// Scale and translation, the slowest axis first.
  void Locate(const Json& transformations)
  {
    for (const Json& one : transformations)
    {
      const std::string type = one.value("type", "");
      const auto values = one.value(type, std::vector<double>());
      for (std::size_t axis = 0; axis < SpaceAxes && values.size() >= SpaceAxes; ++axis)
      {
        const double value = values[values.size() - 1 - axis];
        if (type == "scale")
        {
          this->Geometry.Spacing[axis] *= value;
          this->Geometry.Origin[axis] *= value;
        }
        else if (type == "translation")
        {
          this->Geometry.Origin[axis] += value;
        }
      }
    }
  }

  /// The path is an array, or a group of arrays.
  void OpenArrays()
  {
    const auto addAs = [this](const std::string& folder, const std::string& name)
    {
      const auto data = Read(folder);
      this->Add(folder, data, FindLeadingAxes(Json(), data->Shape.size()),
        [&](std::int64_t channel, std::int64_t count)
        { return count == 1 ? name : name + " " + std::to_string(channel); });
    };
    if (ReadZarrMetadata(this->Path))
    {
      addAs(this->Path, std::filesystem::path(this->Path).stem().string());
      return;
    }
    std::map<std::string, rt::Index3> found;
    rt::Index3 largest(0);
    const auto getCount = [](const rt::Index3& samples) {
      return rt::Box{ rt::Index3(0), samples }.GetCount();
    };
    for (const auto& entry : std::filesystem::directory_iterator(this->Path))
    {
      const auto data =
        entry.is_directory() ? ReadZarrMetadata(entry.path().string()) : std::nullopt;
      if (data && data->IsVolume())
      {
        const rt::Index3 samples = GetSpace(data->Shape);
        found[entry.path().filename().string()] = samples;
        largest = getCount(samples) > getCount(largest) ? samples : largest;
      }
    }
    if (found.empty())
    {
      throw dsm::Error("'" + this->Path + "' has no Zarr array of three axes.");
    }
    for (const auto& [name, samples] : found)
    {
      if (samples == largest)
      {
        addAs(this->Path + "/" + name, name);
      }
    }
  }

  static std::shared_ptr<const ZarrMetadata> Read(const std::string& folder)
  {
    std::optional<ZarrMetadata> data = ReadZarrMetadata(folder);
    if (!data)
    {
      throw dsm::Error("'" + folder + "' is no Zarr array: it has neither .zarray nor zarr.json.");
    }
    if (!data->IsVolume())
    {
      throw dsm::Error(
        "The Zarr array '" + folder + "' is no volume: it has no samples, or not 3 to 5 axes.");
    }
    return std::make_shared<const ZarrMetadata>(std::move(*data));
  }

  /// `getName(channel, count)`.
  template <class GetName>
  void Add(const std::string& folder, const std::shared_ptr<const ZarrMetadata>& data,
    const LeadingAxes& leading, const GetName& getName)
  {
    const std::int64_t channels =
      leading.Channel >= 0 ? data->Shape[static_cast<std::size_t>(leading.Channel)] : 1;
    const std::int64_t times =
      leading.Time >= 0 ? data->Shape[static_cast<std::size_t>(leading.Time)] : 1;
    this->Steps = static_cast<int>(times);
    this->Geometry.Points = GetSpace(data->Shape);
    for (std::int64_t channel = 0; channel < channels; ++channel)
    {
      FileArray array;
      array.Name = getName(channel, channels);
      array.Type = data->Type;
      array.Grid = { GetSpace(data->Shape), GetSpace(data->ChunkShape) };
      Storage storage;
      storage.Codec = data->Codec;
      storage.Fill = data->Fill;
      for (std::size_t axis = 0; axis + SpaceAxes < data->Shape.size(); ++axis)
      {
        storage.Slices *= static_cast<std::size_t>(data->ChunkShape[axis]);
      }
      this->Arrays.push_back(std::move(array));
      this->Storages.push_back(std::move(storage));
      this->Sources.push_back({ folder, data, leading, channel });
    }
  }

  static std::string GetKey(const ZarrMetadata& data, const std::vector<std::int64_t>& index)
  {
    std::string key = data.Prefix;
    for (const std::int64_t number : index)
    {
      key += (key.empty() ? "" : data.Separator) + std::to_string(number);
    }
    return key;
  }

  static std::optional<StoredFile::Place> FindFile(
    const Source& source, const std::vector<std::int64_t>& index)
  {
    const std::string path = source.Folder + "/" + GetKey(*source.Data, index);
    if (!std::filesystem::exists(path))
    {
      return std::nullopt;
    }
    const auto file = std::make_shared<const PositionedFile>(path);
    return StoredFile::Place{ file, 0, static_cast<std::size_t>(file->GetBytes()) };
  }

  std::optional<StoredFile::Place> FindInShard(
    const Source& source, const std::vector<std::int64_t>& index) const
  {
    const ZarrMetadata& data = *source.Data;
    const ZarrMetadata::Sharding& shards = *data.Shards;
    std::vector<std::int64_t> shard;
    std::size_t number = 0;
    for (std::size_t axis = 0; axis < index.size(); ++axis)
    {
      const std::int64_t across = shards.ShardShape[axis] / data.ChunkShape[axis];
      shard.push_back(index[axis] / across);
      number =
        number * static_cast<std::size_t>(across) + static_cast<std::size_t>(index[axis] % across);
    }
    std::optional<StoredFile::Place> place = FindFile(source, shard);
    if (!place)
    {
      return std::nullopt;
    }
    const Index offsets = this->GetIndex(shards, *place->File);
    const std::uint64_t offset = (*offsets)[2 * number];
    const std::uint64_t bytes = (*offsets)[2 * number + 1];
    if (offset == ~std::uint64_t{ 0 } && bytes == ~std::uint64_t{ 0 })
    {
      return std::nullopt;
    }
    if (offset > place->Bytes || bytes > place->Bytes - offset)
    {
      throw dsm::Error(
        "The shard '" + place->File->GetPath() + "' is truncated, or its index is wrong.");
    }
    place->Offset = offset;
    place->Bytes = static_cast<std::size_t>(bytes);
    return place;
  }

  Index GetIndex(const ZarrMetadata::Sharding& shards, const PositionedFile& file) const
  {
    const std::lock_guard<std::mutex> lock(this->IndexLock);
    Index& known = this->Indices[file.GetPath()];
    if (!known)
    {
      if (file.GetBytes() < shards.IndexBytes)
      {
        throw dsm::Error("The shard '" + file.GetPath() + "' is truncated.");
      }
      ByteBuffer stored(shards.IndexBytes);
      file.Read(
        shards.IndexIsFirst ? 0 : file.GetBytes() - stored.size(), stored.data(), stored.size());
      const std::size_t count = shards.IndexBytes / sizeof(std::uint64_t); // a checksum is less
      auto offsets = std::make_shared<std::vector<std::uint64_t>>(count / 2 * 2);
      try
      {
        shards.IndexCodec.Decode(std::move(stored), 0,
          reinterpret_cast<std::byte*>(offsets->data()), offsets->size() * sizeof(std::uint64_t));
      }
      catch (const dsm::Error& error)
      {
        throw dsm::Error(
          "The index of the shard '" + file.GetPath() + "' cannot be used: " + error.what());
      }
      known = std::move(offsets);
    }
    return known;
  }

  std::vector<Source> Sources; ///< of the arrays
  mutable std::mutex IndexLock;
  mutable std::map<std::string, Index> Indices; ///< of shards that were looked into
};

} // namespace

std::shared_ptr<const VolumeFile> OpenZarr(const std::string& path, int level)
{
  return std::make_shared<ZarrFile>(path, level);
}

bool MayBeZarr(const std::string& path)
{
  for (const char* name : { "/.zarray", "/.zgroup", "/zarr.json" })
  {
    if (std::filesystem::exists(path + name))
    {
      return true;
    }
  }
  return false;
}

} // namespace vol
