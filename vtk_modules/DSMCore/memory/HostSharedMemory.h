// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostSharedMemory_h
#define dsm_HostSharedMemory_h

#include "DSMCore/memory/BlockArena.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace dsm
{

/// Zeroed memory of one rank that the other ranks of its host can read in place: an anonymous file (memfd), which
/// they open through /proc. It has no name, and goes with its last user: nothing is left behind when a process
/// crashes, and the size of /dev/shm does not matter. Its pages are large where the system offers them, as in
/// BlockArena.
class HostSharedMemory
{
public:
  /// Data that another rank needs to find the memory; a plain value, for messages.
  struct Ticket
  {
    std::uint64_t Process = 0;
    std::uint64_t Bytes = 0;
    /// At the end of the file. Process numbers repeat between containers; this does not.
    std::uint64_t Token[2] = {};
    /// Descriptor in the process; below 0: cannot be shared.
    std::int64_t File = -1;
  };

  /// Another rank's memory, mapped read only.
  class View
  {
  public:
    View() = default;
    ~View();
    View(View&& other) noexcept;
    View& operator=(View&& other) noexcept;
    const std::byte* GetData() const { return this->Data; }

  private:
    friend class HostSharedMemory;
    std::byte* Data = nullptr;
    std::size_t Bytes = 0;
  };

  HostSharedMemory() = default;
  /// `share` false, and a system that does not let memory be shared, yield memory that only this
  /// rank can read. Throws std::bad_alloc.
  HostSharedMemory(std::size_t bytes, bool share);
  ~HostSharedMemory();
  HostSharedMemory(HostSharedMemory&& other) noexcept;
  HostSharedMemory& operator=(HostSharedMemory&& other) noexcept;

  /// Aligned to BlockAlignment; null only if there is none.
  std::byte* GetData() const { return this->Shared ? this->Shared : this->Own.GetData(); }
  Ticket GetTicket() const { return this->Own.GetData() ? Ticket{} : this->Name; }
  /// Prevents further mappings; existing ones stay.
  void CloseDoor();

  /// Nothing when the memory cannot be mapped here: another host, another container, a limit.
  static std::optional<View> Open(const Ticket& ticket) noexcept;

private:
  bool Create(std::size_t bytes);

  BlockArena Own; ///< when it is not shared
  std::byte* Shared = nullptr;
  std::size_t MappedBytes = 0;
  Ticket Name;
};

} // namespace dsm

#endif
