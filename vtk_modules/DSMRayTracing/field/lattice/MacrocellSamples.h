// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MacrocellSamples_h
#define rt_MacrocellSamples_h

#include "DSMBricks/layout/VoxelBrick.h"

#include <algorithm>
#include <type_traits>

namespace rt
{

/// The samples of a macrocell, less the first of them, with room for vectors.
struct MacrocellSamples
{
  static constexpr int Edge = bricks::MacrocellEdge + 1;
  static constexpr int RowLength = 10; ///< so that 8 can be read from each of the first three

  int Counts[3]; ///< cells on each axis
  float Values[Edge][Edge][RowLength] = {};

  /// Factors for the differences of values behind and before each inner plane of the macrocell (from 0 on) of a
  /// rectilinear grid. Their difference is then the change of the values' slope over the wider of the two cells.
  /// The factors are 1 where widths are equal.
  float Behind[3][RowLength] = {};
  float Before[3][RowLength] = {};

  /// `inverse`: reciprocals of the widths of the cells on an axis.
  void SetWidths(int axis, const double* inverse)
  {
    for (int plane = 0; plane + 1 < this->Counts[axis]; ++plane)
    {
      const double before = inverse[plane];
      const double behind = inverse[plane + 1];
      const double least = std::min(before, behind);
      // 2 widest^2 / (sum of both widths), over the width of each.
      const double factor = 2.0 * before * behind / (least * least * (before + behind));
      this->Before[axis][plane] = static_cast<float>(factor * before);
      this->Behind[axis][plane] = static_cast<float>(factor * behind);
    }
  }

  /// Copies the samples of the cells from `first` on. Returns false if a sample is not finite.
  template <class T>
  bool Set(const bricks::VoxelBrick<T>& brick, const int first[3], const int counts[3])
  {
    std::copy_n(counts, 3, this->Counts);
    const T origin = brick.GetSample(first[0], first[1], first[2]);
    float check = 0.0f;
    for (int z = 0; z <= counts[2]; ++z)
    {
      for (int y = 0; y <= counts[1]; ++y)
      {
        const T* const from =
          brick.GetSamples() + brick.GetOffset(first[0], first[1] + y, first[2] + z);
        float* const to = this->Values[z][y];
        // A loop of known length is one of vectors.
        if (counts[0] == Edge - 1)
        {
          Copy(from, origin, Edge, to);
        }
        else
        {
          Copy(from, origin, counts[0] + 1, to);
        }
        for (int x = 0; x < Edge; ++x)
        {
          check += to[x] * 0.0f;
        }
      }
    }
    return std::is_integral_v<T> || check == 0.0f;
  }

private:
  template <class T>
  [[gnu::always_inline]] static void Copy(const T* from, T origin, int count, float* to)
  {
    for (int x = 0; x < count; ++x)
    {
      if constexpr (sizeof(T) < 4 || std::is_same_v<T, float>)
      {
        to[x] = static_cast<float>(from[x]) - static_cast<float>(origin);
      }
      else
      {
        to[x] = static_cast<float>(static_cast<double>(from[x]) - static_cast<double>(origin));
      }
    }
  }
};

} // namespace rt

#endif
