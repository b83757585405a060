// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_AddressRange_h
#define dsm_AddressRange_h

#include <cstddef>

namespace dsm
{

/// Reserved range of addresses. It takes no memory, may not be touched, and nothing else is mapped
/// there. Memory that is mapped into the range is unmapped with it.
class AddressRange
{
public:
  AddressRange() = default;
  /// Throws Error, naming the limit that is in the way: of the address space (RLIMIT_AS), of locked
  /// memory (RLIMIT_MEMLOCK, in a process that locks all it maps), of the machine.
  explicit AddressRange(std::size_t bytes);
  ~AddressRange();
  AddressRange(AddressRange&& other) noexcept;
  AddressRange& operator=(AddressRange&& other) noexcept;

  /// Starts at a page.
  std::byte* GetData() const { return this->Data; }
  std::size_t GetBytes() const { return this->Bytes; }

  /// The machine's.
  static std::size_t GetPageBytes();
  static std::size_t RoundUpToPages(std::size_t bytes);

private:
  std::byte* Data = nullptr;
  std::size_t Bytes = 0;
};

} // namespace dsm

#endif
