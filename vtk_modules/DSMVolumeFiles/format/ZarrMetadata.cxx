// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ZarrMetadata.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <system_error>
#include <utility>

namespace vol
{

namespace
{

using Json = nlohmann::json;
using Kind = CodecStep::Kind;

[[noreturn]] void Refuse(const std::string& folder, const std::string& why)
{
  throw dsm::Error("The Zarr array '" + folder + "' cannot be read: " + why);
}

/// Version 2: "<f4". Returns whether the bytes are the other way round than the machine's.
bool ParseType2(const std::string& folder, const std::string& text, rt::ScalarType& type)
{
  using Type = rt::ScalarType;
  static const std::map<std::string, Type> types = { { "i1", Type::Int8 }, { "u1", Type::UInt8 },
    { "b1", Type::UInt8 }, { "i2", Type::Int16 }, { "u2", Type::UInt16 }, { "i4", Type::Int32 },
    { "u4", Type::UInt32 }, { "i8", Type::Int64 }, { "u8", Type::UInt64 }, { "f4", Type::Float32 },
    { "f8", Type::Float64 } };
  const auto known = types.find(text.size() == 3 ? text.substr(1) : text);
  if (known == types.end())
  {
    Refuse(folder, "values of the type '" + text + "' are not known.");
  }
  type = known->second;
  return text[0] == '>' && rt::GetBytes(type) > 1;
}

void ParseType3(const std::string& folder, const std::string& text, rt::ScalarType& type)
{
  using Type = rt::ScalarType;
  static const std::map<std::string, Type> types = { { "int8", Type::Int8 },
    { "uint8", Type::UInt8 }, { "bool", Type::UInt8 }, { "int16", Type::Int16 },
    { "uint16", Type::UInt16 }, { "int32", Type::Int32 }, { "uint32", Type::UInt32 },
    { "int64", Type::Int64 }, { "uint64", Type::UInt64 }, { "float32", Type::Float32 },
    { "float64", Type::Float64 } };
  const auto known = types.find(text);
  if (known == types.end())
  {
    Refuse(folder, "values of the type '" + text + "' are not known.");
  }
  type = known->second;
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
      Refuse(folder, "its fill value '" + text + "' is none.");
    }
    std::memcpy(&fill, &bits, sizeof(T)); // lowest byte first, as is all that we run on
  }
  else if (text == "Infinity" || text == "-Infinity")
  {
    fill = text[0] == '-' ? -Limits::infinity() : Limits::infinity();
  }
  else if (text != "NaN")
  {
    Refuse(folder, "its fill value '" + text + "' is none.");
  }
  return fill;
}

std::vector<std::byte> ParseFill(const std::string& folder, const Json& value, rt::ScalarType type)
{
  return rt::Dispatch(type,
    [&](auto zero)
    {
      using T = decltype(zero);
      T fill = zero;
      if (value.is_number())
      {
        fill = value.get<T>();
      }
      else if (value.is_boolean())
      {
        fill = value.get<bool>() ? T(1) : T(0);
      }
      else if (value.is_string() && std::numeric_limits<T>::has_quiet_NaN)
      {
        fill = ParseFillText<T>(folder, value.get<std::string>());
      }
      std::vector<std::byte> bytes(sizeof(T));
      std::memcpy(bytes.data(), &fill, sizeof(T));
      return bytes;
    });
}

CodecStep ParseCodec(const std::string& folder, const std::string& name)
{
  if (name == "sharding_indexed")
  {
    Refuse(folder,
      "its shards have shards in them, or codecs before or behind them, which is not supported.");
  }
  static const std::map<std::string, Kind> kinds = { { "zlib", Kind::Deflate },
    { "gzip", Kind::Deflate }, { "blosc", Kind::Blosc }, { "zstd", Kind::Zstd },
    { "crc32c", Kind::Crc32c }, { "fletcher32", Kind::Fletcher32 } };
  const auto known = kinds.find(name);
  if (known == kinds.end())
  {
    Refuse(folder,
      "its values are made with '" + name +
        "', which is not known; blosc, gzip, zlib, zstd and crc32c are.");
  }
  return { known->second };
}

