// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrGroup.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/format/VolumeShape.h"
#include "DSMVolumeFiles/zarr/ZarrAxes.h"
#include "DSMVolumeFiles/zarr/ZarrJson.h"
#include "DSMVolumeFiles/zarr/ZarrMetadata.h"
#include "DSMVolumeFiles/zarr/ZarrNotes.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

namespace vol
{

namespace
{

/// Looks through groups in one another.
class Search
{
public:
  Search(const ZarrStore& store, std::string folder)
    : Store(store)
    , Root(std::move(folder))
  {
  }

  /// `inner`: a path in the folder; empty: the folder itself, which is not one of the found.
  void LookAt(const std::string& inner, int depth)
  {
    constexpr int mostDepth = 8;
    const std::string folder = inner.empty() ? this->Root : this->Root + "/" + inner;
    if (!inner.empty() && IsImage(folder))
    {
      this->Found.push_back(inner);
      return;
    }
    bool hasVolumes = false;
    for (const std::string& name : this->Store.FindFolders(folder))
    {
      CheckLimit(this->Root, "groups", ++this->Looked, FileLimits::Objects);
      const std::string path = inner.empty() ? name : inner + "/" + name;
      const std::optional<bool> isVolume = IsVolume(folder + "/" + name);
      hasVolumes = hasVolumes || isVolume.value_or(false);
      if (!isVolume && depth < mostDepth)
      {
        this->LookAt(path, depth + 1);
      }
    }
    if (hasVolumes && !inner.empty())
    {
      this->Found.push_back(inner);
    }
  }

  std::vector<std::string> Found;

private:
  /// Returns nothing for a group.
  std::optional<bool> IsVolume(const std::string& folder) const
  {
    try
    {
      const auto data = ReadZarrMetadata(this->Store, folder);
      return data ? std::optional<bool>(data->IsVolume()) : std::nullopt;
    }
    catch (const dsm::Error&)
    {
      return false;
    }
  }

  bool IsImage(const std::string& folder) const
  {
    try
    {
      const nlohmann::json attributes = ReadZarrAttributes(this->Store, folder);
      return ZarrJson::Find(ZarrGroup::FindOme(attributes), "multiscales").size() > 0;
    }
    catch (const dsm::Error&)
    {
      return false;
    }
  }

  const ZarrStore& Store;
  std::string Root;
  std::uint64_t Looked = 0;
};

} // namespace

std::string ZarrGroup::JoinInside(const std::string& folder, const std::string& name)
{
  const std::filesystem::path path(name);
  const bool leadsUp = std::find(path.begin(), path.end(), "..") != path.end();
  if (name.empty() || path.is_absolute() || leadsUp || name.find('\0') != std::string::npos)
  {
    throw FileError(folder,
      "has invalid metadata: the path " + Quote(name) +
        " of a dataset is empty or leads outside the folder.");
  }
  return folder + "/" + name;
}

std::vector<std::string> ZarrGroup::FindArrays(
  const ZarrStore& store, const std::string& folder, std::string& refused)
{
  std::map<std::string, VolumeShape> found;
  VolumeShape largest;
  for (const std::string& name : store.FindFolders(folder))
  {
    const std::string inner = folder + "/" + name;
    try
    {
      const std::optional<ZarrMetadata> data = ReadZarrMetadata(store, inner);
      if (data && data->IsVolume())
      {
        const ZarrAxes axes = ZarrAxes::Find(inner, NameZarrAxes(inner, *data), data->Shape.size());
        const VolumeShape shape{ axes.GetSpace(data->Shape),
          axes.Time < 0 ? 0 : data->Shape[static_cast<std::size_t>(axes.Time)] };
        found[name] = shape;
        largest = shape.IsLargerThan(largest) ? shape : largest;
      }
    }
    catch (const dsm::Error& error) // beside a volume there may be others, such as texts
    {
      refused = error.what();
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, shape] : found)
  {
    if (shape.BelongsTo(largest))
    {
      names.push_back(name);
    }
  }
  return names;
}

std::vector<std::string> ZarrGroup::FindInner(const ZarrStore& store, const std::string& folder)
{
  Search search(store, folder);
  search.LookAt({}, 0);
  std::sort(search.Found.begin(), search.Found.end());
  return std::move(search.Found);
}

const nlohmann::json& ZarrGroup::FindOme(const nlohmann::json& attributes)
{
  const nlohmann::json& named = ZarrJson::Find(attributes, "ome");
  return named.is_null() ? attributes : named;
}

std::vector<std::string> ZarrGroup::NameScales(
  const std::string& folder, const nlohmann::json& scales)
{
  CheckLimit(folder, "images", scales.size(), FileLimits::Arrays);
  std::vector<std::string> names;
  for (const nlohmann::json& scale : scales)
  {
    const std::string name = ZarrJson::GetText(folder, scale, "name");
    const bool isNew = !name.empty() && std::count(names.begin(), names.end(), name) == 0;
    names.push_back(isNew ? name : "multiscales/" + std::to_string(names.size()));
  }
  return names;
}

} // namespace vol
