// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/dsmcore/FailingCalls.h"

#include <linux/userfaultfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace
{

constexpr int None = -1;

std::atomic<int> Armed{ None };
std::atomic<bool> Happened{ false };
std::atomic<int> Left{ 0 };
std::atomic<dsm_test::FailingCall::Of> Threads{ dsm_test::FailingCall::Of::AnyThread };
thread_local bool IsSpared = false;
thread_local bool IsMeant = false;

bool IsConcerned()
{
  switch (Threads.load())
  {
    case dsm_test::FailingCall::Of::ThisThread:
      return IsMeant;
    case dsm_test::FailingCall::Of::ThreadsNotSpared:
      return !IsSpared;
    default:
      return true;
  }
}

bool MustFail(dsm_test::Call call)
{
  int expected = static_cast<int>(call);
  if (Armed.load(std::memory_order_relaxed) != expected || !IsConcerned() || Left-- > 0 ||
    !Armed.compare_exchange_strong(expected, None))
  {
    return false;
  }
  Happened = true;
  return true;
}

} // namespace

namespace dsm_test
{

FailingCall::FailingCall(Call call, Of threads, int passed)
{
  Threads = threads;
  IsMeant = threads == Of::ThisThread;
  Left = passed;
  Happened = false;
  Armed = static_cast<int>(call);
}

FailingCall::~FailingCall()
{
  Armed = None;
  IsMeant = false;
}

bool FailingCall::HasHappened()
{
  return Happened;
}

void FailingCall::SpareThisThread()
{
  IsSpared = true;
}

} // namespace dsm_test

// -- The calls -------------------------------------------------------------------------------------

void* operator new(std::size_t bytes)
{
  const bool fails = MustFail(dsm_test::Call::Allocate) ||
    (bytes >= dsm_test::LargeBytes && MustFail(dsm_test::Call::AllocateMuch));
  void* const memory = fails ? nullptr : std::malloc(bytes > 0 ? bytes : 1);
  if (!memory)
  {
    throw std::bad_alloc();
  }
  return memory;
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

#ifndef __SANITIZE_THREAD__ // which has calls of its own, before this program begins
extern "C" void* mmap(
  void* address, std::size_t bytes, int protection, int flags, int file, off_t offset) noexcept
{
  if ((flags & MAP_ANONYMOUS) != 0 && MustFail(dsm_test::Call::Map))
  {
    errno = ENOMEM;
    return MAP_FAILED;
  }
  return reinterpret_cast<void*>(
    syscall(SYS_mmap, address, bytes, protection, flags, file, offset));
}

extern "C" int ioctl(int file, unsigned long request, ...) noexcept
{
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (request == UFFDIO_COPY && MustFail(dsm_test::Call::FillPages))
  {
    errno = ENOMEM;
    return -1;
  }
  return static_cast<int>(syscall(SYS_ioctl, file, request, argument));
}
#endif
