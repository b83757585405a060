// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_files_VolumeManifest_h
#define tests_files_VolumeManifest_h

#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// What make_files.py says of the files that it has made.
namespace dsm_test
{

using Json = nlohmann::json;
namespace fs = std::filesystem;

inline fs::path GetFolder()
{
  return DSM_TEST_FILES;
}

inline Json ReadManifest()
{
  std::ifstream file(GetFolder() / "manifest.json");
  return file ? Json::parse(file) : Json::array();
}

inline bricks::ScalarType ToType(const std::string& name)
{
  using Type = bricks::ScalarType;
  const std::vector<std::pair<std::string, Type>> types = { { "int8", Type::Int8 },
    { "uint8", Type::UInt8 }, { "int16", Type::Int16 }, { "uint16", Type::UInt16 },
    { "int32", Type::Int32 }, { "int64", Type::Int64 }, { "float32", Type::Float32 },
    { "float64", Type::Float64 } };
  const auto known =
    std::find_if(types.begin(), types.end(), [&](const auto& type) { return type.first == name; });
  if (known == types.end())
  {
    throw std::logic_error("make_files.py has no type " + name);
  }
  return known->second;
}

inline vol::OpenOptions GetOptions(const Json& entry)
{
  vol::OpenOptions options;
  options.Level = entry.at("level");
  options.Dataset = entry.at("dataset");
  if (entry.contains("raw"))
  {
    const Json& raw = entry["raw"];
    options.Bare.Samples = { entry["size"][0], entry["size"][1], entry["size"][2] };
    options.Bare.Type = ToType(raw["type"]);
    options.Bare.BigEndian = raw["big"];
    options.Bare.HeaderBytes = raw["header"];
    for (int axis = 0; axis < 3; ++axis)
    {
      options.Spacing[static_cast<std::size_t>(axis)] = raw["spacing"][axis];
    }
  }
  return options;
}

inline std::shared_ptr<const vol::VolumeFile> Open(const Json& entry)
{
  return vol::OpenVolumeFile(
    (GetFolder() / entry.at("file").get<std::string>()).string(), GetOptions(entry));
}

inline Json FindEntry(const std::string& name)
{
  const Json manifest = ReadManifest();
  const auto found = std::find_if(
    manifest.begin(), manifest.end(), [&](const Json& entry) { return entry["file"] == name; });
  return found == manifest.end() ? Json() : *found;
}

} // namespace dsm_test

#endif
