// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/BlockArena.h"

#include "DSMCore/base/Block.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <utility>

namespace dsm
{

BlockArena::BlockArena(std::size_t bytes)
  : Bytes(std::max(bytes, BlockAlignment))
{
  void* const data =
    mmap(nullptr, this->Bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  this->Data = static_cast<std::byte*>(data);
#ifdef MADV_HUGEPAGE
  madvise(data, this->Bytes, MADV_HUGEPAGE); // a wish: without it all is slower, nothing is wrong
#endif
}

BlockArena::~BlockArena()
{
  if (this->Data)
  {
    munmap(this->Data, this->Bytes);
  }
}

BlockArena::BlockArena(BlockArena&& other) noexcept
  : Data(std::exchange(other.Data, nullptr))
  , Bytes(std::exchange(other.Bytes, 0))
{
}

BlockArena& BlockArena::operator=(BlockArena&& other) noexcept
{
  std::swap(this->Data, other.Data);
  std::swap(this->Bytes, other.Bytes);
  return *this;
}

} // namespace dsm
