// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ByteBuffer_h
#define vol_ByteBuffer_h

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace vol
{

/// Leaves what is not given a value as it is: what is read or unpacked next is not filled with zeros before, which
/// would take longer than to copy it.
template <class T>
struct UnsetAllocator : std::allocator<T>
{
  template <class Other>
  struct rebind
  {
    using other = UnsetAllocator<Other>;
  };

  template <class Other>
  void construct(Other* place)
  {
    ::new (static_cast<void*>(place)) Other;
  }
  template <class Other, class... Arguments>
  void construct(Other* place, Arguments&&... arguments)
  {
    ::new (static_cast<void*>(place)) Other(std::forward<Arguments>(arguments)...);
  }
};

/// Bytes of a file's chunks; new ones have any value.
using ByteBuffer = std::vector<std::byte, UnsetAllocator<std::byte>>;

} // namespace vol

#endif
