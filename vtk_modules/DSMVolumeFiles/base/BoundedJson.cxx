// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/BoundedJson.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <utility>
#include <vector>

namespace vol
{

namespace
{

using Json = nlohmann::json;

/// Makes values of what the parser finds, with bounds on what they take: copying and destroying them recurs once for
/// each level.
class Builder final : public nlohmann::json_sax<Json>
{
public:
  explicit Builder(const char* skipped)
    : Skipped(skipped)
  {
  }

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
    this->SkipsNext = this->SkippedLevels == 0 && this->Open.size() == 1 && name == this->Skipped;
    this->Key = std::move(name);
    return true;
  }

  bool parse_error(std::size_t place, const std::string&, const Json::exception&) override
  {
    // The parser's message repeats the text, which may be long or not UTF-8.
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
  std::string Skipped;
  std::string Key;
  bool SkipsNext = false;
  std::size_t SkippedLevels = 0;
  std::size_t Values = 0;
};

} // namespace

nlohmann::json ParseJson(const std::string& text, const char* skipped)
{
  Builder builder(skipped);
  Json::sax_parse(text, &builder);
  return std::move(builder.Root);
}

} // namespace vol
