// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RecentBricks_h
#define rt_RecentBricks_h

#include "DSMCore/base/Block.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// Keeps what a worker has found out about the bricks that rays went through last: neighboring packets of rays go
/// through the same bricks. A brick takes the place of another one now and then. For one thread.
template <class Content>
class RecentBricks
{
public:
  /// Keeps up to so many bricks, a power of two that is at least 2. Does nothing if that is the number already.
  void SetCount(std::size_t count)
  {
    if (this->Slots.size() != count)
    {
      this->Slots.assign(count, {});
      this->Shift = 64 - __builtin_ctzll(count);
    }
  }

  /// Returns the content of a brick. Calls `fill(content)` first if the slot holds another brick, or if the last `fill`
  /// of it threw.
  template <class Fill>
  Content& Get(dsm::BlockId id, const Fill& fill)
  {
    // Bricks along an axis have ids at equal distances: these must not meet.
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;
    Slot& slot = this->Slots[static_cast<std::uint64_t>(id) * golden >> this->Shift];
    if (slot.Id != static_cast<std::int64_t>(id))
    {
      slot.Id = -1;
      fill(slot.Own);
      slot.Id = static_cast<std::int64_t>(id);
    }
    return slot.Own;
  }

private:
  struct Slot
  {
    std::int64_t Id = -1;
    Content Own;
  };
  std::vector<Slot> Slots;
  int Shift = 63;
};

} // namespace rt

#endif
