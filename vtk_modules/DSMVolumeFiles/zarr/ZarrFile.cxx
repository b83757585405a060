// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/format/StoredFile.h"
#include "DSMVolumeFiles/zarr/OmeScales.h"
#include "DSMVolumeFiles/zarr/ZarrGroup.h"
#include "DSMVolumeFiles/zarr/ZarrJson.h"
#include "DSMVolumeFiles/zarr/ZarrNotes.h"
#include "DSMVolumeFiles/zarr/ZarrParts.h"
#include "DSMVolumeFiles/zarr/ZarrSource.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"
#include "DSMVolumeFiles/zarr/ZarrVector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_set>
#include <utility>

namespace vol
{

namespace
{

using Json = nlohmann::json;

/// More than any microscope's.
constexpr std::int64_t MostChannels = 1000;

class ZarrFile final : public StoredFile
{
public:
  ZarrFile(const std::string& path, const OpenOptions& options)
    : StoredFile(path)
    , Store(ZarrStore::Make(path, options))
    , Folder(path)
    , Name(options.Dataset.empty() ? options.GetArrayName(path) : options.Dataset)
    , IsPlaced(!options.HasSpacing())
  {
    try
    {
      this->Open(options.Dataset, options.Level);
    }
    catch (const Json::exception&)
    {
      throw FileError(
        this->Folder, "has invalid metadata: a member of 'multiscales' has a wrong type.");
    }
    this->Stamp = this->MakeStamp();
    this->Store->EndOpening();
  }

  std::uint64_t GetTableBytes() const override
  {
    // Saturates: a file may declare more chunks than a 64-bit number counts.
    constexpr std::uint64_t most = std::uint64_t(1) << 62;
    std::uint64_t files = 0;
    std::uint64_t indexBytes = 0;
    for (const ZarrSource& source : this->Sources)
    {
      const ZarrMetadata& data = *source.Data;
      const std::uint64_t mine = MultiplyWithin(most, data.CountFiles()).value_or(most);
      files = std::min(most, files + mine);
      indexBytes = std::max<std::uint64_t>(indexBytes, data.Shards ? data.Shards->IndexBytes : 0);
    }
    std::uint64_t listed = 0;
    for (const auto& [folder, listing] : this->Listings)
    {
      listed += listing->GetBytes();
    }
    return ZarrParts::CountBytes(files, indexBytes) + listed;
  }

  bool ReadPart(std::size_t array, int step, const bricks::Index3& chunk, const bricks::Box& part,
    std::byte* out) const override
  {
    // A request takes longer than the rest of a chunk.
    return (this->Store->CanList() || this->Storages[array].StoredSamples != bricks::Index3(0)) &&
      StoredFile::ReadPart(array, step, chunk, part, out);
  }

  void Prefetch(std::size_t array, int step, const std::vector<ChunkPart>& parts) const override
  {
    if (this->Store->CanList())
    {
      StoredFile::Prefetch(array, step, parts);
    }
  }

protected:
  std::optional<Place> FindChunk(
    std::size_t array, int step, const bricks::Index3& chunk) const override
  {
    const ZarrSource& source = this->Sources[array];
    const ZarrMetadata& data = *source.Data;
    std::size_t slice = 0;
    const ZarrSource::Index index = source.FindIndex(step, chunk, &slice);
    std::optional<Place> place;
    if (data.Shards)
    {
      place = this->FindInShard(source, index);
    }
    else if (const auto file = this->FindFile(source, index, this->ChooseManner(array)))
    {
      place = Place{ file, 0, static_cast<std::size_t>(file->GetBytes()) };
    }
    if (place)
    {
      place->Slice = slice;
    }
    return place;
  }

