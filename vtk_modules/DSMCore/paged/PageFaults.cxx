// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PageFaults.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/AddressRange.h"

#include <fcntl.h>
#include <linux/userfaultfd.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>

namespace dsm
{

namespace
{

// Older kernel headers do not define it.
#ifdef UFFD_USER_MODE_ONLY
constexpr int UserModeOnly = UFFD_USER_MODE_ONLY;
#else
constexpr int UserModeOnly = 1;
#endif
#ifndef USERFAULTFD_IOC_NEW
#define USERFAULTFD_IOC_NEW _IO(0xAA, 0x00)
#endif

constexpr const char* Remedy =
  "Choose Object based or Automatic as Memory Organization (DSMMemoryOrganization).";

constexpr int Flags = O_CLOEXEC | O_NONBLOCK;

int OpenBySystemCall(int flags)
{
  return static_cast<int>(syscall(SYS_userfaultfd, flags));
}

/// Its file permissions allow it to users whom the system call is denied.
int OpenByDevice()
{
  const int device = open("/dev/userfaultfd", O_RDWR | O_CLOEXEC);
  if (device < 0)
  {
    return -1;
  }
  const int descriptor = ioctl(device, USERFAULTFD_IOC_NEW, Flags);
  close(device);
  return descriptor;
}

/// Faults of the kernel itself are not needed, and fewer users may have them; kernels before 5.11
/// know no difference.
int OpenAny()
{
  int descriptor = OpenBySystemCall(Flags | UserModeOnly);
  if (descriptor < 0)
  {
    descriptor = OpenBySystemCall(Flags);
  }
  const int refusal = errno;
  if (descriptor < 0)
  {
    descriptor = OpenByDevice();
  }
  if (descriptor < 0)
  {
    errno = refusal;
  }
  return descriptor;
}

std::uint64_t ToNumber(const std::byte* address)
{
  return reinterpret_cast<std::uintptr_t>(address);
}

[[noreturn]] void Fail(const std::string& what)
{
  if (errno == ENOMEM)
  {
    throw std::bad_alloc();
  }
  throw Error("userfaultfd: " + what + " failed (" + std::strerror(errno) + "). " + Remedy);
}

[[noreturn]] void Refuse(int cause)
{
  const char* const why = cause == ENOSYS ? "this kernel does not have it"
    : cause == EPERM ? "allow it in the container's seccomp profile or, on Linux before 5.11, set "
                       "the sysctl vm.unprivileged_userfaultfd to 1"
                     : "the system denies it";
  throw Error(
    std::string("Page based memory requires the system call userfaultfd, which failed (") +
    std::strerror(cause) + "): " + why + ". " + Remedy);
}

} // namespace

PageFaults::PageFaults()
  : Process(getpid())
  , LastPage(AddressRange::GetPageBytes())
{
  this->Descriptor = OpenAny();
  uffdio_api api{};
  api.api = UFFD_API;
  api.features = UFFD_FEATURE_THREAD_ID;
  if (this->Descriptor < 0 || ioctl(this->Descriptor, UFFDIO_API, &api) != 0 ||
    (this->StopDescriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) < 0)
  {
    const int cause = errno;
    if (this->Descriptor >= 0)
    {
      close(this->Descriptor);
    }
    Refuse(cause);
  }
}

PageFaults::~PageFaults()
{
  close(this->Descriptor);
  close(this->StopDescriptor);
}

void PageFaults::Attach(std::byte* begin, std::size_t bytes)
{
  // Read only: our own copies do not need to write through the mapping. Small pages, since large ones could only
  // come and go entirely. A child must not have it: its descriptor is ours.
  if (mprotect(begin, bytes, PROT_READ) != 0 || madvise(begin, bytes, MADV_DONTFORK) != 0)
  {
    Fail("preparing " + std::to_string(bytes) + " bytes of address space");
  }
#ifdef MADV_NOHUGEPAGE
  madvise(begin, bytes, MADV_NOHUGEPAGE); // fails where there are no large pages at all
#endif
  uffdio_register range{};
  range.range.start = ToNumber(begin);
  range.range.len = bytes;
  range.mode = UFFDIO_REGISTER_MODE_MISSING;
  if (ioctl(this->Descriptor, UFFDIO_REGISTER, &range) != 0)
  {
    Fail("registering " + std::to_string(bytes) + " bytes of address space");
  }
  this->Ranges[begin] = bytes;
}

void PageFaults::Detach(std::byte* begin) noexcept
{
  const auto found = this->Ranges.find(begin);
  if (getpid() != this->Process || found == this->Ranges.end())
  {
    return;
  }
  uffdio_range range{};
  range.start = ToNumber(begin);
  range.len = found->second;
  mprotect(begin, found->second, PROT_NONE);
  ioctl(this->Descriptor, UFFDIO_UNREGISTER, &range);
  madvise(begin, found->second, MADV_DONTNEED);
  this->Ranges.erase(found);
}

void PageFaults::Copy(std::byte* begin, const std::byte* bytes, std::size_t count)
{
  std::size_t done = 0;
  while (done < count)
  {
    uffdio_copy copy{};
    copy.dst = ToNumber(begin + done);
    copy.src = ToNumber(bytes + done);
    copy.len = count - done;
    copy.mode = UFFDIO_COPY_MODE_DONTWAKE;
    if (ioctl(this->Descriptor, UFFDIO_COPY, &copy) == 0)
    {
      return;
    }
    if (errno != EAGAIN) // the mappings are being changed, or a part was copied
    {
      const int cause = errno;
      madvise(begin, done, MADV_DONTNEED);
      errno = cause;
      Fail("filling pages");
    }
    done += copy.copy > 0 ? static_cast<std::size_t>(copy.copy) : 0;
  }
}

void PageFaults::Place(std::byte* begin, const std::byte* bytes, std::size_t count)
{
  const std::size_t page = this->LastPage.size();
  const std::size_t whole = count / page * page;
  this->Copy(begin, bytes, whole);
  if (whole < count)
  {
    std::copy(bytes + whole, bytes + count, this->LastPage.begin());
    std::fill(this->LastPage.begin() + static_cast<std::ptrdiff_t>(count - whole),
      this->LastPage.end(), std::byte{ 0 });
    try
    {
      this->Copy(begin + whole, this->LastPage.data(), page);
    }
    catch (...)
    {
      madvise(begin, whole, MADV_DONTNEED);
      throw;
    }
  }
  this->Wake(begin, AddressRange::RoundUpToPages(count));
}

void PageFaults::PlaceZeros(std::byte* begin, std::size_t bytes)
{
  std::size_t done = 0;
  while (done < bytes)
  {
    uffdio_zeropage zeros{};
    zeros.range.start = ToNumber(begin + done);
    zeros.range.len = bytes - done;
    if (ioctl(this->Descriptor, UFFDIO_ZEROPAGE, &zeros) == 0)
    {
      break;
    }
    if (errno != EAGAIN)
    {
      Fail("filling pages with zeros");
    }
    done += zeros.zeropage > 0 ? static_cast<std::size_t>(zeros.zeropage) : 0;
  }
  this->Wake(begin, bytes);
}

void PageFaults::Remove(std::byte* begin, std::size_t bytes) noexcept
{
  madvise(begin, bytes, MADV_DONTNEED);
}

void PageFaults::Wake(std::byte* begin, std::size_t bytes) noexcept
{
  if (bytes > 0)
  {
    uffdio_range range{};
    range.start = ToNumber(begin);
    range.len = bytes;
    ioctl(this->Descriptor, UFFDIO_WAKE, &range);
  }
}

void PageFaults::Answer(const Fault& fault, Reply reply) noexcept
{
  switch (reply)
  {
    case Reply::Placed:
      break; // Place woke it
    case Reply::Present:
    {
      const std::size_t page = this->LastPage.size();
      this->Wake(fault.Address - reinterpret_cast<std::uintptr_t>(fault.Address) % page, page);
      break;
    }
    case Reply::Refused:
      // The signal ends the wait.
      syscall(SYS_tgkill, this->Process, fault.Thread, SIGSEGV);
      break;
  }
}

bool PageFaults::WaitForFaults(std::vector<Fault>& faults)
{
  faults.clear();
  while (faults.empty())
  {
    std::array<pollfd, 2> files{ pollfd{ this->Descriptor, POLLIN, 0 },
      pollfd{ this->StopDescriptor, POLLIN, 0 } };
    poll(files.data(), files.size(), -1);
    if (files[1].revents != 0)
    {
      return false;
    }
    std::array<uffd_msg, LargestReport> messages;
    const ssize_t bytes = read(this->Descriptor, messages.data(), sizeof(messages));
    const std::size_t count = bytes > 0 ? static_cast<std::size_t>(bytes) / sizeof(uffd_msg) : 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      if (messages[i].event == UFFD_EVENT_PAGEFAULT)
      {
        const auto& fault = messages[i].arg.pagefault;
        faults.push_back(
          { reinterpret_cast<std::byte*>(fault.address), static_cast<int>(fault.feat.ptid) });
      }
    }
  }
  return true;
}

void PageFaults::StopWaiting() noexcept
{
  const std::uint64_t one = 1;
  while (write(this->StopDescriptor, &one, sizeof(one)) < 0 && errno == EINTR)
  {
  }
}

} // namespace dsm
