// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfOrigins_h
#define vol_HdfOrigins_h

#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vol
{

/// A dataset, which may be behind external links: a linked file that is a pipe or a device is not opened. Not open
/// where it cannot be opened. Under GetHdfLock.
HdfHandle OpenHdfDataset(hid_t group, const std::string& name);
/// Likewise, an object of any kind, such as a group behind an external link.
HdfHandle OpenHdfObject(hid_t group, const std::string& name);

/// Other files that an HDF5 file's datasets take values from: targets of external links, files of external
/// storage, and sources of virtual datasets. The files that the sources refer to are not examined.
class HdfOrigins
{
public:
  /// Adds the files of a dataset that was opened by `file`, which is at `path`. Returns whether there are any, or
  /// the dataset takes its values from other datasets. Throws dsm::Error, which names what is missing: the library
  /// would give fill values. Under GetHdfLock.
  bool Add(const std::string& path, hid_t file, hid_t dataset);

  std::vector<std::string> GetPaths() const;
  /// Returns `own`, combined with the stamps of the source files if there are any.
  std::uint64_t GetStamp(std::uint64_t own) const;
  /// Throws dsm::Error when one was written to since it was added. Any thread.
  void CheckUnchanged() const;
  bool AreUnchanged() const;

private:
  void Keep(const std::string& path);
  /// One that was written to; empty: none was.
  std::string FindChanged() const;
  void AddSources(const std::string& path, hid_t properties);

  std::map<std::string, std::uint64_t> Stamps; ///< by path
};

} // namespace vol

#endif
