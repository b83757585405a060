// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/HostSharedMemory.h"

#include "DSMCore/base/Block.h"
#include "DSMCore/memory/FileLimit.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <random>
#include <utility>

namespace dsm
{

namespace
{

/// Size of a large page on common processors; a wrong guess costs speed only.
constexpr std::size_t LargePage = std::size_t(2) << 20;

// Older kernel headers do not define it.
#ifdef MADV_COLLAPSE
constexpr int Collapse = MADV_COLLAPSE;
#else
constexpr int Collapse = 25;
#endif

std::size_t GetFileBytes(std::size_t bytes)
{
  return AlignBlock(std::max(bytes, std::size_t(1))) + sizeof(HostSharedMemory::Ticket::Token);
}

/// At a multiple of the size of a large page, else there could be none. Null when refused.
std::byte* MapFile(int file, std::size_t bytes, int protection)
{
  void* const range =
    mmap(nullptr, bytes + LargePage, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (range == MAP_FAILED)
  {
    return nullptr;
  }
  auto* const first = static_cast<std::byte*>(range);
  const std::size_t skipped =
    (LargePage - reinterpret_cast<std::uintptr_t>(first) % LargePage) % LargePage;
  std::byte* const begin = first + skipped;
  if (mmap(begin, bytes, protection, MAP_SHARED | MAP_FIXED, file, 0) == MAP_FAILED)
  {
    munmap(range, bytes + LargePage);
    return nullptr;
  }
  if (skipped > 0)
  {
    munmap(first, skipped);
  }
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t pages = (bytes + page - 1) / page * page;
  munmap(begin + pages, LargePage - skipped);
  return begin;
}

/// Asked for while the file is empty: large pages then cost no copy. A wish.
void PreferLargePages(std::byte* data, std::size_t bytes)
{
  const std::size_t whole = bytes / LargePage * LargePage;
  for (std::size_t offset = 0; offset < whole; offset += LargePage)
  {
    data[offset] = std::byte{ 0 };
    if (madvise(data + offset, LargePage, Collapse) != 0)
    {
      return;
    }
  }
}

} // namespace

// -- View ------------------------------------------------------------------------------------------

HostSharedMemory::View::~View()
{
  if (this->Data)
  {
    munmap(this->Data, this->Bytes);
  }
}

HostSharedMemory::View::View(View&& other) noexcept
  : Data(std::exchange(other.Data, nullptr))
  , Bytes(std::exchange(other.Bytes, 0))
{
}

HostSharedMemory::View& HostSharedMemory::View::operator=(View&& other) noexcept
{
  std::swap(this->Data, other.Data);
  std::swap(this->Bytes, other.Bytes);
  return *this;
}

// -- The owner's side ------------------------------------------------------------------------------

HostSharedMemory::HostSharedMemory(std::size_t bytes, bool share)
{
  if (!share || !this->Create(bytes))
  {
    this->Own = BlockArena(bytes);
  }
}

bool HostSharedMemory::Create(std::size_t bytes)
{
  const std::size_t fileBytes = GetFileBytes(bytes);
  if (fileBytes > GetMostFileBytes())
  {
    return false;
  }
  const int file = memfd_create("dsm blocks", MFD_CLOEXEC);
  if (file < 0)
  {
    return false;
  }
  std::byte* data = nullptr;
  if (ftruncate(file, static_cast<off_t>(fileBytes)) == 0)
  {
    data = MapFile(file, fileBytes, PROT_READ | PROT_WRITE);
  }
  if (!data)
  {
    close(file);
    return false;
  }
  PreferLargePages(data, fileBytes);
  std::random_device random;
  for (std::uint64_t& word : this->Name.Token)
  {
    word = (std::uint64_t(random()) << 32) | random();
  }
  std::memcpy(
    data + fileBytes - sizeof(this->Name.Token), this->Name.Token, sizeof(this->Name.Token));
  this->Shared = data;
  this->MappedBytes = fileBytes;
  this->Name.Process = static_cast<std::uint64_t>(getpid());
  this->Name.Bytes = bytes;
  this->Name.File = file;
  return true;
}

HostSharedMemory::~HostSharedMemory()
{
  this->CloseDoor();
  if (this->Shared)
  {
    munmap(this->Shared, this->MappedBytes);
  }
}

HostSharedMemory::HostSharedMemory(HostSharedMemory&& other) noexcept
  : Own(std::move(other.Own))
  , Shared(std::exchange(other.Shared, nullptr))
  , MappedBytes(std::exchange(other.MappedBytes, 0))
  , Name(std::exchange(other.Name, Ticket{}))
{
}

HostSharedMemory& HostSharedMemory::operator=(HostSharedMemory&& other) noexcept
{
  std::swap(this->Own, other.Own);
  std::swap(this->Shared, other.Shared);
  std::swap(this->MappedBytes, other.MappedBytes);
  std::swap(this->Name, other.Name);
  return *this;
}

void HostSharedMemory::CloseDoor()
{
  if (this->Name.File >= 0)
  {
    close(static_cast<int>(this->Name.File));
    this->Name.File = -1;
  }
}

// -- The other ranks' side -------------------------------------------------------------------------

std::optional<HostSharedMemory::View> HostSharedMemory::Open(const Ticket& ticket) noexcept
{
  if (ticket.File < 0)
  {
    return {};
  }
  // Allocates nothing, since ranks open one another's memory where they cannot report a failure.
  char path[64];
  std::snprintf(path, sizeof(path), "/proc/%llu/fd/%lld",
    static_cast<unsigned long long>(ticket.Process), static_cast<long long>(ticket.File));
  // Another process's file may be anything, so a pipe must not keep us.
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0)
  {
    return {};
  }
  std::optional<View> view;
  struct stat status = {};
  const std::size_t fileBytes = GetFileBytes(ticket.Bytes);
  std::uint64_t token[2] = {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
    static_cast<std::size_t>(status.st_size) == fileBytes &&
    pread(file, token, sizeof(token), static_cast<off_t>(fileBytes - sizeof(token))) ==
      static_cast<ssize_t>(sizeof(token)) &&
    std::memcmp(token, ticket.Token, sizeof(token)) == 0)
  {
    if (std::byte* const data = MapFile(file, fileBytes, PROT_READ))
    {
      view.emplace();
      view->Data = data;
      view->Bytes = fileBytes;
    }
  }
  close(file);
  return view;
}

} // namespace dsm
