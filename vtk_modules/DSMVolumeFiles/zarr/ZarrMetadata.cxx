// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrMetadata.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/codec/CodecJson.h"
#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/zarr/ZarrJson.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <system_error>
#include <type_traits>
#include <utility>

namespace vol
{

namespace
{

using Json = nlohmann::json;

using ZarrJson::Refuse;

/// Version 2: "<f4", 3: "float32". `isSwapped`: set to whether the bytes are the other way round than the machine's.
PackedValues ParseType(const std::string& folder, const std::string& text, bool& isSwapped)
{
  if (text == "<f2" || text == ">f2" || text == "float16")
  {
    isSwapped = text[0] == '>';
    return PackedValues::OfHalves();
  }
  const bool isTruth = text == "|b1" || text == "bool";
  const auto known = CodecJson::FindType(isTruth ? "uint8" : text);
  if (!known)
  {
    Refuse(folder, "scalar type " + Quote(text) + " is not supported.");
  }
  isSwapped = known->Swapped;
  return PackedValues(known->Type);
}

/// Version 3 may have it as bits: "0x7fc00000".
template <class T>
T ParseFillText(const std::string& folder, const std::string& text)
{
  using Limits = std::numeric_limits<T>;
  T fill = Limits::quiet_NaN();
  if (text.rfind("0x", 0) == 0)
  {
    std::uint64_t bits = 0;
    const char* const last = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + 2, last, bits, 16);
    if (parsed.ec != std::errc() || parsed.ptr != last || text.size() > 2 + 2 * sizeof(T))
    {
      Refuse(folder, "its fill value " + Quote(text) + " is invalid.");
    }
    std::memcpy(&fill, &bits, sizeof(T)); // lowest byte first, as is all that we run on
  }
  else if (text == "Infinity" || text == "-Infinity")
  {
    fill = text[0] == '-' ? -Limits::infinity() : Limits::infinity();
  }
  else if (text != "NaN")
  {
    Refuse(folder, "its fill value " + Quote(text) + " is invalid.");
  }
  return fill;
}

/// A number as a value of the array's type. None where it does not fit: to convert it anyway is undefined.
template <class T>
std::optional<T> ToValue(const Json& number)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    const double value = number.get<double>();
    const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<T>::max());
    return fits
      ? static_cast<T>(value)
      : std::copysign(std::numeric_limits<T>::infinity(), static_cast<T>(value > 0.0 ? 1 : -1));
  }
  // Wide enough for every integer of 64 bits.
  const long double value = number.is_number_unsigned() ? number.get<std::uint64_t>()
    : number.is_number_integer()                        ? number.get<std::int64_t>()
                                                        : number.get<long double>();
  const bool fits = value == std::floor(value) &&
    value >= static_cast<long double>(std::numeric_limits<T>::lowest()) &&
    value <= static_cast<long double>(std::numeric_limits<T>::max());
  return fits ? std::optional<T>(static_cast<T>(value)) : std::nullopt;
}

std::vector<std::byte> ParseFill(
  const std::string& folder, const Json& value, const PackedValues& packed)
{
  if (packed.AreHalves())
  {
    const std::string text = value.is_string() ? value.get<std::string>() : std::string();
    if (text.rfind("0x", 0) == 0)
    {
      const auto bits = ParseFillText<std::uint16_t>(folder, text);
      std::vector<std::byte> bytes(sizeof(bits));
      std::memcpy(bytes.data(), &bits, sizeof(bits));
      return bytes;
    }
    const auto single = ParseFill(folder, value, PackedValues(bricks::ScalarType::Float32));
    float number;
    std::memcpy(&number, single.data(), sizeof(number));
    return PackedValues::ToHalf(number);
  }
  return bricks::Dispatch(packed.GetStored(),
    [&](auto zero)
    {
      using T = decltype(zero);
      std::optional<T> fill = zero;
      if (value.is_number())
      {
        fill = ToValue<T>(value);
      }
      else if (value.is_boolean())
      {
        fill = value.get<bool>() ? T(1) : T(0);
      }
      else if (value.is_string() && std::numeric_limits<T>::has_quiet_NaN)
      {
        fill = ParseFillText<T>(folder, value.get<std::string>());
      }
      else if (!value.is_null())
      {
        fill.reset();
      }
      if (!fill)
      {
        Refuse(folder,
          "its fill value " +
            Quote(value.is_number() ? value.dump() : std::string(value.type_name())) +
            " does not fit its scalar type.");
      }
      std::vector<std::byte> bytes(sizeof(T));
      std::memcpy(bytes.data(), &*fill, sizeof(T));
      return bytes;
    });
}

