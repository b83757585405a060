// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/FaultInjection.h"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace
{

thread_local FaultInjection* Rank = nullptr;

void* Allocate(std::size_t bytes, std::size_t alignment)
{
  if (FaultInjection::Strikes(FaultInjection::Kind::Memory))
  {
    return nullptr;
  }
  void* memory = nullptr;
  return posix_memalign(&memory, alignment, bytes > 0 ? bytes : 1) == 0 ? memory : nullptr;
}

void* AllocateOrThrow(std::size_t bytes, std::size_t alignment)
{
  void* const memory = Allocate(bytes, alignment);
  return memory ? memory : throw std::bad_alloc();
}

constexpr std::size_t Plain = alignof(std::max_align_t);

/// A thread belongs to the rank of the one that starts it.
struct Beginning
{
  void* (*Function)(void*);
  void* Argument;
  FaultInjection* Of;
};

void* Begin(void* argument)
{
  const Beginning beginning = *static_cast<Beginning*>(argument);
  std::free(argument);
  Rank = beginning.Of;
  return beginning.Function(beginning.Argument);
}

} // namespace

void FaultInjection::Arm(Kind kind, long calls)
{
  this->Counted = kind;
  this->Calls = 0;
  this->Target = calls;
  this->Armed = true;
}

bool FaultInjection::Disarm()
{
  this->Armed = false;
  return this->Calls > this->Target;
}

void FaultInjection::Join()
{
  Rank = this;
}

void FaultInjection::Leave()
{
  Rank = nullptr;
}

bool FaultInjection::Strikes(Kind kind)
{
  return Rank && Rank->Armed && Rank->Counted == kind && Rank->Calls.fetch_add(1) == Rank->Target;
}

void* operator new(std::size_t bytes)
{
  return AllocateOrThrow(bytes, Plain);
}

void* operator new[](std::size_t bytes)
{
  return AllocateOrThrow(bytes, Plain);
}

void* operator new(std::size_t bytes, std::align_val_t alignment)
{
  return AllocateOrThrow(bytes, static_cast<std::size_t>(alignment));
}

void* operator new[](std::size_t bytes, std::align_val_t alignment)
{
  return AllocateOrThrow(bytes, static_cast<std::size_t>(alignment));
}

void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
  return Allocate(bytes, Plain);
}

void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept
{
  return Allocate(bytes, Plain);
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory, std::size_t) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory, std::align_val_t) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, const std::nothrow_t&) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory, const std::nothrow_t&) noexcept
{
  std::free(memory);
}

extern "C"
{
  void* mmap(
    void* address, size_t bytes, int protection, int flags, int file, off_t offset) noexcept
  {
    if (FaultInjection::Strikes(FaultInjection::Kind::Mapping))
    {
      errno = ENOMEM;
      return MAP_FAILED;
    }
    return reinterpret_cast<void*>(
      syscall(SYS_mmap, address, bytes, protection, flags, file, offset));
  }

  int mprotect(void* address, size_t bytes, int protection) noexcept
  {
    if (FaultInjection::Strikes(FaultInjection::Kind::Protection))
    {
      errno = ENOMEM;
      return -1;
    }
    return static_cast<int>(syscall(SYS_mprotect, address, bytes, protection));
  }

  int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
    void* argument) noexcept
  {
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (FaultInjection::Strikes(FaultInjection::Kind::Thread))
    {
      return EAGAIN;
    }
    auto* const beginning = static_cast<Beginning*>(std::malloc(sizeof(Beginning)));
    *beginning = { function, argument, Rank };
    const int code = create(thread, attributes, Begin, beginning);
    if (code != 0)
    {
      std::free(beginning);
    }
    return code;
  }
}
