// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockArena_h
#define dsm_BlockArena_h

#include <cstddef>

namespace dsm
{

/// One run of zeroed memory for the blocks that a rank owns. It comes straight from the system: pages take memory
/// when they are first written, and all of it goes back at once. The pages are large where the system offers them,
/// because bricks are read in no order, and small pages would exhaust the processor's address cache.
class BlockArena
{
public:
  BlockArena() = default;
  /// Throws std::bad_alloc.
  explicit BlockArena(std::size_t bytes);
  ~BlockArena();
  BlockArena(BlockArena&& other) noexcept;
  BlockArena& operator=(BlockArena&& other) noexcept;

  /// Aligned to BlockAlignment; never null in an arena that was asked for, even for 0 bytes.
  std::byte* GetData() const { return this->Data; }
  std::size_t GetBytes() const { return this->Bytes; }

private:
  std::byte* Data = nullptr;
  std::size_t Bytes = 0;
};

} // namespace dsm

#endif
