// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageFaults_h
#define dsm_PageFaults_h

#include <sys/types.h>

#include <cstddef>
#include <map>
#include <vector>

namespace dsm
{

/// Makes ranges of addresses wait for their bytes: a thread that reads an absent page stops, its fault is reported,
/// and it continues when the page is there. One for each page store.
///
/// It uses userfaultfd(2): the kernel reports faults through a file descriptor, and fills a page before
/// it maps it (UFFDIO_COPY), so a page is seen either whole or not at all. Absent pages take no memory.
/// The kernel need not allow faults in system calls (UFFD_USER_MODE_ONLY), since no paged address is
/// ever handed to one.
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
  };

  enum class Reply
  {
    Placed,  ///< the page was fetched
    Present, ///< the page was there before anyone looked at the fault
    Refused  ///< not a store's address: the thread gets SIGSEGV, as for any other bad address
  };

  /// Throws Error with a remedy when the kernel has no userfaultfd or does not allow it.
  PageFaults();
  ~PageFaults();
  PageFaults(const PageFaults&) = delete;
  PageFaults& operator=(const PageFaults&) = delete;

  /// Takes over whole pages of an AddressRange; all are absent. Throws Error, std::bad_alloc.
  void Attach(std::byte* begin, std::size_t bytes);
  /// Detaches exactly a range that was attached. Its pages may no longer be touched, and no thread may wait
  /// there. Does nothing in a process made by fork.
  void Detach(std::byte* begin) noexcept;

  /// Fills absent pages with these `count` bytes, and with zeros up to the end of the last page. Threads that
  /// wait for them continue. Throws std::bad_alloc or Error; then the pages are absent.
  void Place(std::byte* begin, const std::byte* bytes, std::size_t count);
  /// Absent pages become zeros, at the expense of no memory. Throws as Place.
  void PlaceZeros(std::byte* begin, std::size_t bytes);
  /// Pages become absent, and their memory is free.
  void Remove(std::byte* begin, std::size_t bytes) noexcept;

  /// To every fault exactly once.
  void Answer(const Fault& fault, Reply reply) noexcept;

  /// Waits, and replaces `faults` by new ones, no more than LargestReport; false after StopWaiting.
  bool WaitForFaults(std::vector<Fault>& faults);
  static constexpr std::size_t LargestReport = 16;
  void StopWaiting() noexcept;

private:
  void Copy(std::byte* begin, const std::byte* bytes, std::size_t count);
  void Wake(std::byte* begin, std::size_t bytes) noexcept;

  pid_t Process;
  int Descriptor = -1;
  int StopDescriptor = -1; ///< eventfd
  std::map<std::byte*, std::size_t> Ranges;
  std::vector<std::byte> LastPage; ///< buffer for a block's partly filled last page
};

} // namespace dsm

#endif
