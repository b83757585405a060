// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FixedList_h
#define rt_FixedList_h

#include <cstddef>
#include <new>
#include <type_traits>

namespace rt
{

/// Up to Capacity objects one after the other, in place; room that is not used is not written to.
template <class T, int Capacity>
class FixedList
{
public:
  static_assert(std::is_trivially_destructible_v<T>, "the objects just end with the list");

  FixedList() = default;
  FixedList(const FixedList&) = delete;
  FixedList& operator=(const FixedList&) = delete;

  /// One more, at the end, which has only what its members' initializers set; there has to be room.
  T& Add() { return *new (this->Bytes + sizeof(T) * this->Count++) T; }

  T& operator[](int index)
  {
    return *std::launder(reinterpret_cast<T*>(this->Bytes + sizeof(T) * index));
  }

  int GetCount() const { return this->Count; }

private:
  alignas(T) std::byte Bytes[sizeof(T) * Capacity];
  int Count = 0;
};

} // namespace rt

#endif
