// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_KeptFile_h
#define vol_KeptFile_h

#include "DSMVolumeFiles/format/ArrayStep.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// Results of a pass over a part of an array, kept in the user's cache directory ($XDG_CACHE_HOME or ~/.cache).
/// They are valid as long as the file is unchanged. Any thread.
class KeptFile
{
public:
  /// `kind` says what is kept, and in which layout: it names no other.
  KeptFile(const ArrayStep& of, const bricks::Box& box, const std::string& kind);

  /// The boxes within the array for which something of this kind is kept, in no order. Throws std::bad_alloc.
  static std::vector<bricks::Box> FindBoxes(const ArrayStep& of, const std::string& kind);

  /// Returns the `count` bytes that Keep stored, or nothing where there is no such file or its checksum differs. Throws
  /// std::bad_alloc.
  std::vector<std::byte> Load(std::size_t count) const;
  /// Stores bytes if possible. Several processes may store the same file at the same time: the last one wins. Throws
  /// nothing.
  void Keep(const std::byte* bytes, std::size_t count) const;

private:
  /// Precedes the kept bytes.
  struct Header
  {
    std::uint64_t Magic;
    std::uint64_t Bytes;
    std::uint64_t Checksum; ///< checksum of the kept bytes and the file's own name
  };
  Header MakeHeader(const std::byte* bytes, std::size_t count) const;

  std::string Path; ///< empty: there is no such directory
};

} // namespace vol

#endif
