// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/SignalFaults.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/AddressRange.h"
#include "DSMCore/memory/FileLimit.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>

namespace dsm
{

namespace
{

/// Mappings that are left to the application and to the libraries that it may load.
constexpr std::size_t SpareMappings = 2048;

/// A thread that finds its page present and faults there again, this many times in a row, is denied
/// something else (it writes): that is an error of the program. Otherwise it happens when the page
/// comes or goes at that very moment.
constexpr int LargestRepetition = 1000;

// Memory of a thread that the handler uses must be there before: no allocation at the first use.
static thread_local __attribute__((tls_model("initial-exec"))) std::byte* RepeatedAddress = nullptr;
static thread_local __attribute__((tls_model("initial-exec"))) int Repetitions = 0;

void WaitOn(std::atomic<std::uint32_t>& word, std::uint32_t value)
{
  syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, value, nullptr, nullptr, 0);
}

void WakeOn(std::atomic<std::uint32_t>& word)
{
  syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
}

[[noreturn]] void Fail(const std::string& what)
{
  const int cause = errno;
  const std::string remedy =
    " or choose the object based memory organisation (DSMMemoryOrganization).";
  rlimit limit{};
  if (cause == EAGAIN && getrlimit(RLIMIT_MEMLOCK, &limit) == 0)
  {
    throw Error(what + " failed: the process may lock no more than " +
      std::to_string(limit.rlim_cur) + " bytes (RLIMIT_MEMLOCK). Raise the limit (ulimit -l)," +
      remedy);
  }
  if (cause == ENOSPC)
  {
    throw std::bad_alloc();
  }
  throw Error(what + " failed (" + std::strerror(cause) +
    (cause == ENOMEM ? "; the memory or the number of mappings, vm.max_map_count, is exhausted"
                     : "") +
    "). Use a smaller cache (DSMCacheSize)," + remedy);
}

std::size_t CountMappings()
{
  std::ifstream maps("/proc/self/maps");
  return static_cast<std::size_t>(
    std::count(std::istreambuf_iterator<char>(maps), std::istreambuf_iterator<char>(), '\n'));
}

std::size_t GetLargestNumberOfMappings()
{
  std::size_t largest = 65530; // the system's default
  std::ifstream("/proc/sys/vm/max_map_count") >> largest;
  return largest;
}

} // namespace

SignalFaults::SignalFaults(const std::string& refusal)
  : Process(getpid())
  , Text("SIGSEGV over memory files")
{
  if (!refusal.empty())
  {
    this->Text += ", because: " + refusal;
  }
}

SignalFaults::~SignalFaults()
{
  if (getpid() == this->Process)
  {
    while (!this->Files.empty())
    {
      this->Detach(this->Files.begin()->first);
    }
  }
  for (const auto& [begin, file] : this->Files) // a child lets go of its copies
  {
    SegmentationSignal::Remove(begin);
    close(file.Descriptor);
  }
}

void SignalFaults::Attach(std::byte* begin, std::size_t bytes)
{
  const std::uint64_t most = GetMostFileBytes();
  if (most < bytes)
  {
    throw Error("A memory file of " + std::to_string(bytes) +
      " bytes is needed for the blocks of other ranks, but files are limited to " +
      std::to_string(most) +
      " bytes (RLIMIT_FSIZE). Raise the limit (ulimit -f), or choose the object based memory "
      "organisation (DSMMemoryOrganization).");
  }
  const int file = memfd_create("dsm-pages", MFD_CLOEXEC);
  if (file < 0)
  {
    Fail("Creating a memory file");
  }
  // A child must not have the mapping: its pages come and go without its knowledge.
  if (ftruncate(file, static_cast<off_t>(bytes)) != 0 ||
    mmap(begin, bytes, PROT_NONE, MAP_SHARED | MAP_FIXED | MAP_NORESERVE, file, 0) == MAP_FAILED ||
    madvise(begin, bytes, MADV_DONTFORK) != 0)
  {
    const int cause = errno;
    close(file);
    errno = cause;
    Fail("Mapping a memory file of " + std::to_string(bytes) + " bytes");
  }
  munlock(begin, bytes); // where the application locks all that it maps
  this->Files[begin] = File{ file, bytes };
  try
  {
    SegmentationSignal::Add(begin, bytes, *this);
  }
  catch (...)
  {
    this->Detach(begin);
    throw;
  }
}

