// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZipDirectory_h
#define vol_ZipDirectory_h

#include "DSMVolumeFiles/base/ByteSource.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// The members of a ZIP archive, also of a large one (ZIP64). After opening, any thread.
class ZipDirectory
{
public:
  struct Member
  {
    std::string Name;     ///< "/" between folders; those that are folders themselves are left out
    std::uint64_t Header; ///< place of its header in the archive
    std::uint64_t StoredBytes; ///< in the archive
    std::uint64_t Bytes;
    std::uint32_t Checksum; ///< CRC-32
    std::uint16_t Method;
    bool IsEncrypted;
  };

  /// Reads the directory at the archive's end. Throws dsm::Error, which names the archive, where it is damaged, in
  /// several parts, or has more than FileLimits::ZipDirectoryBytes of names.
  explicit ZipDirectory(std::shared_ptr<const StampedSource> archive);

  const StampedSource& GetArchive() const { return *this->Archive; }
  /// In ascending order of their names.
  const std::vector<Member>& GetMembers() const { return this->Members; }
  /// The first member whose name is not less than this one.
  std::vector<Member>::const_iterator FindFirst(const std::string& name) const;
  /// Null where there is none.
  const Member* Find(const std::string& name) const;

  /// The bytes of a member, `path` for messages: those in the archive where they are stored as they are; a copy of at
  /// most `most` bytes where they are compressed by deflate. Throws dsm::Error for other methods, encryption, damage,
  /// and more bytes.
  std::shared_ptr<const StampedSource> Open(
    const Member& member, const std::string& path, std::uint64_t most) const;

private:
  /// Where the directory is.
  struct Place
  {
    std::uint64_t Begin;
    std::uint64_t Bytes;
    std::uint64_t Members;
  };
  Place FindDirectory() const;
  Place FindLargeDirectory(std::uint64_t locator) const;
  void ReadMembers(const Place& place);
  std::vector<std::byte> Read(std::uint64_t begin, std::uint64_t bytes) const;
  [[noreturn]] void Refuse(const std::string& what) const;

  std::shared_ptr<const StampedSource> Archive;
  std::vector<Member> Members;
};

} // namespace vol

#endif
