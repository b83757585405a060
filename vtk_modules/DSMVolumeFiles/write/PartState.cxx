// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/PartState.h"

#include "DSMVolumeFiles/base/BoundedJson.h"
#include "DSMVolumeFiles/base/DurableFile.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/write/PartFiles.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <iterator>
#include <utility>

namespace vol
{

namespace
{

using Json = nlohmann::json;

/// JSON has UTF-8 only, but names of files and arrays may be any bytes. Distinct names stay distinct.
std::string Escape(const std::string& name)
{
  constexpr const char* digits = "0123456789ABCDEF";
  std::string text;
  for (const char character : name)
  {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte >= 0x7f || byte == '%')
    {
      text += { '%', digits[byte >> 4], digits[byte & 15] };
    }
    else
    {
      text += character;
    }
  }
  return text;
}

Json Describe(const BrickFileLayout& layout)
{
  const auto list = [](const auto& numbers)
  { return Json(std::vector<double>(std::begin(numbers), std::end(numbers))); };
  const auto index = [](const bricks::Index3& numbers) {
    return Json{ numbers.x, numbers.y, numbers.z };
  };
  Json text{ { "origin", list(layout.Geometry.Origin) },
    { "spacing", list(layout.Geometry.Spacing) }, { "direction", list(layout.Geometry.Direction) },
    { "first", index(layout.Geometry.First) }, { "points", index(layout.Geometry.Points) },
    { "edge", layout.BrickEdge }, { "compression", static_cast<int>(layout.Pressed) } };
  for (const FileArray& array : layout.Arrays)
  {
    text["arrays"].push_back({ Escape(array.Name), static_cast<int>(array.Type), array.Components,
      array.OnCells, index(array.Grid.Samples), index(array.Grid.ChunkSamples),
      layout.HasHalo(static_cast<std::size_t>(&array - layout.Arrays.data())) });
  }
  return text;
}

/// The state's chunk counts, which are numbers from 0 on; nothing where they are not, or the file is not whole.
std::optional<std::vector<std::int64_t>> GetChunks(const Json& state)
{
  if (!state.is_object() || state.value("whole", Json()) != true)
  {
    return std::nullopt;
  }
  const Json list = state.value("chunks", Json());
  if (!list.is_array())
  {
    return std::nullopt;
  }
  std::vector<std::int64_t> chunks;
  for (const Json& count : list)
  {
    if (!count.is_number_integer() || count.get<std::int64_t>() < 0)
    {
      return std::nullopt;
    }
    chunks.push_back(count.get<std::int64_t>());
  }
  return chunks;
}

} // namespace

PartState::PartState(
  std::string path, const BrickFileLayout& layout, const std::string& source, bool isResumable)
  : Path(std::move(path))
  , IsResumable(isResumable)
  , Description{ { "source", Escape(source) }, { "layout", Describe(layout) } }
{
  for (const FileArray& array : layout.Arrays)
  {
    this->MostChunks.push_back(array.Grid.GetCount());
  }
}

Json PartState::Read() const
{
  try
  {
    Json state = ParseJson(ReadWhole(PartFiles::GetState(this->Path), FileLimits::JsonBytes));
    return state.is_object() ? state : Json();
  }
  catch (const std::exception&)
  {
    return {};
  }
}

std::optional<std::vector<std::int64_t>> PartState::Load() const
{
  const Json state = this->Read();
  std::optional<std::vector<std::int64_t>> chunks = GetChunks(state);
  const std::vector<std::int64_t>& most = this->MostChunks;
  if (!chunks || state.value("of", Json()) != this->Description || chunks->size() != most.size() ||
    !std::equal(chunks->begin(), chunks->end(), most.begin(), std::less_equal<>()))
  {
    return std::nullopt;
  }
  return chunks;
}

void PartState::CheckNothingIsLost() const
{
  const Json state = this->Read();
  const auto chunks = GetChunks(state);
  const bool hasChunks =
    chunks && std::any_of(chunks->begin(), chunks->end(), [](auto count) { return count > 0; });
  if (hasChunks && state.value("resumable", Json(true)) != false)
  {
    const std::string part = PartFiles::GetPart(this->Path);
    throw FileError(part,
      "belongs to an interrupted conversion, which can be resumed. Run dsm_convert again to finish "
      "it, delete '" +
        part + "' and '" + PartFiles::GetState(this->Path) + "', or choose another name.");
  }
}

void PartState::Save(bool isWhole, const std::vector<std::int64_t>& chunks) const
{
  const Json state{ { "whole", isWhole }, { "resumable", this->IsResumable },
    { "of", this->Description }, { "chunks", chunks } };
  const std::string text = state.dump(1) + "\n";
  const std::string path = PartFiles::GetState(this->Path);
  DurableFile::Write(path + ".new", text.data(), text.size());
  DurableFile::Rename(path + ".new", path);
}

} // namespace vol
