// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockMemory_h
#define dsm_BlockMemory_h

#include "DSMCore/memory/BlockHeap.h"

#include <cstddef>
#include <memory>

namespace dsm
{

struct FreeBlock
{
  std::size_t Bytes = 0;
  void operator()(std::byte* memory) const noexcept
  {
    BlockHeap::GetShared().Free(memory, this->Bytes);
  }
};

/// Owned memory of one block, aligned to BlockAlignment. The producer of a block allocates it, and passes it
/// to the keeper of the block: no bytes are copied.
using BlockMemory = std::unique_ptr<std::byte, FreeBlock>;

/// Its bytes are not set. Any thread. Throws std::bad_alloc.
inline BlockMemory AllocateBlock(std::size_t bytes)
{
  return BlockMemory(BlockHeap::GetShared().Allocate(bytes), FreeBlock{ bytes });
}

} // namespace dsm

#endif