  bool IsMissing(std::size_t array, int step, const bricks::Index3& chunk) const override
  {
    const ZarrSource& source = this->Sources[array];
    return source.Listing->IsMissing(source.GetFileIndex(source.FindIndex(step, chunk)));
  }

private:
  /// Computes the stamp from the arrays' own files and from the results of the attributes, which
  /// may be in other files: axes, time, channels, their names, and the positions of the samples.
  std::uint64_t MakeStamp() const
  {
    bricks::ByteHash hash;
    hash.Add(&this->Geometry, sizeof(this->Geometry));
    for (const std::vector<double>& positions : this->Coordinates)
    {
      hash.Add(positions.data(), positions.size() * sizeof(double));
    }
    for (std::size_t array = 0; array < this->Sources.size(); ++array)
    {
      const ZarrSource& source = this->Sources[array];
      const std::string& name = this->Arrays[array].Name;
      hash.Add(source.Axes.Order.data(), sizeof(SpaceOrder));
      const std::int64_t numbers[] = { source.Axes.Time, this->Arrays[array].Components,
        static_cast<std::int64_t>(name.size()) };
      hash.Add(numbers, sizeof(numbers));
      hash.Add(name.data(), name.size());
      const std::uint64_t packing = this->Storages[array].Packed.GetStamp();
      hash.Add(&packing, sizeof(packing));
      hash.Add(&this->Arrays[array].Valid, sizeof(bricks::ValidValues));
      hash.Add(source.Channel.data(), source.Channel.size() * sizeof(std::int64_t));
      this->Store->AddStamps(source.Folder, hash);
    }
    return hash.Get();
  }

  /// Opens what is in the folder. `wanted`: which one of several; empty: the only one, or an
  /// image's first.
  void Open(const std::string& wanted, int level)
  {
    const Json attributes = ReadZarrAttributes(*this->Store, this->Folder);
    const Json& ome = ZarrGroup::FindOme(attributes);
    const Json& scales = ZarrJson::Find(ome, "multiscales");
    const bool isImage = scales.is_array() && !scales.empty();
    std::vector<std::string> names;
    if (isImage && (scales.size() > 1 || !wanted.empty()))
    {
      names = ZarrGroup::NameScales(this->Folder, scales);
    }
    const auto named = std::find(names.begin(), names.end(), wanted);
    if (!wanted.empty() && named == names.end())
    {
      this->OpenInner(wanted, names, level);
    }
    else if (isImage)
    {
      if (wanted.empty() && names.size() > 1)
      {
        this->Warnings.push_back("has " + std::to_string(names.size()) +
          " images in its 'multiscales', of which the first one is shown. Enter another one as "
          "Dataset: " +
          ListNames(names));
      }
      const auto number = static_cast<std::size_t>(named - names.begin());
      this->OpenScale(scales[wanted.empty() ? 0 : number], ome, level);
    }
    else
    {
      this->OpenArrays(level);
    }
  }

  /// Opens an array or a group in the folder. `names`: of what else can be chosen.
  void OpenInner(const std::string& inner, std::vector<std::string> names, int level)
  {
    const std::string folder = ZarrGroup::JoinInside(this->Folder, inner);
    if (!this->Store->HasMetadata(folder))
    {
      const std::vector<std::string> more = this->FindInner();
      names.insert(names.end(), more.begin(), more.end());
      throw FileError(
        this->Folder, "has no dataset " + Quote(inner) + ". Valid datasets: " + ListNames(names));
    }
    this->Folder = folder;
    this->Open({}, level);
  }

