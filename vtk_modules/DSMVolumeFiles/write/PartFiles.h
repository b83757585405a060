// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_PartFiles_h
#define vol_PartFiles_h

#include <string>

namespace vol
{

/// The files that a brick file consists of until it is whole: PATH.part has its values, PATH.part.json the state of
/// the work, and PATH.part.level1 and so on the coarser levels, each of which has such files of its own. The state
/// is written first and removed last, so files without one belong to another program.
namespace PartFiles
{

/// PATH.part. A name that would become too long for the file system is shortened, and a checksum of all of it added.
std::string GetPart(const std::string& path);
/// PATH.part.json.
std::string GetState(const std::string& path);
/// PATH.part.lock.
std::string GetLock(const std::string& path);
/// The file of a coarser level, from 1 on.
std::string GetLevel(const std::string& path, int level);

/// Throws dsm::Error, which names the file, where another program's file, a folder or a device has one of these names.
/// Called by the process that holds the path's PathClaim.
void CheckOwn(const std::string& path);
/// Removes all of these files except the path's own lock. Called by the process that holds the path's PathClaim,
/// after CheckOwn. Throws nothing.
void Remove(const std::string& path);
/// Does the same, but keeps the state. Throws nothing.
void RemoveValues(const std::string& path);

} // namespace PartFiles

} // namespace vol

#endif