/// `decoded`: the type of the values that the codec gets, where its configuration does not name one.
CodecStep ParseCodec(const std::string& folder, const std::string& fullName,
  const Json& configuration, const ElementType& decoded)
{
  // As zarr-python 3 names those of version 2.
  constexpr std::string_view space = "numcodecs.";
  const std::string name = fullName.rfind(space, 0) == 0 ? fullName.substr(space.size()) : fullName;
  if (name == "sharding_indexed")
  {
    Refuse(folder, "its shards are nested or combined with other codecs, which is not supported.");
  }
  const Codec* const codec = FindZarrCodec(name);
  if (!codec)
  {
    Refuse(folder,
      "its filter or compressor " + Quote(fullName) + " is not supported. Supported are " +
        ListZarrCodecs() + ". Write the array again with one of these, as zarr-python does.");
  }
  try
  {
    return CodecStep(
      codec, codec->ParseZarr ? codec->ParseZarr(configuration, decoded) : CodecParameters());
  }
  catch (const dsm::Error& error)
  {
    Refuse(folder, "its codec " + Quote(fullName) + " " + error.what());
  }
}

/// Between the indices in a chunk's name. With any other, two chunks may have one name, or lie outside of the folder.
std::string GetSeparator(
  const std::string& folder, const Json& object, const char* name, const std::string& usual)
{
  const Json& found = ZarrJson::Find(object, name);
  const std::string separator = found.is_null() ? usual : ZarrJson::GetText(folder, object, name);
  if (separator != "." && separator != "/")
  {
    Refuse(folder,
      "its '" + std::string(name) + "' is " + Quote(separator) + "; '.' and '/' are valid.");
  }
  return separator;
}

/// Lengths of an array, or of its chunks, along its axes.
std::vector<std::int64_t> GetShape(
  const std::string& folder, const Json& object, const char* name, std::int64_t most)
{
  return ZarrJson::GetIntegers(folder, object, name, FileLimits::Axes, 0, most);
}

constexpr auto MostSamples = static_cast<std::int64_t>(FileLimits::Samples);

/// As the class has it, with the folder's name in its errors.
ChunkCodec MakeCodec(const std::string& folder, std::vector<CodecStep> steps)
{
  try
  {
    return ChunkCodec(std::move(steps));
  }
  catch (const dsm::Error& error)
  {
    Refuse(folder, error.what());
  }
}

ZarrMetadata ParseVersion2(const ZarrStore& store, const std::string& folder, const Json& json)
{
  ZarrMetadata data;
  data.Shape = GetShape(folder, json, "shape", MostSamples);
  data.ChunkShape = GetShape(folder, json, "chunks", MostSamples);
  const bool isDeclared = !ZarrJson::Find(json, "dimension_separator").is_null();
  const bool looksNested = !isDeclared && store.LooksNested(folder, data.Shape.size());
  data.Separator = GetSeparator(folder, json, "dimension_separator", looksNested ? "/" : ".");
  data.FortranOrder = ZarrJson::GetText(folder, json, "order") == "F";
  std::vector<CodecStep> steps;
  if (!ZarrJson::Find(json, "dtype").is_string())
  {
    Refuse(folder, "its values are records with several fields, which is not supported.");
  }
  bool isSwapped = false;
  data.Packed = ParseType(folder, ZarrJson::GetText(folder, json, "dtype"), isSwapped);
  if (isSwapped)
  {
    steps.push_back({ "swap", bricks::GetBytes(data.Packed.GetStored()) });
  }
  data.Fill = ParseFill(folder, ZarrJson::Find(json, "fill_value"), data.Packed);
  const Json& filters = ZarrJson::Find(json, "filters");
  CheckLimit(folder, "filters", filters.size(), FileLimits::Filters);
  const auto parse = [&](const Json& codec)
  {
    return ParseCodec(folder, ZarrJson::GetText(folder, codec, "id"), codec,
      { data.Packed.GetStored(), isSwapped });
  };
  for (const Json& filter : filters)
  {
    steps.push_back(parse(filter));
  }
  const Json& compressor = ZarrJson::Find(json, "compressor");
  if (!compressor.is_null())
  {
    steps.push_back(parse(compressor));
  }
  data.Codec = MakeCodec(folder, std::move(steps));
  return data;
}

/// Version 3 has names, or objects with a name and what else there is to say.
std::string GetName(const std::string& folder, const Json& named)
{
  return named.is_string() ? named.get<std::string>() : ZarrJson::GetText(folder, named, "name");
}

const Json& GetConfiguration(const Json& named)
{
  return ZarrJson::Find(named, "configuration");
}

