// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrJson_h
#define vol_ZarrJson_h

#include "DSMVolumeFiles/base/FileLimits.h"

#include "DSMVolumeFiles/codec/CodecJson.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

class ZarrStore;

/// Zarr's metadata as they are in a file: checked before they are used.
namespace ZarrJson
{

/// Reads a file in a folder; null where there is none. Consolidated metadata, copies of other files, are left out.
/// Throws dsm::Error, which names the file, when it is larger or deeper than FileLimits has it, or not JSON.
nlohmann::json Read(const ZarrStore& store, const std::string& folder, const std::string& name);
/// Parses a text of metadata, with the words that Python writes for numbers. `skipped`: see ParseJson, which throws.
nlohmann::json Parse(const std::string& text, const char* skipped);

using CodecJson::Find;

/// Returns a text; empty where there is none. Throws dsm::Error, which names the folder, when it is longer than a name.
std::string GetText(const std::string& folder, const nlohmann::json& object, const char* name);

/// Returns an array's integers. Throws dsm::Error, which names the folder and the member, when it is not an array of
/// at most so many integers in [least, most].
std::vector<std::int64_t> GetIntegers(const std::string& folder, const nlohmann::json& object,
  const char* name, std::uint64_t count, std::int64_t least, std::int64_t most);

/// Returns a number, or those of an array of at most FileLimits::Axes; empty if a value is not a number.
std::vector<double> ToNumbers(const nlohmann::json& value);
/// Returns a member that is an array. Throws dsm::Error, which names the folder and the member, when it is not.
const nlohmann::json& GetArray(
  const std::string& folder, const nlohmann::json& object, const char* name);

/// Returns an array's numbers; nothing where there is no such member. Throws likewise, also when an element is not a
/// finite number.
std::vector<double> GetNumbers(
  const std::string& folder, const nlohmann::json& object, const char* name, std::uint64_t count);

/// Throws dsm::Error: the array or group in a folder cannot be read.
[[noreturn]] void Refuse(const std::string& folder, const std::string& why);

} // namespace ZarrJson

} // namespace vol

#endif
