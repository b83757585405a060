// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/ZarrJson.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <cstring>
#include <optional>
#include <utility>

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

/// Makes values of what the parser finds, with bounds on what they take: copying and destroying them recurs once for
/// each level.
class Builder final : public nlohmann::json_sax<Json>
{
public:
  Json Root;

  bool null() override { return this->Add(Json()); }
  bool boolean(bool value) override { return this->Add(Json(value)); }
  bool number_integer(std::int64_t value) override { return this->Add(Json(value)); }
  bool number_unsigned(std::uint64_t value) override { return this->Add(Json(value)); }
  bool number_float(double value, const std::string&) override { return this->Add(Json(value)); }
  bool string(std::string& value) override { return this->Add(Json(std::move(value))); }
  bool binary(Json::binary_t&) override { return false; }

  bool start_object(std::size_t) override { return this->Begin(Json::object()); }
  bool start_array(std::size_t) override { return this->Begin(Json::array()); }
  bool end_object() override { return this->End(); }
  bool end_array() override { return this->End(); }
  bool key(std::string& name) override
  {
    this->SkipsNext =
      this->SkippedLevels == 0 && this->Open.size() == 1 && name == "consolidated_metadata";
    this->Key = std::move(name);
    return true;
  }

  bool parse_error(std::size_t place, const std::string&, const Json::exception&) override
  {
    // What the parser says repeats the text, which may be long or not UTF-8.
    throw dsm::Error("it is not valid JSON at byte " + std::to_string(place));
  }

private:
  bool Begin(Json value)
  {
    if (this->Open.size() + this->SkippedLevels >= FileLimits::JsonDepth)
    {
      throw dsm::Error("it is nested more than " + std::to_string(FileLimits::JsonDepth) +
        " levels deep, which is not supported");
    }
    if (this->SkippedLevels > 0 || this->SkipsNext)
    {
      this->SkipsNext = false;
      ++this->SkippedLevels;
      return true;
    }
    this->Open.push_back(this->Put(std::move(value)));
    return true;
  }

  bool End()
  {
    if (this->SkippedLevels > 0)
    {
      --this->SkippedLevels;
    }
    else
    {
      this->Open.pop_back();
    }
    return true;
  }

  bool Add(Json value)
  {
    if (this->SkippedLevels == 0 && !std::exchange(this->SkipsNext, false))
    {
      this->Put(std::move(value));
    }
    return true;
  }

  Json* Put(Json value)
  {
    if (++this->Values > FileLimits::JsonValues)
    {
      throw dsm::Error("it has more than " + std::to_string(FileLimits::JsonValues) +
        " values, which is not supported");
    }
    if (this->Open.empty())
    {
      this->Root = std::move(value);
      return &this->Root;
    }
    Json& parent = *this->Open.back();
    if (parent.is_array())
    {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[this->Key] = std::move(value));
  }

  std::vector<Json*> Open; ///< arrays and objects, each the last one in the one before
  std::string Key;
  bool SkipsNext = false;
  std::size_t SkippedLevels = 0;
  std::size_t Values = 0;
};

} // namespace

void ZarrJson::Refuse(const std::string& folder, const std::string& why)
{
  throw dsm::Error("Cannot read the Zarr array '" + folder + "': " + why);
}

nlohmann::json ZarrJson::Read(const std::string& folder, const std::string& name)
{
  const std::string path = folder + "/" + name;
  if (FindPathKind(path) == PathKind::Nothing)
  {
    return {};
  }
  const std::string text = WithQuotedWords(ReadWhole(path, FileLimits::JsonBytes));
  try
  {
    Builder builder;
    Json::sax_parse(text, &builder);
    return std::move(builder.Root);
  }
  catch (const dsm::Error& error)
  {
    Refuse(folder, "its file " + name + " is damaged: " + error.what() + ".");
  }
}

const nlohmann::json& ZarrJson::Find(const nlohmann::json& object, const char* name)
{
  static const Json none;
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found == object.end() ? none : *found;
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

std::vector<std::int64_t> ZarrJson::GetIntegers(const std::string& folder,
  const nlohmann::json& object, const char* name, std::uint64_t count, std::int64_t least,
  std::int64_t most)
{
  const Json& found = Find(object, name);
  if (!found.is_array())
  {
    Refuse(folder, "its '" + std::string(name) + "' is missing, or not an array.");
  }
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

} // namespace vol
