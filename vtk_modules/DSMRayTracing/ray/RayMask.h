// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RayMask_h
#define rt_RayMask_h

#include <cstdint>

namespace rt
{

/// How many rays a batch has at most.
constexpr int MaxRays = 64;

/// Some rays of a batch: bit i is ray i.
using RayMask = std::uint64_t;
static_assert(8 * sizeof(RayMask) == MaxRays, "a bit for each ray");

/// Returns the mask of one ray, or an empty mask if `there` is false.
inline RayMask GetBit(int ray, bool there = true)
{
  return RayMask{ there } << ray;
}

/// The number of the first ray of a mask, which is not empty.
inline int GetLowest(RayMask rays)
{
  return __builtin_ctzll(rays);
}

/// Returns the bits of `count` rays from `first` on, at most 31.
inline std::uint32_t GetPart(RayMask rays, int first, int count)
{
  return static_cast<std::uint32_t>(rays >> first) & ((std::uint32_t{ 1 } << count) - 1);
}

inline int GetCount(RayMask rays)
{
  return __builtin_popcountll(rays);
}

/// Calls `visit(ray)` for the rays of a mask, the first one first.
template <class Visit>
inline void ForEachRay(RayMask rays, const Visit& visit)
{
  for (; rays != 0; rays &= rays - 1)
  {
    visit(GetLowest(rays));
  }
}

/// Returns the subset of the rays for which `is(ray)` is true.
template <class Predicate>
inline RayMask FindRays(RayMask rays, const Predicate& is)
{
  RayMask found = 0;
  ForEachRay(rays, [&](int ray) { found |= GetBit(ray, is(ray)); });
  return found;
}

} // namespace rt

#endif