/// Applies a transposition to axes that are in any order already.
void Transpose(const std::string& folder, const Json& configuration, std::vector<std::size_t>& axes)
{
  const std::size_t count = axes.size();
  const std::vector<std::int64_t> order = ZarrJson::GetIntegers(folder, configuration, "order",
    FileLimits::Axes, 0, static_cast<std::int64_t>(FileLimits::Axes));
  const std::vector<std::size_t> before = std::exchange(axes, {});
  std::vector<bool> isThere(count, false);
  for (const std::int64_t axis : order)
  {
    const auto place = static_cast<std::size_t>(axis);
    if (place < count && !isThere[place])
    {
      isThere[place] = true;
      axes.push_back(before[place]);
    }
  }
  if (axes.size() != count || order.size() != count)
  {
    Refuse(folder, "its transpose codec does not match its " + std::to_string(count) + " axes.");
  }
}

/// Parses the codecs of version 3, except for sharding, of an array with so many axes.
/// `fortranOrder`: set to whether consecutive transpositions result in a reversal of all axes.
std::vector<CodecStep> ParseCodecs3(const std::string& folder, const Json& codecs,
  bricks::ScalarType type, std::size_t count, bool& fortranOrder)
{
  if (!codecs.is_array())
  {
    Refuse(folder, "its 'codecs' are missing or not an array.");
  }
  CheckLimit(folder, "codecs", codecs.size(), FileLimits::Filters);
  std::vector<CodecStep> steps;
  std::vector<std::size_t> axes(count);
  std::iota(axes.begin(), axes.end(), std::size_t(0));
  for (const Json& codec : codecs)
  {
    const std::string name = GetName(folder, codec);
    const Json& configuration = GetConfiguration(codec);
    if (name == "bytes")
    {
      const std::size_t width = bricks::GetBytes(type);
      if (ZarrJson::GetText(folder, configuration, "endian") == "big" && width > 1)
      {
        steps.push_back({ "swap", width });
      }
    }
    else if (name == "transpose")
    {
      Transpose(folder, configuration, axes);
    }
    else
    {
      steps.push_back(ParseCodec(folder, name, configuration, { type }));
      if (steps.back().What->ConvertsNumbers)
      {
        // It works on numbers, not on bytes: only "bytes" gives these an order.
        CodecParameters& with = steps.back().With;
        with.Decoded.Swapped = with.Encoded.Swapped = false;
        type = with.Encoded.Type;
      }
    }
  }
  fortranOrder = count > 1 && std::is_sorted(axes.rbegin(), axes.rend());
  if (!fortranOrder && !std::is_sorted(axes.begin(), axes.end()))
  {
    Refuse(folder,
      "only some of its axes are transposed, which is not supported. Transpose all axes or none.");
  }
  return steps;
}

/// Chunks in a shard.
std::size_t CountChunks(const std::string& folder, const std::vector<std::int64_t>& shard,
  const std::vector<std::int64_t>& chunk)
{
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < chunk.size(); ++axis)
  {
    const bool isWhole =
      axis < shard.size() && chunk[axis] > 0 && shard[axis] > 0 && shard[axis] % chunk[axis] == 0;
    const auto along = isWhole ? static_cast<std::uint64_t>(shard[axis] / chunk[axis]) : 0;
    const auto product = MultiplyWithin(FileLimits::ShardChunks, { count, along });
    if (!isWhole || !product)
    {
      Refuse(folder,
        "its shards do not consist of whole chunks, or have too many chunks: at most " +
          std::to_string(FileLimits::ShardChunks) + " chunks per shard are supported.");
    }
    count = *product;
  }
  return static_cast<std::size_t>(count);
}

/// Takes what a codec says of shards; the chunks of the array so far are they.
ZarrMetadata::Sharding ParseSharding(
  const std::string& folder, const Json& configuration, ZarrMetadata& data)
{
  ZarrMetadata::Sharding shards;
  shards.ShardShape =
    std::exchange(data.ChunkShape, GetShape(folder, configuration, "chunk_shape", MostSamples));
  shards.IndexIsFirst = ZarrJson::GetText(folder, configuration, "index_location") == "start";
  bool isTransposed = false;
  // Its last axis has an offset and a length.
  const std::vector<CodecStep> steps =
    ParseCodecs3(folder, ZarrJson::Find(configuration, "index_codecs"), bricks::ScalarType::UInt64,
      data.Shape.size() + 1, isTransposed);
  if (isTransposed)
  {
    Refuse(folder, "the index of its shards is transposed, which is not supported.");
  }
  shards.IndexBytes =
    CountChunks(folder, shards.ShardShape, data.ChunkShape) * 2 * sizeof(std::uint64_t);
  for (const CodecStep& step : steps)
  {
    // Its length must be known before it is read.
    if (!step.What->KeepsPlaces && step.What->Name != "crc32c")
    {
      Refuse(folder, "the index of its shards is compressed, which is not supported.");
    }
    shards.IndexBytes += step.What->AddedBytes;
  }
  shards.IndexCodec = MakeCodec(folder, steps);
  return shards;
}

