// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_SmallFile_h
#define vol_SmallFile_h

#include <cstddef>
#include <string>
#include <vector>

namespace vol
{

/// Kind of file at a path. Links are followed.
enum class PathKind
{
  Nothing,
  File,
  Directory,
  Other ///< a pipe, a socket or a device, which a reader may wait for without end
};

/// Opens nothing. Throws dsm::Error, which names the path, when the system cannot tell, as for a symbolic link that
/// leads to itself.
PathKind FindPathKind(const std::string& path);

/// Returns the first bytes of a file, at most `most`. Throws dsm::Error, which names the file, when it cannot be
/// opened or is not a file: this never waits for a pipe. WouldWait (WithoutWaiting).
std::string ReadBeginning(const std::string& path, std::size_t most);

/// Returns all of a file. Throws likewise, also when it has more than `most` bytes.
std::string ReadWhole(const std::string& path, std::size_t most);

/// Returns whether a name from a file leads nowhere else when it is put behind a folder.
bool IsPlainName(const std::string& name);

/// Returns the first of some names in quotation marks, as the end of a sentence. `notes`: one for each name, in
/// parentheses behind it; or none.
std::string ListNames(
  const std::vector<std::string>& names, const std::vector<std::string>& notes = {});

/// Returns a file's name without its folder and extension.
std::string GetStem(const std::string& path);

/// Lower-case text. As in the "C" locale: what a program sets for its own texts does not change what a file says.
std::string ToLower(std::string text);

/// Text of a file in quotation marks, for messages: shortened, and without control characters.
std::string Quote(const std::string& text);

} // namespace vol

#endif
