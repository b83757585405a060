// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ValueCopy_h
#define vol_ValueCopy_h

#include "DSMVolumeFiles/base/Descriptor.h"
#include "DSMVolumeFiles/plain/ValueBytes.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace vol
{

/// A copy of values in the cache folder, while it is written: beside its place, locked, and removed unless it is
/// finished. Only the user may read it.
class ValueCopy
{
public:
  /// Returns the path of the copy of what a hash stands for.
  static std::filesystem::path GetPath(const std::filesystem::path& folder, std::uint64_t hash);
  /// Returns the copy with so many bytes if it is complete, and notes that it was used.
  static std::optional<ValuePart> Find(const std::filesystem::path& copy, std::uint64_t bytes);
  /// Removes copies, in the order of their last use, until one of so many bytes takes at most half of the free
  /// room. Throws dsm::Error, which names the file `path`, and removes none if that is not enough.
  static void MakeRoom(
    const std::string& path, const std::filesystem::path& folder, std::uint64_t bytes);

  /// Returns nothing while another process, or thread, writes it. Throws dsm::Error.
  static std::unique_ptr<ValueCopy> TryBegin(const std::filesystem::path& copy);
  ~ValueCopy();
  ValueCopy(const ValueCopy&) = delete;
  ValueCopy& operator=(const ValueCopy&) = delete;

  /// Throws dsm::Error.
  void Add(const void* bytes, std::size_t count);
  /// Puts the copy in its place, after so many bytes were added. Throws dsm::Error.
  void Finish(std::uint64_t bytes);

private:
  explicit ValueCopy(std::filesystem::path copy);

  [[noreturn]] void Refuse() const; ///< errno says why

  std::filesystem::path Copy;
  std::string Path;
  Descriptor File;
  bool IsLocked = false;
};

} // namespace vol

#endif
