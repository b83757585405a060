// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelVector_h
#define rt_PixelVector_h

#include "DSMCore/memory/BlockHeap.h"

#include <cstddef>
#include <vector>

namespace rt
{

/// The heap of the process for values of tiles. Not destroyed: frames of static objects may outlive it otherwise.
inline dsm::BlockHeap& GetPixelHeap()
{
  static auto* const heap = new dsm::BlockHeap;
  return *heap;
}

/// Takes memory from a heap that keeps its pages: tiles of each frame take the place of others, and new pages take
/// longer than to trace simple pixels. Any thread.
template <class T>
struct PixelAllocator
{
  using value_type = T;

  PixelAllocator() = default;
  template <class Other>
  PixelAllocator(const PixelAllocator<Other>&) noexcept
  {
  }

  T* allocate(std::size_t count)
  {
    return reinterpret_cast<T*>(GetPixelHeap().Allocate(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) noexcept
  {
    GetPixelHeap().Free(reinterpret_cast<std::byte*>(memory), count * sizeof(T));
  }

  template <class Other>
  bool operator==(const PixelAllocator<Other>&) const noexcept
  {
    return true;
  }
  template <class Other>
  bool operator!=(const PixelAllocator<Other>&) const noexcept
  {
    return false;
  }
};

/// Values of pixels of a tile.
template <class T>
using PixelVector = std::vector<T, PixelAllocator<T>>;

} // namespace rt

#endif
