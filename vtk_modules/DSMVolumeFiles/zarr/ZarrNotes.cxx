// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrNotes.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/zarr/ZarrJson.h"
#include "DSMVolumeFiles/zarr/ZarrVector.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>

namespace vol
{

AxisNotes NameZarrAxes(const std::string& folder, const ZarrMetadata& data)
{
  AxisNotes notes;
  const std::size_t count = data.Shape.size();
  const bool areNamed = data.Axes.is_array() && data.Axes.size() == count;
  for (std::size_t axis = 0; axis < count; ++axis)
  {
    AxisNote note;
    note.Name = areNamed && data.Axes[axis].is_string() ? data.Axes[axis].get<std::string>() : "";
    CheckLimit(folder, "bytes of an axis's name", note.Name.size(), FileLimits::NameBytes);
    notes.push_back(std::move(note));
  }
  return notes;
}

AxisNotes ReadZarrNotes(
  const ZarrStore& store, const std::string& folder, const ZarrMetadata& data, const ZarrAxes& axes)
{
  AxisNotes notes = NameZarrAxes(folder, data);
  const std::size_t count = data.Shape.size();
  const auto first = static_cast<std::size_t>(axes.Leading);
  TakeVoxelSize([&](const char* name)
    { return ZarrJson::ToNumbers(ZarrJson::Find(data.Attributes, name)); },
    notes, { first, first + 1, first + 2 });
  const std::string beside = std::filesystem::path(folder).parent_path().string();
  for (std::size_t axis = 0; axis < count; ++axis)
  {
    AxisNote& note = notes[axis];
    if (IsPlainName(note.Name) && store.MayHaveFolder(beside + "/" + note.Name))
    {
      const std::string coordinates = beside + "/" + note.Name;
      auto numbers =
        ReadZarrVector(store, coordinates, static_cast<std::uint64_t>(data.Shape[axis]));
      if (numbers.size() == static_cast<std::size_t>(data.Shape[axis]))
      {
        note.Coordinates = std::move(numbers);
        const nlohmann::json attributes = ReadZarrAttributes(store, coordinates);
        note.Unit = ZarrJson::GetText(coordinates, attributes, "units");
        TakeUpDown(ZarrJson::GetText(coordinates, attributes, "positive"), note);
      }
    }
  }
  return notes;
}

void WarnOfZarrPlaces(const ZarrStore& store, const std::string& folder, const ZarrMetadata& data,
  std::vector<std::string>& warnings)
{
  const std::string beside = std::filesystem::path(folder).parent_path().string();
  const auto getText = [&](const char* name)
  {
    const nlohmann::json& found = ZarrJson::Find(data.Attributes, name);
    const std::string text = found.is_string() ? found.get<std::string>() : std::string();
    return text.size() > FileLimits::NameBytes ? std::string() : text;
  };
  const auto countAxes = [&](const std::string& name) -> std::size_t
  {
    try
    {
      const auto other = ReadZarrMetadata(store, beside + "/" + name);
      return other ? other->Shape.size() : 0;
    }
    catch (const dsm::Error&)
    {
      return 0; // nor can it place anything
    }
  };
  WarnOfOtherPlaces(getText, countAxes, warnings);
}

} // namespace vol
