// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/SegmentationSignal.h"

#include "DSMCore/base/Error.h"

#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace dsm
{

namespace
{

/// Read by the handler at any time, so never freed, but used again. Begin is 0 while it is free.
struct Range
{
  std::atomic<std::uintptr_t> Begin{ 0 };
  std::atomic<std::uintptr_t> End{ 0 };
  std::atomic<SegmentationSignal::Resolver*> Owner{ nullptr };
  Range* Next = nullptr;
};

/// Who had the signal before us, the last one first. A new one is made for every change, and the old
/// ones are kept: a handler may be reading them.
struct Predecessors
{
  struct Entry
  {
    struct sigaction Action;
    mutable std::atomic<bool> Spent{ false }; ///< it was to be called once (SA_RESETHAND)
  };
  std::vector<std::shared_ptr<const Entry>> Entries;
};

std::mutex Guard; // not for the handler
std::atomic<Range*> FirstRange{ nullptr };
std::size_t RangeCount = 0;
std::atomic<const Predecessors*> Before{ nullptr };

// Memory of a thread that the handler uses must be there before: no allocation at the first use.
#define DSM_HANDLER_LOCAL static thread_local __attribute__((tls_model("initial-exec")))
/// Predecessors that this thread is in, and the stack frame from which the last was called.
DSM_HANDLER_LOCAL int ChainDepth = 0;
DSM_HANDLER_LOCAL const void* ChainFrame = nullptr;
DSM_HANDLER_LOCAL bool Unblocked = false;

void HandleSignal(int number, siginfo_t* info, void* context);

bool IsOurs(const struct sigaction& action)
{
  return (action.sa_flags & SA_SIGINFO) != 0 && action.sa_sigaction == HandleSignal;
}

/// The same handler; masks do not tell handlers apart.
bool AreEqual(const struct sigaction& a, const struct sigaction& b)
{
  return (a.sa_flags & SA_SIGINFO) == (b.sa_flags & SA_SIGINFO) &&
    ((a.sa_flags & SA_SIGINFO) != 0 ? a.sa_sigaction == b.sa_sigaction
                                    : a.sa_handler == b.sa_handler);
}

/// Ends in the way the system ends a process: the access is repeated without a handler.
void SetPlainAction(void (*plain)(int), const siginfo_t* info)
{
  struct sigaction action
  {
  };
  action.sa_handler = plain;
  sigaction(SIGSEGV, &action, nullptr);
  if (info->si_code <= 0) // sent by somebody: nothing will be repeated
  {
    syscall(SYS_tgkill, getpid(), syscall(SYS_gettid), SIGSEGV); // taken when the handler returns
  }
}

void PassOn(int number, siginfo_t* info, void* context)
{
  const void* const frame = __builtin_frame_address(0);
  if (ChainDepth > 0 && frame >= ChainFrame)
  {
    ChainDepth = 0; // the predecessor was left by a jump
  }
  // A predecessor that passes the signal on to us means the one before itself.
  const Predecessors* const before = Before.load(std::memory_order_acquire);
  const std::size_t depth = static_cast<std::size_t>(ChainDepth);
  if (!before || depth >= before->Entries.size())
  {
    SetPlainAction(SIG_DFL, info);
    return;
  }
  const Predecessors::Entry& entry = *before->Entries[depth];
  const struct sigaction& action = entry.Action;
  const bool takesInfo = (action.sa_flags & SA_SIGINFO) != 0;
  const bool once = (action.sa_flags & SA_RESETHAND) != 0;
  if ((!takesInfo && action.sa_handler == SIG_DFL) || (once && entry.Spent.exchange(true)))
  {
    SetPlainAction(SIG_DFL, info);
    return;
  }
  if (!takesInfo && action.sa_handler == SIG_IGN)
  {
    if (info->si_code > 0) // a fault cannot be ignored
    {
      SetPlainAction(SIG_IGN, info);
    }
    return;
  }
  sigset_t mask = action.sa_mask;
  pthread_sigmask(SIG_BLOCK, &mask, nullptr); // the system restores the old one
  if ((action.sa_flags & SA_NODEFER) != 0)
  {
    sigemptyset(&mask);
    sigaddset(&mask, SIGSEGV);
    pthread_sigmask(SIG_UNBLOCK, &mask, nullptr);
  }
  const void* const outerFrame = ChainFrame;
  ChainFrame = frame;
  ++ChainDepth;
  if (takesInfo)
  {
    action.sa_sigaction(number, info, context);
  }
  else
  {
    action.sa_handler(number);
  }
  --ChainDepth;
  ChainFrame = outerFrame;
}

void HandleSignal(int number, siginfo_t* info, void* context)
{
  const int error = errno;
  if (info->si_code == SEGV_MAPERR || info->si_code == SEGV_ACCERR)
  {
    auto* const address = static_cast<std::byte*>(info->si_addr);
    const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(address);
    for (const Range* range = FirstRange.load(std::memory_order_acquire); range;
         range = range->Next)
    {
      const std::uintptr_t begin = range->Begin.load(std::memory_order_acquire);
      if (begin != 0 && place >= begin && place < range->End.load(std::memory_order_relaxed))
      {
        SegmentationSignal::Resolver* const owner = range->Owner.load(std::memory_order_relaxed);
        if (range->Begin.load(std::memory_order_acquire) == begin && owner->Resolve(address))
        {
          errno = error;
          return;
        }
        break;
      }
    }
  }
  PassOn(number, info, context);
  errno = error;
}

/// Under the guard.
void SetPredecessors(const struct sigaction* first, const struct sigaction* without)
{
  static std::vector<std::unique_ptr<const Predecessors>> all;
  auto next = std::make_unique<Predecessors>();
  if (first)
  {
    auto entry = std::make_shared<Predecessors::Entry>();
    entry->Action = *first;
    next->Entries.push_back(std::move(entry));
  }
  if (const Predecessors* const before = Before.load(std::memory_order_relaxed))
  {
    for (const auto& entry : before->Entries)
    {
      if (!(first && AreEqual(entry->Action, *first)) &&
        !(without && AreEqual(entry->Action, *without)))
      {
        next->Entries.push_back(entry);
      }
    }
  }
  Before.store(next.get(), std::memory_order_release);
  all.push_back(std::move(next));
}

/// Under the guard.
void Install()
{
  struct sigaction current
  {
  };
  sigaction(SIGSEGV, nullptr, &current);
  if (IsOurs(current))
  {
    return;
  }
  SetPredecessors(&current, nullptr);
  struct sigaction ours
  {
  };
  ours.sa_sigaction = HandleSignal;
  ours.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigemptyset(&ours.sa_mask);
  if (sigaction(SIGSEGV, &ours, nullptr) != 0)
  {
    throw Error(std::string("The handler of page faults cannot be installed (") +
      std::strerror(errno) +
      "). Choose the object based memory organisation (DSMMemoryOrganization).");
  }
}

} // namespace

void SegmentationSignal::Add(std::byte* begin, std::size_t bytes, Resolver& resolver)
{
  const std::lock_guard<std::mutex> lock(Guard);
  Install();
  Range* range = FirstRange.load(std::memory_order_relaxed);
  while (range && range->Begin.load(std::memory_order_relaxed) != 0)
  {
    range = range->Next;
  }
  if (!range)
  {
    range = new Range;
    range->Next = FirstRange.load(std::memory_order_relaxed);
    FirstRange.store(range, std::memory_order_release);
  }
  const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(begin);
  range->End.store(place + bytes, std::memory_order_relaxed);
  range->Owner.store(&resolver, std::memory_order_relaxed);
  range->Begin.store(place, std::memory_order_release);
  ++RangeCount;
}

void SegmentationSignal::Remove(std::byte* begin) noexcept
{
  const std::lock_guard<std::mutex> lock(Guard);
  Range* range = FirstRange.load(std::memory_order_relaxed);
  while (range &&
    range->Begin.load(std::memory_order_relaxed) != reinterpret_cast<std::uintptr_t>(begin))
  {
    range = range->Next;
  }
  if (!range)
  {
    return;
  }
  range->Begin.store(0, std::memory_order_release);
  struct sigaction current
  {
  };
  if (--RangeCount == 0 && sigaction(SIGSEGV, nullptr, &current) == 0 && IsOurs(current))
  {
    // With somebody in front of us who may know us, we stay, and pass on.
    const auto& last = *Before.load(std::memory_order_relaxed)->Entries.front();
    struct sigaction restored = last.Action;
    if (last.Spent)
    {
      restored.sa_flags &= ~SA_SIGINFO;
      restored.sa_handler = SIG_DFL;
    }
    sigaction(SIGSEGV, &restored, nullptr);
    const struct sigaction action = last.Action;
    SetPredecessors(nullptr, &action);
  }
}

void SegmentationSignal::Reclaim()
{
  const std::lock_guard<std::mutex> lock(Guard);
  if (RangeCount > 0)
  {
    Install();
  }
}

void SegmentationSignal::Unblock() noexcept
{
  if (!Unblocked)
  {
    Unblocked = true;
    sigset_t mask;
    sigemptyset(&mask);
    sigaddset(&mask, SIGSEGV);
    pthread_sigmask(SIG_UNBLOCK, &mask, nullptr);
  }
}

} // namespace dsm