  void OpenScale(const Json& scale, const Json& ome, int level)
  {
    const Json& datasets = ZarrJson::GetArray(this->Folder, scale, "datasets");
    CheckLimit(this->Folder, "levels of detail", datasets.size(), FileLimits::Levels);
    this->Levels = static_cast<int>(datasets.size());
    if (level < 0 || level >= this->Levels)
    {
      throw FileError(this->Folder,
        "has no level " + std::to_string(level) +
          (this->Levels > 0 ? "; valid levels are 0 to " + std::to_string(this->Levels - 1) : "") +
          ".");
    }
    const auto readNumbers = [this](const std::string& name)
    {
      return ReadZarrVector(
        *this->Store, ZarrGroup::JoinInside(this->Folder, name), FileLimits::Axes);
    };
    OmeLevel found = OmeLevel::Find(this->Folder, scale, static_cast<std::size_t>(level),
      this->IsPlaced ? readNumbers : OmeLevel::ReadNumbers(), this->Warnings);
    const std::string folder = ZarrGroup::JoinInside(this->Folder, found.Array);
    const auto data = Read(folder);
    if (!found.Axes.empty() && found.Axes.size() != data->Shape.size())
    {
      throw FileError(folder,
        "has " + std::to_string(data->Shape.size()) + " axes, but its group declares " +
          std::to_string(found.Axes.size()) + ".");
    }
    const ZarrAxes axes = ZarrAxes::Find(folder, found.Axes, data->Shape.size());
    if (level > 0 && this->IsPlaced && !HasTransformations(scale))
    {
      found.Axes.resize(data->Shape.size());
      const std::string finest = ZarrJson::GetText(this->Folder, datasets.front(), "path");
      PlaceInFinest(
        Read(ZarrGroup::JoinInside(this->Folder, finest))->Shape, data->Shape, axes, found.Axes);
    }
    this->PlaceBy(found.Axes, axes, data->Shape);
    this->TimeBy(found.Axes, axes, data->Shape);
    if (found.Direction)
    {
      std::copy(found.Direction->begin(), found.Direction->end(), this->Geometry.Direction);
    }
    const Json& channels = ZarrJson::Find(ZarrJson::Find(ome, "omero"), "channels");
    const auto getName = [&](std::int64_t channel, std::int64_t count)
    {
      const auto number = static_cast<std::size_t>(channel);
      const std::string label = channels.is_array() && number < channels.size()
        ? ZarrJson::GetText(this->Folder, channels[number], "label")
        : std::string();
      return !label.empty() ? label
        : count == 1        ? this->Name
                            : "channel " + std::to_string(channel);
    };
    this->Add(folder, data, axes, getName);
  }

  /// OME-Zarr 0.1 to 0.3 has none.
  static bool HasTransformations(const Json& scale)
  {
    const auto hasSome = [](const Json& one)
    { return !ZarrJson::Find(one, "coordinateTransformations").is_null(); };
    const Json& datasets = ZarrJson::Find(scale, "datasets");
    return hasSome(scale) || std::any_of(datasets.begin(), datasets.end(), hasSome);
  }

  /// Places the samples of a coarser level as means of the finest level's, by the shapes of both.
  static void PlaceInFinest(const std::vector<std::int64_t>& finest,
    const std::vector<std::int64_t>& shape, const ZarrAxes& axes, AxisNotes& notes)
  {
    for (int axis = 0; axis < 3 && finest.size() == shape.size(); ++axis)
    {
      const std::size_t place = axes.FindInSpace(shape.size(), axis);
      const double factor = std::max(
        1.0, std::round(static_cast<double>(finest[place]) / static_cast<double>(shape[place])));
      notes[place].Spacing = factor;
      notes[place].Origin = 0.5 * (factor - 1.0);
    }
  }

  /// By what the file says of the axes of an array of this shape.
  void PlaceBy(const AxisNotes& notes, const ZarrAxes& axes, const std::vector<std::int64_t>& shape)
  {
    if (notes.size() != shape.size() || !this->IsPlaced)
    {
      return;
    }
    std::array<const AxisNote*, 3> inSpace{};
    for (int axis = 0; axis < 3; ++axis)
    {
      inSpace[static_cast<std::size_t>(axis)] = &notes[axes.FindInSpace(shape.size(), axis)];
    }
    PlaceAxes(this->Folder, inSpace, this->Geometry, this->Coordinates, this->Warnings);
  }

  /// Likewise, by the first array with a time axis.
  void TimeBy(const AxisNotes& notes, const ZarrAxes& axes, const std::vector<std::int64_t>& shape)
  {
    if (axes.Time >= 0 && this->Times.empty() && notes.size() == shape.size())
    {
      const auto time = static_cast<std::size_t>(axes.Time);
      const auto most = static_cast<std::int64_t>(FileLimits::Steps);
      this->Times =
        FindTimes(notes[time], static_cast<int>(std::min(shape[time], most)), this->Warnings);
    }
  }

  /// What there is in the folder, where that is known.
  std::vector<std::string> FindInner() const
  {
    return this->Store->KnowsFolders() ? ZarrGroup::FindInner(*this->Store, this->Folder)
                                       : std::vector<std::string>();
  }