ZarrMetadata ParseVersion2(const std::string& folder, const Json& json)
{
  ZarrMetadata data;
  data.Shape = json.at("shape").get<std::vector<std::int64_t>>();
  data.ChunkShape = json.at("chunks").get<std::vector<std::int64_t>>();
  // Old nested stores do not say so.
  const bool looksNested = std::filesystem::is_directory(folder + "/0");
  data.Separator = json.value("dimension_separator", looksNested ? "/" : ".");
  data.FortranOrder = json.value("order", "C") == "F";
  std::vector<CodecStep> steps;
  if (!json.at("dtype").is_string())
  {
    Refuse(folder, "its values are records of several fields, which is not supported.");
  }
  if (ParseType2(folder, json.at("dtype").get<std::string>(), data.Type))
  {
    steps.push_back({ Kind::SwapBytes, rt::GetBytes(data.Type) });
  }
  data.Fill = ParseFill(folder, json.value("fill_value", Json()), data.Type);
  const Json filters = json.value("filters", Json());
  for (const Json& filter : filters.is_null() ? Json::array() : filters)
  {
    const std::string name = filter.at("id").get<std::string>();
    steps.push_back(name == "shuffle"
        ? CodecStep{ Kind::Shuffle,
            std::max<std::size_t>(1, filter.value("elementsize", std::size_t(4))) }
        : ParseCodec(folder, name));
  }
  const Json compressor = json.value("compressor", Json());
  if (!compressor.is_null())
  {
    steps.push_back(ParseCodec(folder, compressor.at("id").get<std::string>()));
  }
  data.Codec = ChunkCodec(std::move(steps));
  return data;
}

/// Version 3 has names, or objects with a name and what else there is to say.
std::string GetName(const Json& named)
{
  return named.is_string() ? named.get<std::string>() : named.at("name").get<std::string>();
}

Json GetConfiguration(const Json& named)
{
  return named.is_object() ? named.value("configuration", Json::object()) : Json::object();
}

/// Of version 3, but for sharding, of an array of so many axes. `fortranOrder`: whether all are transposed, after all
/// transpositions, which follow one another.
std::vector<CodecStep> ParseCodecs3(const std::string& folder, const Json& codecs,
  std::size_t width, std::size_t count, bool& fortranOrder)
{
  std::vector<CodecStep> steps;
  std::vector<std::size_t> axes(count);
  std::iota(axes.begin(), axes.end(), std::size_t(0));
  for (const Json& codec : codecs)
  {
    const std::string name = GetName(codec);
    const Json configuration = GetConfiguration(codec);
    if (name == "bytes")
    {
      if (configuration.value("endian", "little") == "big" && width > 1)
      {
        steps.push_back({ Kind::SwapBytes, width });
      }
    }
    else if (name == "transpose")
    {
      const auto order = configuration.at("order").get<std::vector<std::size_t>>();
      if (!std::is_permutation(order.begin(), order.end(), axes.begin(), axes.end()))
      {
        Refuse(folder,
          "its axes are transposed as those of another array; it has " + std::to_string(count) +
            " axes.");
      }
      std::transform(order.begin(), order.end(), axes.begin(),
        [before = axes](std::size_t axis) { return before[axis]; });
    }
    else
    {
      steps.push_back(ParseCodec(folder, name));
    }
  }
  fortranOrder = count > 1 && std::is_sorted(axes.rbegin(), axes.rend());
  if (!fortranOrder && !std::is_sorted(axes.begin(), axes.end()))
  {
    Refuse(folder,
      "some of its axes are transposed in the file, which is not supported; only all can be.");
  }
  return steps;
}

/// In a shard.
std::size_t CountChunks(const std::string& folder, const std::vector<std::int64_t>& shard,
  const std::vector<std::int64_t>& chunk)
{
  constexpr std::int64_t most = std::int64_t(1) << 40;
  std::int64_t count = 1;
  for (std::size_t axis = 0; axis < chunk.size(); ++axis)
  {
    if (chunk[axis] < 1 || shard.at(axis) < 1 || shard[axis] % chunk[axis] != 0 ||
      shard[axis] / chunk[axis] > most / count)
    {
      Refuse(folder, "its shards are not made of chunks, or of far too many.");
    }
    count *= shard[axis] / chunk[axis];
  }
  return static_cast<std::size_t>(count);
}

