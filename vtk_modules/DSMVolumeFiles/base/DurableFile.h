// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_DurableFile_h
#define vol_DurableFile_h

#include <cstddef>
#include <string>

namespace vol
{

/// Writes entire files, to the disk. Refuses pipes, devices and folders, and never waits for one.
namespace DurableFile
{

/// Creates or overwrites a file, and waits until it is on the disk. Throws dsm::Error, which names file and cause; the
/// file may be incomplete then.
void Write(const std::string& path, const void* bytes, std::size_t count);

/// Does the same for a new file, whose name is `beginning` and a random number, so that no other process or thread has
/// it. Returns the name. Throws dsm::Error, and leaves no file then.
std::string WriteBeside(const std::string& beginning, const void* bytes, std::size_t count);

/// Waits until a file's content is on the disk. Throws dsm::Error.
void Synchronize(const std::string& path);

/// Renames a file that is on the disk, replaces a file of the new name, and waits until the folder is on the disk.
/// After a power failure there is either the old file or the new one. Throws dsm::Error.
void Rename(const std::string& from, const std::string& to);

} // namespace DurableFile

} // namespace vol

#endif
