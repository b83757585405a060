// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrJson.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/BoundedJson.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace vol
{

namespace
{

using Json = nlohmann::json;

/// Returns the word at a place that Python writes for a number, and JSON does not have; null for any other.
const char* FindWord(const std::string& text, std::size_t at)
{
  for (const char* word : { "NaN", "Infinity", "-Infinity" })
  {
    if (text.compare(at, std::strlen(word), word) == 0)
    {
      return word;
    }
  }
  return nullptr;
}

/// Such words become texts, as Zarr has them.
std::string WithQuotedWords(const std::string& text)
{
  std::string result;
  result.reserve(text.size());
  bool inText = false;
  for (std::size_t at = 0; at < text.size(); ++at)
  {
    const char letter = text[at];
    inText = letter == '"' ? !inText : inText;
    const bool mayBegin = !inText && (letter == 'N' || letter == 'I' || letter == '-');
    const char* const word = mayBegin ? FindWord(text, at) : nullptr;
    if (word)
    {
      result.append("\"").append(word).append("\"");
      at += std::strlen(word) - 1;
      continue;
    }
    result += letter;
    if (inText && letter == '\\' && at + 1 < text.size())
    {
      result += text[++at];
    }
  }
  return result;
}

} // namespace

void ZarrJson::Refuse(const std::string& folder, const std::string& why)
{
  throw FileError(folder, "cannot be read: " + why);
}

nlohmann::json ZarrJson::Parse(const std::string& text, const char* skipped)
{
  return ParseJson(WithQuotedWords(text), skipped);
}

nlohmann::json ZarrJson::Read(
  const ZarrStore& store, const std::string& folder, const std::string& name)
{
  const std::optional<std::string> text = store.ReadMetadata(folder, name);
  if (!text)
  {
    return {};
  }
  try
  {
    return Parse(*text, "consolidated_metadata");
  }
  catch (const dsm::Error& error)
  {
    Refuse(folder, "its file " + name + " is damaged: " + error.what() + ".");
  }
}

std::string ZarrJson::GetText(
  const std::string& folder, const nlohmann::json& object, const char* name)
{
  const Json& found = Find(object, name);
  std::string text = found.is_string() ? found.get<std::string>() : std::string();
  if (text.size() > FileLimits::NameBytes)
  {
    Refuse(folder,
      "its '" + std::string(name) + "' has " + std::to_string(text.size()) + " bytes; at most " +
        std::to_string(FileLimits::NameBytes) + " are supported.");
  }
  return text;
}

const nlohmann::json& ZarrJson::GetArray(
  const std::string& folder, const nlohmann::json& object, const char* name)
{
  const Json& found = Find(object, name);
  if (!found.is_array())
  {
    Refuse(folder, "its '" + std::string(name) + "' is missing or not an array.");
  }
  return found;
}

std::vector<double> ZarrJson::GetNumbers(
  const std::string& folder, const nlohmann::json& object, const char* name, std::uint64_t count)
{
  if (Find(object, name).is_null())
  {
    return {};
  }
  const Json& found = GetArray(folder, object, name);
  CheckLimit(folder, "numbers in '" + std::string(name) + "'", found.size(), count);
  std::vector<double> numbers;
  for (const Json& one : found)
  {
    if (!one.is_number() || !std::isfinite(one.get<double>()))
    {
      Refuse(folder,
        "its '" + std::string(name) + "' has " +
          (one.is_string() ? Quote(one.get<std::string>()) : one.type_name()) +
          ", which is not a finite number.");
    }
    numbers.push_back(one.get<double>());
  }
  return numbers;
}

std::vector<std::int64_t> ZarrJson::GetIntegers(const std::string& folder,
  const nlohmann::json& object, const char* name, std::uint64_t count, std::int64_t least,
  std::int64_t most)
{
  const Json& found = GetArray(folder, object, name);
  CheckLimit(folder, "numbers in '" + std::string(name) + "'", found.size(), count);
  std::vector<std::int64_t> numbers;
  for (const Json& one : found)
  {
    // As a number of another kind it would be cut off, or wrap around.
    const auto number = one.is_number() ? ToInteger(one.get<double>(), least, most) : std::nullopt;
    if (!number)
    {
      Refuse(folder,
        "its '" + std::string(name) + "' has " + (one.is_number() ? one.dump() : one.type_name()) +
          ", which is not an integer from " + std::to_string(least) + " to " +
          std::to_string(most) + ".");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<double> ZarrJson::ToNumbers(const nlohmann::json& value)
{
  const Json all = value.is_array() ? value : Json::array({ value });
  const auto isNumber = [](const Json& one) { return one.is_number(); };
  return all.size() <= FileLimits::Axes && std::all_of(all.begin(), all.end(), isNumber)
    ? all.get<std::vector<double>>()
    : std::vector<double>();
}

} // namespace vol
