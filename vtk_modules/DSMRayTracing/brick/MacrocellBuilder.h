// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MacrocellBuilder_h
#define rt_MacrocellBuilder_h

#include "DSMRayTracing/brick/VoxelBrick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace rt
{

/// A float that is not above `value`, and hardly below it.
template <class T>
float RoundDown(T value)
{
  const auto wide = static_cast<double>(value);
  if (!(wide >= -static_cast<double>(std::numeric_limits<float>::max())))
  {
    return -std::numeric_limits<float>::infinity();
  }
  const auto largest = std::numeric_limits<float>::max();
  const float nearest = wide > static_cast<double>(largest) ? largest : static_cast<float>(wide);
  // The conversion of a 64-bit integer to double may have rounded up.
  const bool exact = std::is_floating_point_v<T> || std::abs(wide) < 9007199254740992.0;
  return exact && static_cast<double>(nearest) <= wide
    ? nearest
    : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

/// A float that is not below `value`, and hardly above it.
template <class T>
float RoundUp(T value)
{
  const auto wide = static_cast<double>(value);
  const auto largest = std::numeric_limits<float>::max();
  if (!(wide <= static_cast<double>(largest)))
  {
    return std::numeric_limits<float>::infinity();
  }
  const float nearest = wide < -static_cast<double>(largest) ? -largest : static_cast<float>(wide);
  const bool exact = std::is_floating_point_v<T> || std::abs(wide) < 9007199254740992.0;
  return exact && static_cast<double>(nearest) >= wide
    ? nearest
    : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// The range of the corners of those cells of a box [first, last) that hold data.
template <class T>
MacrocellRange<T> FindRange(const VoxelBrick<T>& brick, const int first[3], const int last[3])
{
  MacrocellRange<T> range{ std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest() };
  for (int z = first[2]; z < last[2]; ++z)
  {
    for (int y = first[1]; y < last[1]; ++y)
    {
      for (int x = first[0]; x < last[0]; ++x)
      {
        if (!brick.HoldsData(x, y, z))
        {
          continue;
        }
        for (int corner = 0; corner < 8; ++corner)
        {
          const T sample =
            brick.GetSample(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2));
          range.Min = std::min(range.Min, sample);
          range.Max = std::max(range.Max, sample);
        }
      }
    }
  }
  return range;
}

/// Derives, out of the samples and the mask of a brick, its macrocells and its own range.
template <class T>
void BuildMacrocells(std::byte* block)
{
  auto& header = *reinterpret_cast<VoxelBrickHeader*>(block);
  auto* ranges = reinterpret_cast<MacrocellRange<T>*>(block + VoxelBrickHeader::MacrocellOffset);
  const VoxelBrick<T> brick(block);
  header.First = std::numeric_limits<float>::infinity();
  header.Last = -std::numeric_limits<float>::infinity();
  int first[3];
  int last[3];
  for (first[2] = 0; first[2] < brick.GetCells(2); first[2] += MacrocellEdge)
  {
    last[2] = std::min(first[2] + MacrocellEdge, brick.GetCells(2));
    for (first[1] = 0; first[1] < brick.GetCells(1); first[1] += MacrocellEdge)
    {
      last[1] = std::min(first[1] + MacrocellEdge, brick.GetCells(1));
      for (first[0] = 0; first[0] < brick.GetCells(0); first[0] += MacrocellEdge)
      {
        last[0] = std::min(first[0] + MacrocellEdge, brick.GetCells(0));
        const MacrocellRange<T> range = FindRange(brick, first, last);
        *ranges++ = range;
        if (range.Min <= range.Max)
        {
          header.First = std::min(header.First, RoundDown(range.Min));
          header.Last = std::max(header.Last, RoundUp(range.Max));
        }
      }
    }
  }
}

} // namespace rt

#endif
