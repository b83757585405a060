// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_SignalFaults_h
#define dsm_SignalFaults_h

#include "DSMCore/paged/PageFaults.h"
#include "DSMCore/paged/SegmentationSignal.h"

#include <sys/types.h>

#include <array>
#include <atomic>
#include <map>
#include <string>
#include <vector>

namespace dsm
{

/// Page faults by SIGSEGV, as in the paper, for systems without userfaultfd. Every attached range
/// maps a sparse memory file of its size. Absent pages are holes of the file, and forbidden in the
/// mapping; they are filled through the file's second way in, pwrite (a second mapping would have to
/// clear every page before it is filled, and fault for each), and only then allowed. So another
/// thread never reads a page that is being filled: what the paper's could not prevent.
///
/// The handler publishes the address and waits on a futex; it takes no lock and no memory. A thread
/// listens for such addresses.
///
/// Every run of pages that are present splits the mapping, and the system limits the number of
/// mappings (vm.max_map_count): see Open. Blocks that follow one another do not split it.
class SignalFaults final
  : public PageFaults
  , private SegmentationSignal::Resolver
{
public:
  /// `refusal`: why the other way was not taken, for the text.
  explicit SignalFaults(const std::string& refusal);
  ~SignalFaults() override;

  FaultHandling GetKind() const override { return FaultHandling::Signal; }
  std::string GetText() const override { return this->Text; }
  void Attach(std::byte* begin, std::size_t bytes) override;
  void Detach(std::byte* begin) noexcept override;
  std::size_t Open(std::size_t runs) override;
  void Close() noexcept override;
  void Place(std::byte* begin, const std::byte* bytes, std::size_t count) override;
  void PlaceZeros(std::byte* begin, std::size_t bytes) override;
  void Remove(std::byte* begin, std::size_t bytes) noexcept override;
  void RemoveZeros(std::byte* begin, std::size_t bytes) noexcept override;
  void Answer(const Fault& fault, Reply reply) noexcept override;
  bool WaitForFaults(std::vector<Fault>& faults) override;
  void StopWaiting() noexcept override;

private:
  enum class SlotState : std::uint32_t
  {
    Free,
    Claimed,  ///< by a thread that faulted
    Reported, ///< its address can be read
    Taken,    ///< by the listener
    Placed,   ///< the three answers
    Present,
    Refused
  };

  /// Where a thread that faulted waits.
  struct alignas(64) Slot
  {
    std::atomic<std::uint32_t> State{ static_cast<std::uint32_t>(SlotState::Free) };
    std::byte* Address = nullptr;
    int Thread = 0;
  };

  struct File
  {
    int Descriptor;
    std::size_t Bytes;
  };

  bool Resolve(std::byte* address) noexcept override;
  SlotState WaitForAnswer(std::byte* address) noexcept;
  /// The file that a page of a range is in, and its place there.
  int GetFile(const std::byte* page, std::size_t& offset) const;

  pid_t Process;
  std::string Text;
  std::map<std::byte*, File> Files;
  std::atomic<bool> IsOpen{ false };
  std::atomic<bool> Stopping{ false };
  /// Counts reports; the listener sleeps on it.
  std::atomic<std::uint32_t> Bell{ 0 };
  std::uint32_t HeardBell = 0;
  /// Threads beyond their number wait until one is free.
  std::array<Slot, LargestReport> Slots;
};

} // namespace dsm

#endif