  /// The folder is an array, or a group of arrays; else the first of such or of images in it is
  /// opened.
  void OpenArrays(int level)
  {
    const auto addAs = [this](const std::string& folder, const std::string& name)
    {
      const auto data = Read(folder);
      const ZarrAxes axes = ZarrAxes::Find(folder, NameZarrAxes(folder, *data), data->Shape.size());
      const bool isFirst = this->Arrays.empty();
      if (isFirst || (axes.Time >= 0 && this->Times.empty()))
      {
        const AxisNotes notes = ReadZarrNotes(*this->Store, folder, *data, axes);
        if (isFirst)
        {
          this->PlaceBy(notes, axes, data->Shape);
        }
        this->TimeBy(notes, axes, data->Shape);
      }
      WarnOfZarrPlaces(*this->Store, folder, *data, this->Warnings);
      this->Add(folder, data, axes,
        [&](std::int64_t channel, std::int64_t count)
        { return count == 1 ? name : name + " " + std::to_string(channel); });
    };
    if (ReadZarrMetadata(*this->Store, this->Folder))
    {
      addAs(this->Folder, this->Name);
      return;
    }
    std::string refused;
    const std::vector<std::string> names =
      ZarrGroup::FindArrays(*this->Store, this->Folder, refused);
    const std::vector<std::string> inner = this->FindInner();
    if (names.empty() && inner.empty())
    {
      throw FileError(this->Folder,
        "has no Zarr array with three axes." + (refused.empty() ? std::string() : " " + refused));
    }
    if (inner.size() > (names.empty() ? 1 : 0))
    {
      const std::string shown = names.empty()
        ? "several images or groups of arrays, of which " + Quote(inner.front()) + " is shown"
        : "images or groups of arrays beside those that are shown";
      this->Warnings.push_back(
        "has " + shown + ". Enter another one as Dataset: " + ListNames(inner));
    }
    if (names.empty())
    {
      this->OpenInner(inner.front(), {}, level);
      return;
    }
    for (const std::string& name : names)
    {
      addAs(this->Folder + "/" + name, name);
    }
  }

  std::shared_ptr<const ZarrMetadata> Read(const std::string& folder) const
  {
    std::optional<ZarrMetadata> data = ReadZarrMetadata(*this->Store, folder);
    if (!data)
    {
      throw FileError(folder, "is not a Zarr array: it has neither .zarray nor zarr.json.");
    }
    if (!data->IsVolume())
    {
      throw FileError(folder,
        "is not a volume that can be read: it has no samples, too many samples, or a number of "
        "axes outside 3 to 5.");
    }
    return std::make_shared<const ZarrMetadata>(std::move(*data));
  }

  /// Throws unless the components of a sample are beside one another.
  static void CheckComponents(
    const std::string& folder, const ZarrMetadata& data, const ZarrAxes& axes)
  {
    const std::int64_t components = axes.GetComponents(data.Shape);
    if (axes.GetComponents(data.ChunkShape) == components &&
      (components == 1 || !data.FortranOrder))
    {
      return;
    }
    std::string shape;
    for (const std::int64_t length : data.ChunkShape)
    {
      shape += (shape.empty() ? "" : " x ") + std::to_string(length);
    }
    throw FileError(folder,
      "has channels on its last axis and chunks of " + shape +
        (data.FortranOrder ? " in Fortran order" : "") + ". Each chunk must have all " +
        std::to_string(components) +
        " channels, in C order. Write it so, or with the channel axis first.");
  }

  /// A chunk that cannot be read in parts is read whole.
  static void CheckChunkBytes(
    const std::string& folder, const FileArray& array, const ChunkStorage& storage)
  {
    if (storage.StoredSamples != bricks::Index3(0) ||
      (storage.Codec.KeepsPlaces() && storage.Order == FastestX))
    {
      return;
    }
    const glm::u64vec3 chunk(array.Grid.ChunkSamples);
    if (!MultiplyWithin(FileLimits::ChunkBytes,
          { chunk.x, chunk.y, chunk.z, storage.Slices, array.GetSampleBytes() }))
    {
      throw FileError(folder,
        "has chunks of " + DescribeShape(array.Grid.ChunkSamples) + " samples, which exceed " +
          std::to_string(FileLimits::ChunkBytes) + " bytes. Write it with smaller chunks.");
    }
  }

