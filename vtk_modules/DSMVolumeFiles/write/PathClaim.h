// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_PathClaim_h
#define vol_PathClaim_h

#include "DSMVolumeFiles/base/Descriptor.h"

#include <string>

namespace vol
{

/// Claims a path, so that this process, and no other one, writes a file that will be there: by a lock beside it
/// (PartFiles::GetLock), which ends with the process. If the file system has no locks, nothing is claimed.
class PathClaim
{
public:
  /// Throws dsm::Error when another process has it, what is there cannot be replaced by a file, or something
  /// else than a lock has the lock's name.
  explicit PathClaim(const std::string& path);
  ~PathClaim();
  PathClaim(const PathClaim&) = delete;
  PathClaim& operator=(const PathClaim&) = delete;

private:
  std::string LockPath;
  Descriptor Lock;
};

} // namespace vol

#endif