ZarrMetadata ParseVersion3(const std::string& folder, const Json& json)
{
  ZarrMetadata data;
  data.Shape = GetShape(folder, json, "shape", MostSamples);
  const Json& grid = ZarrJson::Find(json, "chunk_grid");
  if (GetName(folder, grid) != "regular")
  {
    Refuse(folder,
      "its chunks do not have a regular grid (chunk grid " + Quote(GetName(folder, grid)) + ").");
  }
  // A shard may be larger than the array.
  constexpr std::int64_t mostOfShard = std::int64_t(1) << 52;
  data.ChunkShape = GetShape(folder, GetConfiguration(grid), "chunk_shape", mostOfShard);
  bool isSwapped = false; // only the codec "bytes" says so
  data.Packed = ParseType(folder, GetName(folder, ZarrJson::Find(json, "data_type")), isSwapped);
  data.Fill = ParseFill(folder, ZarrJson::Find(json, "fill_value"), data.Packed);
  const Json& encoding = ZarrJson::Find(json, "chunk_key_encoding");
  const bool isDefault = encoding.empty() || GetName(folder, encoding) == "default";
  data.Prefix = isDefault ? "c" : "";
  data.Separator =
    GetSeparator(folder, GetConfiguration(encoding), "separator", isDefault ? "/" : ".");
  data.Axes = ZarrJson::Find(json, "dimension_names");
  const Json* codecs = &ZarrJson::Find(json, "codecs");
  if (codecs->is_array() && codecs->size() == 1 &&
    GetName(folder, codecs->front()) == "sharding_indexed")
  {
    const Json& configuration = GetConfiguration(codecs->front());
    data.Shards = ParseSharding(folder, configuration, data);
    codecs = &ZarrJson::Find(configuration, "codecs");
  }
  data.Codec = MakeCodec(folder,
    ParseCodecs3(folder, *codecs, data.Packed.GetStored(), data.Shape.size(), data.FortranOrder));
  return data;
}

} // namespace

bool ZarrMetadata::IsVolume() const
{
  const std::size_t axes = this->Shape.size();
  bool isRight = axes == this->ChunkShape.size() && axes >= 3 && axes <= 5;
  for (std::size_t axis = 0; isRight && axis < axes; ++axis)
  {
    isRight = this->Shape[axis] > 0 && this->Shape[axis] <= MostSamples &&
      this->ChunkShape[axis] > 0 && this->ChunkShape[axis] <= MostSamples;
  }
  return isRight;
}

std::string ZarrMetadata::GetKey(const std::int64_t* place) const
{
  std::string key = this->Prefix;
  for (std::size_t axis = 0; axis < this->Shape.size(); ++axis)
  {
    key += (key.empty() ? "" : this->Separator) + std::to_string(place[axis]);
  }
  return key;
}

std::vector<std::uint64_t> ZarrMetadata::CountFiles() const
{
  const auto& across = this->Shards ? this->Shards->ShardShape : this->ChunkShape;
  std::vector<std::uint64_t> counts;
  for (std::size_t axis = 0; axis < across.size(); ++axis)
  {
    counts.push_back(static_cast<std::uint64_t>((this->Shape[axis] - 1) / across[axis] + 1));
  }
  return counts;
}

std::optional<ZarrMetadata> ReadZarrMetadata(const ZarrStore& store, const std::string& folder)
{
  try
  {
    const Json version2 = ZarrJson::Read(store, folder, ".zarray");
    const Json version3 = version2.is_null() ? ZarrJson::Read(store, folder, "zarr.json") : Json();
    if (version2.is_null() && ZarrJson::GetText(folder, version3, "node_type") != "array")
    {
      return std::nullopt;
    }
    ZarrMetadata data =
      version2.is_null() ? ParseVersion3(folder, version3) : ParseVersion2(store, folder, version2);
    data.Attributes = ReadZarrAttributes(store, folder);
    if (!version2.is_null()) // as xarray writes them
    {
      data.Axes = ZarrJson::Find(data.Attributes, "_ARRAY_DIMENSIONS");
    }
    return data;
  }
  catch (const Json::exception&)
  {
    Refuse(folder, "a member of its metadata has a wrong type.");
  }
}

nlohmann::json ReadZarrAttributes(const ZarrStore& store, const std::string& folder)
{
  Json version3 = ZarrJson::Read(store, folder, "zarr.json");
  if (version3.is_null())
  {
    version3["attributes"] = ZarrJson::Read(store, folder, ".zattrs");
  }
  Json attributes = Json::object();
  if (ZarrJson::Find(version3, "attributes").is_object())
  {
    attributes.swap(version3["attributes"]);
  }
  return attributes;
}

} // namespace vol