  /// `getName(channel, count)`.
  template <class GetName>
  void Add(const std::string& folder, const std::shared_ptr<const ZarrMetadata>& data,
    const ZarrAxes& axes, const GetName& getName)
  {
    const auto getLength = [&](std::int64_t axis)
    { return data->Shape[static_cast<std::size_t>(axis)]; };
    std::int64_t channels = 1;
    for (std::int64_t axis = 0; axis < axes.Leading; ++axis)
    {
      channels *= axis == axes.Time ? 1 : getLength(axis);
    }
    if (channels > MostChannels)
    {
      throw FileError(folder,
        "has " + std::to_string(channels) + " channels, each of which becomes an array; at most " +
          std::to_string(MostChannels) +
          " are supported. If one of its axes is time, name that axis \"time\" (in dimension_names "
          "or _ARRAY_DIMENSIONS).");
    }
    const std::int64_t times = axes.Time >= 0 ? getLength(axes.Time) : 1;
    CheckLimit(folder, "time steps", static_cast<std::uint64_t>(times), FileLimits::Steps);
    CheckLimit(folder, "components", static_cast<std::uint64_t>(axes.GetComponents(data->Shape)),
      FileLimits::Components);
    CheckLimit(this->Folder, "arrays", this->Arrays.size() + static_cast<std::size_t>(channels),
      FileLimits::Arrays);
    this->Steps = std::max(this->Steps, static_cast<int>(times));
    this->Geometry.Points = axes.GetSpace(data->Shape);
    PackedValues packed = data->Packed;
    packed.TakeAttributes([&](const char* attribute)
      { return ZarrJson::ToNumbers(ZarrJson::Find(data->Attributes, attribute)); },
      ZarrJson::GetText(folder, data->Attributes, "_Unsigned") == "true", getName(0, channels),
      this->Warnings);
    for (std::int64_t channel = 0; channel < channels; ++channel)
    {
      FileArray array;
      array.Name = this->MakeUnique(getName(channel, channels), channel);
      std::vector<std::int64_t> place(static_cast<std::size_t>(axes.Leading), 0);
      std::int64_t rest = channel;
      for (std::int64_t axis = axes.Leading; axis-- > 0;)
      {
        if (axis != axes.Time)
        {
          place[static_cast<std::size_t>(axis)] = rest % getLength(axis);
          rest /= getLength(axis);
        }
      }
      array.Type = packed.GetStored();
      array.Components = static_cast<int>(axes.GetComponents(data->Shape));
      array.Grid = { this->Geometry.Points, axes.GetSpace(data->ChunkShape) };
      ChunkStorage storage;
      storage.Codec = data->Codec;
      storage.Packed = packed;
      storage.Fill = data->Fill;
      for (std::size_t axis = 0; axis < place.size(); ++axis)
      {
        // At most two axes, of fewer than 2^31 each.
        storage.Slices *= static_cast<std::size_t>(data->ChunkShape[axis]);
      }
      CheckSizes(folder, array, storage.Slices);
      storage.Order = axes.Order;
      if (data->FortranOrder)
      {
        std::reverse(storage.Order.begin(), storage.Order.end());
      }
      CheckComponents(folder, *data, axes);
      if (data->FortranOrder && storage.Slices > 1)
      {
        throw FileError(folder,
          "has several times or channels in a chunk, in Fortran order, which is not supported. "
          "Write it with order='C'.");
      }
      CutPlainChunks(array, storage);
      CheckChunkBytes(folder, array, storage);
      array.Type = packed.GetType();
      array.Valid = packed.GetValid();
      this->Arrays.push_back(std::move(array));
      this->Storages.push_back(std::move(storage));
      auto& listing = this->Listings[folder];
      listing = listing ? std::move(listing)
                        : std::make_unique<ZarrListing>(folder, *data, this->Store->CanList());
      this->Sources.push_back({ folder, data, axes, std::move(place), listing.get() });
    }
  }

