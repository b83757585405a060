// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrStore_h
#define vol_ZarrStore_h

#include "DSMBricks/base/ByteHash.h"
#include "DSMVolumeFiles/base/ByteSource.h"
#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// Where a Zarr volume is: a folder, a ZIP archive, or an address. Its keys are named by whole paths,
/// "/" between folders. All functions throw dsm::Error, which names the path, where it is not known what is there. Any
/// thread.
class ZarrStore
{
public:
  /// `path`: a folder, a ZIP archive of one, or an address (IsUrl). `options`: GoesOn counts until EndOpening.
  static std::shared_ptr<ZarrStore> Make(const std::string& path, const OpenOptions& options);

  ZarrStore() = default;
  virtual ~ZarrStore() = default;
  ZarrStore(const ZarrStore&) = delete;
  ZarrStore& operator=(const ZarrStore&) = delete;

  virtual void EndOpening() {}

  /// Returns the text of a folder's file of metadata, such as ".zattrs"; nothing where there is none.
  virtual std::optional<std::string> ReadMetadata(
    const std::string& folder, const std::string& name) const = 0;
  /// Returns whether a folder has an array or a group.
  virtual bool HasMetadata(const std::string& folder) const = 0;
  /// Adds stamps of an array's own metadata.
  virtual void AddStamps(const std::string& folder, bricks::ByteHash& hash) const = 0;
  /// Throws dsm::Error when a folder that was there has no array or group any more.
  virtual void CheckThere(const std::string& folder) const = 0;

  /// Returns whether it is known which arrays and groups there are.
  virtual bool KnowsFolders() const { return true; }
  /// Returns the names of the arrays and groups in a folder; ascending. Throws where it is not known.
  virtual std::vector<std::string> FindFolders(const std::string& folder) const = 0;
  /// Returns whether there may be a folder: false where it is known that there is none.
  virtual bool MayHaveFolder(const std::string& path) const = 0;
  /// Returns whether the chunks of an array of version 2 that does not declare it are in folders of folders, as old
  /// stores have them.
  virtual bool LooksNested(const std::string& folder, std::size_t axes) const = 0;
  /// Returns whether folders can be listed, so that a look at one tells which keys are missing.
  virtual bool CanList() const = 0;

  /// How a key will be read.
  struct Manner
  {
    enum class Kind
    {
      Whole,     ///< all of it, at most Bytes
      FromFirst, ///< in parts; the first Bytes first
      FromLast   ///< in parts; the last Bytes first
    };
    Kind How = Kind::Whole;
    std::uint64_t Bytes = 0;
  };
  /// Returns the key at a path; null where there is none. Where it is not on a disk, bytes that are wanted whole, or
  /// first, are fetched by this.
  virtual std::shared_ptr<const StampedSource> Open(
    const std::string& path, const Manner& manner) const = 0;
};

/// Returns whether a folder of the file system has an array or a group. Does not throw.
bool MayBeZarr(const std::string& path);

} // namespace vol

#endif
