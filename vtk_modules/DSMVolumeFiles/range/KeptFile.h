// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_KeptFile_h
#define vol_KeptFile_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vol
{

/// What was found out about a part of an array by reading all of it, in the user's cache directory
/// ($XDG_CACHE_HOME or ~/.cache): known as long as the file is what it was. Any thread.
class KeptFile
{
public:
  /// `kind` says what is kept, and in which layout: it names no other.
  KeptFile(const VolumeFile& file, std::size_t array, int step, const rt::Box& box,
    const std::string& kind);

  /// The boxes of which something of this kind is kept, in no order. Throws std::bad_alloc.
  static std::vector<rt::Box> FindBoxes(
    const VolumeFile& file, std::size_t array, int step, const std::string& kind);

  /// Empty where nothing is kept. Whether it is whole is for the caller to tell. Throws std::bad_alloc.
  std::vector<std::byte> Load() const;
  /// What cannot be kept is found again the next time.
  void Keep(const std::byte* bytes, std::size_t count) const;

private:
  std::string Path; ///< empty: there is no such directory
};

} // namespace vol

#endif