  /// Labels may be alike.
  std::string MakeUnique(const std::string& name, std::int64_t channel)
  {
    std::string unique = name;
    for (std::int64_t number = channel; !this->Names.insert(unique).second; ++number)
    {
      unique = name + " " + std::to_string(number);
    }
    return unique;
  }

  /// Chunks are read whole unless they are shown as several.
  ZarrStore::Manner ChooseManner(std::size_t array) const
  {
    const ChunkStorage& storage = this->Storages[array];
    if (storage.StoredSamples != bricks::Index3(0))
    {
      return { ZarrStore::Manner::Kind::FromFirst, 1 };
    }
    const glm::u64vec3 chunk(this->Arrays[array].Grid.ChunkSamples);
    const std::uint64_t bytes = MultiplyWithin(FileLimits::ChunkBytes,
      { chunk.x, chunk.y, chunk.z, storage.Slices, this->GetStoredBytes(array) })
                                  .value_or(FileLimits::ChunkBytes);
    return { ZarrStore::Manner::Kind::Whole, storage.Codec.CountMostStored(bytes, 0) };
  }

  /// Null: there is none.
  std::shared_ptr<const StampedSource> FindFile(
    const ZarrSource& source, const ZarrSource::Index& index, const ZarrStore::Manner& manner) const
  {
    const std::string path = source.Folder + "/" + source.Data->GetKey(index.data());
    const bool isKnown = source.Listing->IsStillMissing(index);
    auto file = isKnown ? nullptr : this->Store->Open(path, manner);
    if (file)
    {
      this->Parts.CheckUnchanged(*file);
      return file;
    }
    if (!isKnown || this->Store->CanList())
    {
      this->Parts.CheckNeverThere(path);
      this->Store->CheckThere(source.Folder);
      source.Listing->NoteMissing(index);
    }
    return nullptr;
  }

  std::optional<StoredFile::Place> FindInShard(
    const ZarrSource& source, const ZarrSource::Index& index) const
  {
    const ZarrMetadata& data = *source.Data;
    const ZarrMetadata::Sharding& shards = *data.Shards;
    std::size_t number = 0;
    for (std::size_t axis = 0; axis < data.Shape.size(); ++axis)
    {
      const std::int64_t across = shards.ShardShape[axis] / data.ChunkShape[axis];
      number =
        number * static_cast<std::size_t>(across) + static_cast<std::size_t>(index[axis] % across);
    }
    using Kind = ZarrStore::Manner::Kind;
    const auto file = this->FindFile(source, source.GetFileIndex(index),
      { shards.IndexIsFirst ? Kind::FromFirst : Kind::FromLast, shards.IndexBytes });
    if (!file)
    {
      return std::nullopt;
    }
    const ZarrParts::Index offsets = this->Parts.GetIndex(shards, *file);
    const std::uint64_t offset = (*offsets)[2 * number];
    const std::uint64_t bytes = (*offsets)[2 * number + 1];
    if (offset == ~std::uint64_t{ 0 } && bytes == ~std::uint64_t{ 0 })
    {
      return std::nullopt;
    }
    if (offset > file->GetBytes() || bytes > file->GetBytes() - offset)
    {
      throw FileError(file->GetPath(), "is truncated or its index is wrong.");
    }
    return StoredFile::Place{ file, offset, static_cast<std::size_t>(bytes) };
  }

  std::shared_ptr<ZarrStore> Store;
  std::string Folder;                                           ///< with what is shown
  std::string Name;                                             ///< of an array without one
  bool IsPlaced;                                                ///< by what it says
  std::vector<ZarrSource> Sources;                              ///< one for each array
  std::map<std::string, std::unique_ptr<ZarrListing>> Listings; ///< by folder
  std::unordered_set<std::string> Names;
  mutable ZarrParts Parts;
};

} // namespace

std::shared_ptr<VolumeFile> OpenZarr(const std::string& path, const OpenOptions& options)
{
  return std::make_shared<ZarrFile>(path, options);
}

} // namespace vol
