// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/AddressRange.h"

#include "DSMCore/base/Error.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace dsm
{

namespace
{

std::string DescribeRefusal(std::size_t bytes, int cause)
{
  const std::string need = std::to_string(bytes) +
    " bytes of address space are required for the blocks of all ranks, but ";
  const std::string remedy =
    ", or choose the object based memory organization (DSMMemoryOrganization).";
  rlimit limit{};
  if (cause == EAGAIN && getrlimit(RLIMIT_MEMLOCK, &limit) == 0)
  {
    return need + "the process locks all mapped memory and its limit is " +
      std::to_string(limit.rlim_cur) + " bytes (RLIMIT_MEMLOCK). Raise the limit (ulimit -l)" +
      remedy;
  }
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
  {
    return need + "the limit of the process is " + std::to_string(limit.rlim_cur) +
      " bytes (RLIMIT_AS). Raise the limit (ulimit -v)" + remedy;
  }
  return need + "the system denies the request (" + std::strerror(cause) +
    "). Use more ranks or smaller data" + remedy;
}

} // namespace

AddressRange::AddressRange(std::size_t bytes)
  : Bytes(std::max(bytes, GetPageBytes()))
{
  void* const data =
    mmap(nullptr, this->Bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (data == MAP_FAILED)
  {
    throw Error(DescribeRefusal(this->Bytes, errno));
  }
  // If the application has locked all future memory (mlockall), these pages must stay evictable.
  munlock(data, this->Bytes);
  this->Data = static_cast<std::byte*>(data);
}

AddressRange::~AddressRange()
{
  if (this->Data)
  {
    munmap(this->Data, this->Bytes);
  }
}

AddressRange::AddressRange(AddressRange&& other) noexcept
  : Data(std::exchange(other.Data, nullptr))
  , Bytes(std::exchange(other.Bytes, 0))
{
}

AddressRange& AddressRange::operator=(AddressRange&& other) noexcept
{
  std::swap(this->Data, other.Data);
  std::swap(this->Bytes, other.Bytes);
  return *this;
}

std::size_t AddressRange::GetPageBytes()
{
  static const std::size_t bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return bytes;
}

std::size_t AddressRange::RoundUpToPages(std::size_t bytes)
{
  const std::size_t page = GetPageBytes();
  return (bytes + page - 1) / page * page;
}

} // namespace dsm