void SignalFaults::Detach(std::byte* begin) noexcept
{
  const auto found = this->Files.find(begin);
  if (getpid() != this->Process || found == this->Files.end())
  {
    return;
  }
  SegmentationSignal::Remove(begin);
  mmap(begin, found->second.Bytes, PROT_NONE,
    MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0);
  close(found->second.Descriptor);
  this->Files.erase(found);
}

std::size_t SignalFaults::Open(std::size_t runs)
{
  if (this->Files.empty())
  {
    return AnyNumberOfRuns;
  }
  SegmentationSignal::Reclaim();
  const std::size_t largest = GetLargestNumberOfMappings();
  const std::size_t used = CountMappings() + SpareMappings;
  // A run adds two mappings: itself, and what is behind it.
  const std::size_t limit = runs + (largest > used ? (largest - used) / 2 : 0);
  if (limit == 0)
  {
    throw Error("The process has " + std::to_string(used - SpareMappings) +
      " memory mappings; too few of the " + std::to_string(largest) +
      " that the system allows are left for the page based memory organisation. Raise "
      "vm.max_map_count (sysctl), or choose the object based organisation "
      "(DSMMemoryOrganization).");
  }
  this->IsOpen.store(true, std::memory_order_release);
  return limit;
}

void SignalFaults::Close() noexcept
{
  this->IsOpen.store(false, std::memory_order_release);
}

int SignalFaults::GetFile(const std::byte* page, std::size_t& offset) const
{
  auto found = this->Files.upper_bound(const_cast<std::byte*>(page));
  if (found == this->Files.begin() || page >= (--found)->first + found->second.Bytes)
  {
    throw Error("A page is in no memory file. This is a defect of the program.");
  }
  offset = static_cast<std::size_t>(page - found->first);
  return found->second.Descriptor;
}

void SignalFaults::Place(std::byte* begin, const std::byte* bytes, std::size_t count)
{
  std::size_t offset = 0;
  const int file = this->GetFile(begin, offset);
  const std::size_t pages = AddressRange::RoundUpToPages(count);
  const auto giveUp = [&](const char* what)
  {
    const int cause = errno;
    this->Remove(begin, pages);
    errno = cause;
    Fail(what);
  };
  std::size_t done = 0;
  while (done < count)
  {
    const ssize_t written =
      pwrite(file, bytes + done, count - done, static_cast<off_t>(offset + done));
    if (written < 0 && errno != EINTR)
    {
      giveUp("Filling pages");
    }
    done += written > 0 ? static_cast<std::size_t>(written) : 0;
  }
  if (mprotect(begin, pages, PROT_READ) != 0)
  {
    giveUp("Allowing pages");
  }
#ifdef MADV_POPULATE_READ
  madvise(begin, pages, MADV_POPULATE_READ); // spares the reader faults; a wish
#endif
}

void SignalFaults::PlaceZeros(std::byte* begin, std::size_t bytes)
{
  if (mmap(begin, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1,
        0) == MAP_FAILED)
  {
    Fail("Filling pages with zeros");
  }
}

void SignalFaults::Remove(std::byte* begin, std::size_t bytes) noexcept
{
  std::size_t offset = 0;
  const int file = this->GetFile(begin, offset);
  mprotect(begin, bytes, PROT_NONE);
  fallocate(file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset),
    static_cast<off_t>(bytes));
}