ZarrMetadata ParseVersion3(const std::string& folder, const Json& json)
{
  ZarrMetadata data;
  data.Shape = json.at("shape").get<std::vector<std::int64_t>>();
  if (GetName(json.at("chunk_grid")) != "regular")
  {
    Refuse(folder,
      "its chunks are not all alike (chunk grid '" + GetName(json.at("chunk_grid")) + "').");
  }
  data.ChunkShape =
    json.at("chunk_grid").at("configuration").at("chunk_shape").get<std::vector<std::int64_t>>();
  ParseType3(folder, GetName(json.at("data_type")), data.Type);
  data.Fill = ParseFill(folder, json.value("fill_value", Json()), data.Type);
  const Json encoding = json.value("chunk_key_encoding", Json::object());
  const bool isDefault = encoding.empty() || GetName(encoding) == "default";
  data.Prefix = isDefault ? "c" : "";
  data.Separator = GetConfiguration(encoding).value("separator", isDefault ? "/" : ".");
  data.Axes = json.value("dimension_names", Json());
  const std::size_t width = rt::GetBytes(data.Type);
  Json codecs = json.at("codecs");
  if (codecs.size() == 1 && GetName(codecs[0]) == "sharding_indexed")
  {
    const Json configuration = GetConfiguration(codecs[0]);
    ZarrMetadata::Sharding shards;
    shards.ShardShape = std::exchange(
      data.ChunkShape, configuration.at("chunk_shape").get<std::vector<std::int64_t>>());
    shards.IndexIsFirst = configuration.value("index_location", "end") == "start";
    bool isTransposed = false;
    // Its last axis has an offset and a length.
    const std::vector<CodecStep> steps = ParseCodecs3(folder, configuration.at("index_codecs"),
      sizeof(std::uint64_t), data.Shape.size() + 1, isTransposed);
    if (isTransposed)
    {
      Refuse(folder, "the index of its shards is transposed, which is not supported.");
    }
    shards.IndexBytes =
      CountChunks(folder, shards.ShardShape, data.ChunkShape) * 2 * sizeof(std::uint64_t);
    for (const CodecStep& step : steps)
    {
      shards.IndexBytes += step.What == Kind::Crc32c ? sizeof(std::uint32_t) : 0;
    }
    shards.IndexCodec = ChunkCodec(steps);
    data.Shards = std::move(shards);
    codecs = configuration.at("codecs");
  }
  data.Codec =
    ChunkCodec(ParseCodecs3(folder, codecs, width, data.Shape.size(), data.FortranOrder));
  return data;
}

} // namespace

bool ZarrMetadata::IsVolume() const
{
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  const std::size_t axes = this->Shape.size();
  bool isRight = axes == this->ChunkShape.size() && axes >= 3 && axes <= 5;
  for (std::size_t axis = 0; isRight && axis < axes; ++axis)
  {
    isRight = this->Shape[axis] > 0 && this->Shape[axis] <= most && this->ChunkShape[axis] > 0 &&
      this->ChunkShape[axis] <= most;
  }
  return isRight;
}

namespace
{

/// Python writes NaN and infinite numbers, which JSON does not have: they become texts, as Zarr has them.
std::string WithQuotedWords(const std::string& text)
{
  std::string result;
  bool inText = false;
  for (std::size_t at = 0; at < text.size(); ++at)
  {
    const char letter = text[at];
    inText = letter == '"' ? !inText : inText;
    const auto begins = [&](const char* word)
    { return text.compare(at, std::strlen(word), word) == 0; };
    if (inText && letter == '\\' && at + 1 < text.size())
    {
      result += letter;
      result += text[++at];
      continue;
    }
    const char* found = nullptr;
    for (const char* word : { "NaN", "Infinity", "-Infinity" })
    {
      found = !inText && begins(word) ? word : found;
    }
    result += found ? '"' + std::string(found) + '"' : std::string(1, letter);
    at += found ? std::strlen(found) - 1 : 0;
  }
  return result;
}

} // namespace

nlohmann::json ReadZarrJson(const std::string& folder, const std::string& name)
{
  const std::string path = folder + "/" + name;
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
  {
    if (failure)
    {
      Refuse(folder, "its file " + name + " cannot be read: " + failure.message() + ".");
    }
    return {};
  }
  std::ifstream file(path);
  if (!file)
  {
    Refuse(folder, "its file " + name + " cannot be read: " + std::strerror(errno) + ".");
  }
  try
  {
    const std::string text{ std::istreambuf_iterator<char>(file), {} };
    return Json::parse(WithQuotedWords(text));
  }
  catch (const Json::exception& error)
  {
    Refuse(folder, "its file " + name + " is damaged (" + error.what() + ").");
  }
}

std::optional<ZarrMetadata> ReadZarrMetadata(const std::string& folder)
{
  try
  {
    const Json version2 = ReadZarrJson(folder, ".zarray");
    const Json version3 = version2.is_null() ? ReadZarrJson(folder, "zarr.json") : Json();
    if (version2.is_null() && (version3.is_null() || version3.value("node_type", "") != "array"))
    {
      return std::nullopt;
    }
    ZarrMetadata data =
      version2.is_null() ? ParseVersion3(folder, version3) : ParseVersion2(folder, version2);
    if (!version2.is_null()) // as xarray writes them
    {
      data.Axes = ReadZarrAttributes(folder).value("_ARRAY_DIMENSIONS", Json());
    }
    return data;
  }
  catch (const std::exception& error)
  {
    if (dynamic_cast<const dsm::Error*>(&error))
    {
      throw;
    }
    Refuse(folder, std::string("its metadata are not as they should be (") + error.what() + ").");
  }
}

nlohmann::json ReadZarrAttributes(const std::string& folder)
{
  const Json version3 = ReadZarrJson(folder, "zarr.json");
  const Json attributes =
    version3.is_null() ? ReadZarrJson(folder, ".zattrs") : version3.value("attributes", Json());
  return attributes.is_object() ? attributes : Json::object();
}

} // namespace vol
