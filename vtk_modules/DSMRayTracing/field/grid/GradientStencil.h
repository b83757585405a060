// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GradientStencil_h
#define rt_GradientStencil_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/grid/CellNeighbourhood.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"

#include <cmath>
#include <cstddef>

namespace rt
{

/// The samples that the gradient in a cell needs when none is missing: its corners, and the four
/// samples beyond each of its faces. Less the isovalue.
class GradientStencil
{
public:
  /// `first`: the cell's first corner; `row` and `slice` lead to the next sample on y and z.
  template <class T>
  [[gnu::always_inline]] void SetCorners(
    const T* first, std::ptrdiff_t row, std::ptrdiff_t slice, const IsovalueLevel<T>& level)
  {
    for (int z = 0; z < 2; ++z)
    {
      for (int y = 0; y < 2; ++y)
      {
        this->Corners[z][y] = level.SubtractPair(first + y * row + z * slice);
      }
    }
  }

  /// The samples beyond the lower (side 0) or upper (1) face on an axis; `first` is the one next to
  /// the face's first corner.
  template <class T>
  [[gnu::always_inline]] void SetFace(int axis, int side, const T* first, std::ptrdiff_t row,
    std::ptrdiff_t slice, const IsovalueLevel<T>& level)
  {
    for (int i = 0; i < 2; ++i)
    {
      switch (axis)
      {
        case 0:
          this->X[side][i][0] = level.Subtract(first[i * slice]);
          this->X[side][i][1] = level.Subtract(first[row + i * slice]);
          break;
        case 1:
          this->Y[side][i] = level.SubtractPair(first + i * slice);
          break;
        default:
          this->Z[side][i] = level.SubtractPair(first + i * row);
          break;
      }
    }
  }

  /// As CellNeighbourhood::GetGradient, with the same operations. Returns false when a sample is not
  /// finite.
  template <class Steps>
  [[gnu::always_inline]] bool GetGradient(
    const Lanes& local, const Steps& steps, double gradient[3]) const
  {
    Pair differences[3][2][2];
    for (int z = 0; z < 2; ++z)
    {
      for (int y = 0; y < 2; ++y)
      {
        const Pair& corner = this->Corners[z][y];
        differences[0][z][y] = Pair{ steps.GetCentral(0, 0), steps.GetCentral(0, 1) } *
          (Pair{ corner[1], this->X[1][z][y] } - Pair{ this->X[0][z][y], corner[0] });
      }
    }
    for (int other = 0; other < 2; ++other)
    {
      differences[1][other][0] =
        steps.GetCentral(1, 0) * (this->Corners[other][1] - this->Y[0][other]);
      differences[1][other][1] =
        steps.GetCentral(1, 1) * (this->Y[1][other] - this->Corners[other][0]);
      differences[2][0][other] =
        steps.GetCentral(2, 0) * (this->Corners[1][other] - this->Z[0][other]);
      differences[2][1][other] =
        steps.GetCentral(2, 1) * (this->Z[1][other] - this->Corners[0][other]);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[axis] = CellNeighbourhood::Interpolate(differences[axis], local);
    }
    return std::isfinite(gradient[0] + gradient[1] + gradient[2]);
  }

private:
  using Pair = CellNeighbourhood::Pair;

  Pair Corners[2][2] = {}; ///< [z][y]
  double X[2][2][2] = {};  ///< [side][z][y]
  Pair Y[2][2] = {};       ///< [side][z]
  Pair Z[2][2] = {};       ///< [side][y]
};

} // namespace rt

#endif
