// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageFaults_h
#define dsm_PageFaults_h

#include "DSMCore/paged/FaultHandling.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace dsm
{

/// Makes ranges of addresses wait for their bytes: a thread that reads an absent page stops, its
/// fault is reported, and it goes on when the page is there. One for each page store.
///
/// Absent pages take no memory. A page is seen either whole or not at all.
///
/// Threads: WaitForFaults is for one listening thread; Answer and PlaceZeros for it too; all else is
/// for the communication thread. None of them may touch an absent page.
class PageFaults
{
public:
  struct Fault
  {
    std::byte* Address = nullptr; ///< anywhere in the page
    int Thread = 0;               ///< the kernel's number of the thread that waits
    std::uint32_t Ticket = 0;     ///< the handler's own
  };

  enum class Reply
  {
    Placed,  ///< the page was fetched
    Present, ///< the page was there before anyone looked at the fault
    Refused  ///< no business of ours: the thread gets SIGSEGV, as for any other bad address
  };

  virtual ~PageFaults() = default;

  /// Automatic tries both. Throws Error when the system does not allow what is asked for.
  static std::unique_ptr<PageFaults> Create(FaultHandling handling);

  /// UserFaultFd or Signal.
  virtual FaultHandling GetKind() const = 0;
  /// For the user.
  virtual std::string GetText() const = 0;

  /// Takes over whole pages of an AddressRange; all are absent. Throws Error.
  virtual void Attach(std::byte* begin, std::size_t bytes) = 0;
  /// The pages may no longer be touched. Exactly what was attached; nobody waits there. Does nothing
  /// in a process made by fork.
  virtual void Detach(std::byte* begin) noexcept = 0;

  /// Before a frame. Returns how many separate runs of present pages there may be, `runs` being
  /// there already. Throws Error when there may be none.
  virtual std::size_t Open(std::size_t runs) = 0;
  /// After a frame: until the next one, a fault is an error of the program.
  virtual void Close() noexcept = 0;

  /// Absent pages become these `count` bytes, and zeros up to the end of the last page. Threads that
  /// wait for them may go on, but are not told (Answer). Throws std::bad_alloc, Error; the pages are
  /// absent then.
  virtual void Place(std::byte* begin, const std::byte* bytes, std::size_t count) = 0;
  /// Absent pages become zeros, at the expense of no memory.
  virtual void PlaceZeros(std::byte* begin, std::size_t bytes) = 0;
  /// Placed pages become absent, and their memory is free.
  virtual void Remove(std::byte* begin, std::size_t bytes) noexcept = 0;
  /// As Remove, for what PlaceZeros made.
  virtual void RemoveZeros(std::byte* begin, std::size_t bytes) noexcept = 0;

  /// To every fault exactly once.
  virtual void Answer(const Fault& fault, Reply reply) noexcept = 0;

  /// Waits, and replaces `faults` by new ones, no more than LargestReport; false after StopWaiting.
  virtual bool WaitForFaults(std::vector<Fault>& faults) = 0;
  static constexpr std::size_t LargestReport = 256;
  virtual void StopWaiting() noexcept = 0;

protected:
  static constexpr std::size_t AnyNumberOfRuns = std::numeric_limits<std::size_t>::max();
};

} // namespace dsm

#endif
