// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/PathClaim.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/write/PartFiles.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace vol
{

namespace
{

void CheckReplaceable(const std::string& path)
{
  if (path.empty())
  {
    throw dsm::Error("The name of the file to write is empty.");
  }
  std::error_code failure;
  const std::filesystem::file_status there = std::filesystem::status(path, failure);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
  {
    throw FileError(path, "cannot be replaced because it is a folder or a device.");
  }
}

/// Locks are empty files.
bool IsLock(int file)
{
  struct stat opened = {};
  return file >= 0 && fstat(file, &opened) == 0 && S_ISREG(opened.st_mode) && opened.st_size == 0;
}

/// Returns whether the open file is still the one at the path: its owner may have removed it
/// meanwhile.
bool IsAt(int file, const std::string& path)
{
  struct stat opened = {};
  struct stat there = {};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &there) == 0 &&
    opened.st_ino == there.st_ino && opened.st_dev == there.st_dev;
}

} // namespace

PathClaim::PathClaim(const std::string& path)
  : LockPath(PartFiles::GetLock(path))
{
  CheckReplaceable(path);
  do
  {
    this->Lock = Descriptor(
      open(this->LockPath.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW, 0666));
    if (!this->Lock.IsOpen() && errno != EISDIR && errno != ELOOP && errno != ENXIO)
    {
      return; // the writer reports a folder that is not writable
    }
    if (!IsLock(this->Lock.Get()))
    {
      throw FileError(this->LockPath,
        "is required as a lock file to write '" + path +
          "', but this program did not create it. Rename or delete it.");
    }
    if (flock(this->Lock.Get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
      throw FileError(
        path, "is being written by another process. Wait for that process, or end it.");
    }
  } while (!IsAt(this->Lock.Get(), this->LockPath));
}

PathClaim::~PathClaim()
{
  if (this->Lock.IsOpen())
  {
    unlink(this->LockPath.c_str());
  }
}

} // namespace vol
