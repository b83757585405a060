// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_UserFaultFd_h
#define dsm_UserFaultFd_h

#include "DSMCore/paged/PageFaults.h"

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace dsm
{

/// Page faults by userfaultfd(2): the kernel stops a thread that touches an absent page and reports
/// it through a file descriptor; UFFDIO_COPY fills a page before it maps it. The kernel need not
/// allow faults in system calls (UFFD_USER_MODE_ONLY), since no paged address is ever handed to one.
class UserFaultFd final : public PageFaults
{
public:
  /// Throws Error when the kernel has no userfaultfd or does not allow it.
  UserFaultFd();
  ~UserFaultFd() override;

  FaultHandling GetKind() const override { return FaultHandling::UserFaultFd; }
  std::string GetText() const override { return this->Text; }
  void Attach(std::byte* begin, std::size_t bytes) override;
  void Detach(std::byte* begin) noexcept override;
  std::size_t Open(std::size_t) override { return AnyNumberOfRuns; }
  void Close() noexcept override {}
  void Place(std::byte* begin, const std::byte* bytes, std::size_t count) override;
  void PlaceZeros(std::byte* begin, std::size_t bytes) override;
  void Remove(std::byte* begin, std::size_t bytes) noexcept override;
  void RemoveZeros(std::byte* begin, std::size_t bytes) noexcept override;
  void Answer(const Fault& fault, Reply reply) noexcept override;
  bool WaitForFaults(std::vector<Fault>& faults) override;
  void StopWaiting() noexcept override;

private:
  void Copy(std::byte* begin, const std::byte* bytes, std::size_t count);
  void Wake(std::byte* begin, std::size_t bytes) noexcept;

  pid_t Process;
  std::string Text;
  int Descriptor = -1;
  int StopDescriptor = -1; ///< eventfd
  std::map<std::byte*, std::size_t> Ranges;
  std::vector<std::byte> LastPage; ///< of a block that does not end at a page's end
};

} // namespace dsm

#endif
