// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/grid/CellNeighbourhood.h"

#include "DSMRayTracing/field/grid/CellSteps.h"

#include <cmath>

namespace rt
{

namespace
{

constexpr int SampleStrides[3] = { 1, 4, 16 };

} // namespace

void CellNeighbourhood::CoverWithin(const bricks::Index3& cell, const bricks::Index3& cells)
{
  bool* covered = this->Covered;
  for (int z = -1; z <= 1; ++z)
  {
    for (int y = -1; y <= 1; ++y)
    {
      for (int x = -1; x <= 1; ++x)
      {
        const bricks::Index3 place = cell + bricks::Index3(x, y, z);
        *covered++ = place.x >= 0 && place.y >= 0 && place.z >= 0 && place.x < cells.x &&
          place.y < cells.y && place.z < cells.z;
      }
    }
  }
}

/// Returns whether any cell with the edge from sample (x, y, z) to the next one on `axis` is
/// covered.
bool CellNeighbourhood::IsEdgeCovered(int axis, int x, int y, int z) const
{
  const int sample[3] = { x, y, z };
  int first[3];
  int last[3];
  for (int other = 0; other < 3; ++other)
  {
    first[other] = other == axis ? sample[other] : std::max(sample[other] - 1, 0);
    last[other] = std::min(sample[other], 2);
  }
  for (int k = first[2]; k <= last[2]; ++k)
  {
    for (int j = first[1]; j <= last[1]; ++j)
    {
      for (int i = first[0]; i <= last[0]; ++i)
      {
        if (this->Covered[i + 3 * (j + 3 * k)])
        {
          return true;
        }
      }
    }
  }
  return false;
}

template <class Steps>
double CellNeighbourhood::GetCarefulDifference(
  const Steps& steps, int axis, int x, int y, int z) const
{
  const int stride = SampleStrides[axis];
  const int corner = (axis == 0 ? x : axis == 1 ? y : z) - 1;
  const double* sample = this->Samples + x + 4 * y + 16 * z;
  const bool before =
    this->IsEdgeCovered(axis, x - (axis == 0), y - (axis == 1), z - (axis == 2)) &&
    std::isfinite(sample[-stride]);
  const bool after = this->IsEdgeCovered(axis, x, y, z) && std::isfinite(sample[stride]);
  if (before && after)
  {
    return steps.GetCentral(axis, corner) * (sample[stride] - sample[-stride]);
  }
  return after ? steps.GetAlong(axis, corner) * (sample[stride] - sample[0])
    : before   ? steps.GetAlong(axis, corner - 1) * (sample[0] - sample[-stride])
               : 0.0;
}

template <class Steps>
void CellNeighbourhood::GetGradient(
  const Lanes& local, const Steps& steps, double gradient[3]) const
{
  const bool complete =
    std::all_of(this->Covered, this->Covered + 27, [](bool covered) { return covered; });
  for (int axis = 0; axis < 3; ++axis)
  {
    double differences[8];
    bool careful = !complete;
    if (complete)
    {
      const int stride = SampleStrides[axis];
      for (int corner = 0; corner < 8; ++corner)
      {
        const double* sample =
          this->Samples + 21 + (corner & 1) + 4 * (corner >> 1 & 1) + 16 * (corner >> 2);
        differences[corner] =
          steps.GetCentral(axis, corner >> axis & 1) * (sample[stride] - sample[-stride]);
        careful = careful || !std::isfinite(differences[corner]);
      }
    }
    if (careful)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        differences[corner] = this->GetCarefulDifference(
          steps, axis, 1 + (corner & 1), 1 + (corner >> 1 & 1), 1 + (corner >> 2));
      }
    }
    const Pair rows[2][2] = { { { differences[0], differences[1] },
                                { differences[2], differences[3] } },
      { { differences[4], differences[5] }, { differences[6], differences[7] } } };
    gradient[axis] = Interpolate(rows, local);
  }
}

template void CellNeighbourhood::GetGradient(const Lanes&, const UnitSteps&, double[3]) const;
template void CellNeighbourhood::GetGradient(const Lanes&, const CellSteps&, double[3]) const;

} // namespace rt
