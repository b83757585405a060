// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/base/Url.h"
#include "DSMVolumeFiles/zarr/ZarrRemote.h"
#include "DSMVolumeFiles/zarr/ZarrZip.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <system_error>

namespace vol
{

namespace
{

/// Folders of the file system.
class ZarrFolders final : public ZarrStore
{
public:
  std::optional<std::string> ReadMetadata(
    const std::string& folder, const std::string& name) const override
  {
    const std::string path = folder + "/" + name;
    return FindPathKind(path) == PathKind::Nothing
      ? std::nullopt
      : std::optional<std::string>(ReadWhole(path, FileLimits::JsonBytes));
  }

  bool HasMetadata(const std::string& folder) const override { return MayBeZarr(folder); }

  void AddStamps(const std::string& folder, bricks::ByteHash& hash) const override
  {
    for (const char* metadata : { "/.zarray", "/zarr.json" })
    {
      if (FindPathKind(folder + metadata) != PathKind::Nothing)
      {
        // The folder's, too: most programs replace chunks by others of the same name.
        const std::uint64_t stamps[] = { PositionedFile(folder + metadata).GetStamp(),
          PositionedFile(folder).GetStamp() };
        hash.Add(stamps, sizeof(stamps));
      }
    }
  }

  void CheckThere(const std::string& folder) const override
  {
    if (!MayBeZarr(folder))
    {
      throw FileError(folder, "was deleted after it was opened.");
    }
  }

  std::vector<std::string> FindFolders(const std::string& path) const override
  {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path))
    {
      const std::string folder = entry.path().string();
      if (FindPathKind(folder) == PathKind::Directory && MayBeZarr(folder))
      {
        found.push_back(entry.path().filename().string());
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  bool MayHaveFolder(const std::string& path) const override
  {
    return FindPathKind(path) == PathKind::Directory;
  }

  bool LooksNested(const std::string& folder, std::size_t) const override
  {
    return FindPathKind(folder + "/0") == PathKind::Directory;
  }

  bool CanList() const override { return true; }

  std::shared_ptr<const StampedSource> Open(const std::string& path, const Manner&) const override
  {
    return FindPathKind(path) == PathKind::Nothing ? nullptr
                                                   : std::make_shared<const PositionedFile>(path);
  }
};

} // namespace

std::shared_ptr<ZarrStore> ZarrStore::Make(const std::string& path, const OpenOptions& options)
{
  if (IsUrl(path))
  {
    return MakeZarrRemote(path, options);
  }
  return FindPathKind(path) == PathKind::File ? MakeZarrZip(path) : std::make_shared<ZarrFolders>();
}

bool MayBeZarr(const std::string& path)
{
  const auto names = { "/.zarray", "/.zgroup", "/zarr.json" };
  return std::any_of(names.begin(), names.end(),
    [&](const char* name)
    {
      std::error_code failure;
      return std::filesystem::exists(path + name, failure);
    });
}

} // namespace vol
