// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrListing_h
#define vol_ZarrListing_h

#include "DSMVolumeFiles/zarr/ZarrMetadata.h"

#include <array>
#include <cstdint>
#include <optional>
#include <shared_mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace vol
{

/// Which files of chunks, or of shards, an array's folders have: each folder is listed once, when a file is found
/// to be missing there. So most of an array of millions of chunks may be nowhere, and none of these is looked for.
/// Any thread.
class ZarrListing
{
public:
  /// Place of a file along the array's axes, the slowest first; as many count as the array has axes.
  using Index = std::array<std::int64_t, 5>;

  /// `canList`: else the files that were found to be missing are noted one by one, and stay so.
  ZarrListing(const std::string& folder, const ZarrMetadata& data, bool canList);

  /// Returns whether there was no such file when its folder was listed. False where it was not.
  bool IsMissing(const Index& index) const;
  /// The same, if the folder is unchanged since, or cannot be listed.
  bool IsStillMissing(const Index& index);
  /// Lists the folder of a missing file, unless it was written to just now. To be called when there is no such
  /// file.
  void NoteMissing(const Index& index);

  /// Returns the bytes in memory.
  std::uint64_t GetBytes() const;

private:
  struct Folder
  {
    std::uint64_t Stamp = 0;          ///< 0: there is no such folder
    std::vector<std::uint64_t> Files; ///< numbers, ascending
  };
  /// Where a look for a file ends: at the first folder that lacks it, or was not listed.
  struct End
  {
    std::size_t Depth;
    std::uint64_t Number; ///< of the folder at this depth
    bool IsMissing;
  };
  End Find(const Index& index) const;
  /// Returns a file's number among all of the array.
  std::uint64_t GetNumber(const Index& index) const;

  std::string GetPath(const Index& index, std::size_t depth) const;
  /// Returns a file's number in a folder by its name; nothing for other names.
  std::optional<std::uint64_t> Parse(const std::string& name) const;
  /// Returns nothing where the folder cannot be listed, or changes.
  std::optional<Folder> List(const std::string& path) const;

  std::string Root;
  std::string Prefix; ///< of names
  bool CanList;
  bool IsNested;                     ///< a folder for each index; else names have all
  std::vector<std::uint64_t> Counts; ///< of files along each axis; empty: too many to be numbered

  mutable std::shared_mutex Guard;
  std::vector<std::unordered_map<std::uint64_t, Folder>> Folders; ///< by depth and number
  std::uint64_t Listed = 0;                                       ///< files in them
  std::unordered_set<std::uint64_t> Absent;                       ///< numbers, without listing
};

} // namespace vol

#endif
