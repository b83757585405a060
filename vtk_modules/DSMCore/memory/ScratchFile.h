// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ScratchFile_h
#define dsm_ScratchFile_h

#include <cstddef>
#include <cstdint>
#include <string>

namespace dsm
{

/// Space on a disk for blocks that do not fit the memory. The file has no name, so it disappears with the
/// process in any case, and no other process opens it.
class ScratchFile
{
public:
  /// Sets all of the room aside where the file system can, so that a full disk is known before anything
  /// is written. Throws Error, which names the directory, the number of bytes and what to do.
  ScratchFile(std::string directory, std::uint64_t bytes);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string& GetDirectory() const { return this->Directory; }

  /// Any thread, several at a time, but not where another one writes. Throw Error likewise.
  void Write(std::uint64_t offset, const std::byte* bytes, std::size_t count);
  void Read(std::uint64_t offset, std::byte* bytes, std::size_t count) const;

  enum class Attempt
  {
    Done,
    WouldWait, ///< not all of it is in the system's memory, or reading fails
    CannotTell ///< nor will the file system ever say that it is
  };
  /// Any thread: reads where no disk has to be waited for.
  Attempt TryRead(std::uint64_t offset, std::byte* bytes, std::size_t count) const;
  /// Any thread: the system may read them to its memory; does not wait for it.
  void Prefetch(std::uint64_t offset, std::size_t count) const;

private:
  void Open();
  void SetAside();
  [[noreturn]] void RefuseRoom(int error) const;

  std::string Directory;
  std::uint64_t Bytes;
  int Descriptor = -1;
};

} // namespace dsm

#endif