void SignalFaults::RemoveZeros(std::byte* begin, std::size_t bytes) noexcept
{
  std::size_t offset = 0;
  const int file = this->GetFile(begin, offset);
  mmap(begin, bytes, PROT_NONE, MAP_SHARED | MAP_FIXED | MAP_NORESERVE, file,
    static_cast<off_t>(offset));
  madvise(begin, bytes, MADV_DONTFORK);
  munlock(begin, bytes);
}

// -- The faulting thread, in the signal handler -----------------------------------------------------

bool SignalFaults::Resolve(std::byte* address) noexcept
{
  if (!this->IsOpen.load(std::memory_order_acquire) || getpid() != this->Process)
  {
    return false;
  }
  const SlotState answer = this->WaitForAnswer(address);
  if (answer != SlotState::Present || address != RepeatedAddress)
  {
    RepeatedAddress = address;
    Repetitions = 0;
  }
  return answer != SlotState::Refused && ++Repetitions < LargestRepetition;
}

SignalFaults::SlotState SignalFaults::WaitForAnswer(std::byte* address) noexcept
{
  constexpr auto claimed = static_cast<std::uint32_t>(SlotState::Claimed);
  constexpr auto taken = static_cast<std::uint32_t>(SlotState::Taken);
  const int thread = static_cast<int>(syscall(SYS_gettid));
  std::size_t index = static_cast<std::size_t>(thread);
  Slot* slot = nullptr;
  for (;; ++index)
  {
    slot = &this->Slots[index % this->Slots.size()];
    std::uint32_t free = static_cast<std::uint32_t>(SlotState::Free);
    if (slot->State.compare_exchange_strong(free, claimed, std::memory_order_acquire))
    {
      break;
    }
    if (index % this->Slots.size() == 0)
    {
      sched_yield();
    }
  }
  slot->Address = address;
  slot->Thread = thread;
  slot->State.store(static_cast<std::uint32_t>(SlotState::Reported), std::memory_order_release);
  this->Bell.fetch_add(1, std::memory_order_release);
  WakeOn(this->Bell);
  std::uint32_t state = slot->State.load(std::memory_order_acquire);
  while (state <= taken)
  {
    WaitOn(slot->State, state);
    state = slot->State.load(std::memory_order_acquire);
  }
  slot->State.store(static_cast<std::uint32_t>(SlotState::Free), std::memory_order_release);
  return static_cast<SlotState>(state);
}

// -- The listening thread ---------------------------------------------------------------------------

bool SignalFaults::WaitForFaults(std::vector<Fault>& faults)
{
  faults.clear();
  while (!this->Stopping.load(std::memory_order_acquire))
  {
    const std::uint32_t bell = this->Bell.load(std::memory_order_acquire);
    if (bell == this->HeardBell)
    {
      WaitOn(this->Bell, bell);
      continue;
    }
    this->HeardBell = bell;
    for (std::size_t index = 0; index < this->Slots.size(); ++index)
    {
      Slot& slot = this->Slots[index];
      std::uint32_t state = static_cast<std::uint32_t>(SlotState::Reported);
      if (slot.State.compare_exchange_strong(
            state, static_cast<std::uint32_t>(SlotState::Taken), std::memory_order_acquire))
      {
        faults.push_back(Fault{ slot.Address, slot.Thread, static_cast<std::uint32_t>(index) });
      }
    }
    if (!faults.empty())
    {
      return true;
    }
  }
  return false;
}

void SignalFaults::StopWaiting() noexcept
{
  this->Stopping.store(true, std::memory_order_release);
  this->Bell.fetch_add(1, std::memory_order_release);
  WakeOn(this->Bell);
}

void SignalFaults::Answer(const Fault& fault, Reply reply) noexcept
{
  const SlotState state = reply == Reply::Placed ? SlotState::Placed
    : reply == Reply::Present                    ? SlotState::Present
                                                 : SlotState::Refused;
  Slot& slot = this->Slots[fault.Ticket];
  slot.State.store(static_cast<std::uint32_t>(state), std::memory_order_release);
  WakeOn(slot.State);
}

} // namespace dsm
