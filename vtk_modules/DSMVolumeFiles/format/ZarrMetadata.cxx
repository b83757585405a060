// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ZarrMetadata.h"

#include "DSMCore/base/Error.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
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

std::vector<std::byte> ParseFill(const Json& value, rt::ScalarType type)
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
        const std::string text = value.get<std::string>();
        const T infinity = std::numeric_limits<T>::infinity();
        fill = text == "Infinity" ? infinity
          : text == "-Infinity"   ? -infinity
                                  : std::numeric_limits<T>::quiet_NaN();
      }
      std::vector<std::byte> bytes(sizeof(T));
      std::memcpy(bytes.data(), &fill, sizeof(T));
      return bytes;
    });
}

CodecStep ParseCodec(const std::string& folder, const std::string& name)
{
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
  data.Separator = json.value("dimension_separator", ".");
  if (json.value("order", "C") != "C")
  {
    Refuse(folder, "its values are in the order of Fortran. Write it with order='C'.");
  }
  std::vector<CodecStep> steps;
  if (ParseType2(folder, json.at("dtype").get<std::string>(), data.Type))
  {
    steps.push_back({ Kind::SwapBytes, rt::GetBytes(data.Type) });
  }
  data.Fill = ParseFill(json.value("fill_value", Json()), data.Type);
  const Json filters = json.value("filters", Json());
  for (const Json& filter : filters.is_null() ? Json::array() : filters)
  {
    const std::string name = filter.at("id").get<std::string>();
    steps.push_back(name == "shuffle"
        ? CodecStep{ Kind::Shuffle, filter.value("elementsize", std::size_t(4)) }
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

/// Of version 3, but for sharding.
std::vector<CodecStep> ParseCodecs3(
  const std::string& folder, const Json& codecs, std::size_t width)
{
  std::vector<CodecStep> steps;
  for (const Json& codec : codecs)
  {
    const std::string name = codec.at("name").get<std::string>();
    const Json configuration = codec.value("configuration", Json::object());
    if (name == "bytes")
    {
      if (configuration.value("endian", "little") == "big" && width > 1)
      {
        steps.push_back({ Kind::SwapBytes, width });
      }
    }
    else if (name == "transpose")
    {
      const auto order = configuration.at("order").get<std::vector<int>>();
      for (std::size_t axis = 0; axis < order.size(); ++axis)
      {
        if (order[axis] != static_cast<int>(axis))
        {
          Refuse(folder, "its axes are transposed in the file, which is not supported.");
        }
      }
    }
    else
    {
      steps.push_back(ParseCodec(folder, name));
    }
  }
  return steps;
}

ZarrMetadata ParseVersion3(const std::string& folder, const Json& json)
{
  ZarrMetadata data;
  data.Shape = json.at("shape").get<std::vector<std::int64_t>>();
  data.ChunkShape =
    json.at("chunk_grid").at("configuration").at("chunk_shape").get<std::vector<std::int64_t>>();
  ParseType3(folder, json.at("data_type").get<std::string>(), data.Type);
  data.Fill = ParseFill(json.value("fill_value", Json()), data.Type);
  const Json encoding = json.value("chunk_key_encoding", Json::object());
  const bool isDefault = encoding.value("name", "default") == "default";
  data.Prefix = isDefault ? "c" : "";
  data.Separator =
    encoding.value("configuration", Json::object()).value("separator", isDefault ? "/" : ".");
  const std::size_t width = rt::GetBytes(data.Type);
  Json codecs = json.at("codecs");
  if (codecs.size() == 1 && codecs[0].at("name") == "sharding_indexed")
  {
    const Json configuration = codecs[0].at("configuration");
    ZarrMetadata::Sharding shards;
    shards.ShardShape = std::exchange(
      data.ChunkShape, configuration.at("chunk_shape").get<std::vector<std::int64_t>>());
    shards.IndexIsFirst = configuration.value("index_location", "end") == "start";
    const std::vector<CodecStep> steps =
      ParseCodecs3(folder, configuration.at("index_codecs"), sizeof(std::uint64_t));
    shards.IndexBytes = 2 * sizeof(std::uint64_t);
    for (std::size_t axis = 0; axis < data.ChunkShape.size(); ++axis)
    {
      shards.IndexBytes *=
        static_cast<std::size_t>(shards.ShardShape.at(axis) / data.ChunkShape[axis]);
    }
    for (const CodecStep& step : steps)
    {
      shards.IndexBytes += step.What == Kind::Crc32c ? sizeof(std::uint32_t) : 0;
    }
    shards.IndexCodec = ChunkCodec(steps);
    data.Shards = std::move(shards);
    codecs = configuration.at("codecs");
  }
  data.Codec = ChunkCodec(ParseCodecs3(folder, codecs, width));
  return data;
}

} // namespace

bool ZarrMetadata::IsVolume() const
{
  const std::size_t axes = this->Shape.size();
  bool isRight = axes == this->ChunkShape.size() && axes >= 3 && axes <= 5;
  for (std::size_t axis = 0; isRight && axis < axes; ++axis)
  {
    isRight = this->Shape[axis] > 0 && this->ChunkShape[axis] > 0 &&
      (!this->Shards || this->Shards->ShardShape[axis] % this->ChunkShape[axis] == 0);
  }
  return isRight;
}

nlohmann::json ReadZarrJson(const std::string& folder, const std::string& name)
{
  const std::string path = folder + "/" + name;
  if (!std::filesystem::exists(path))
  {
    return {};
  }
  std::ifstream file(path);
  if (!file)
  {
    Refuse(folder, "its file " + name + " cannot be read: " + std::strerror(errno) + ".");
  }
  try
  {
    return Json::parse(file);
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
    return version2.is_null() ? ParseVersion3(folder, version3) : ParseVersion2(folder, version2);
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
