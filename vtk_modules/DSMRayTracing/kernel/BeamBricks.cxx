// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/kernel/BeamBricks.h"

#include "DSMRayTracing/brick/MacrocellBuilder.h"

#include <algorithm>
#include <cstdint>

namespace rt
{

namespace
{

/// Descends through the levels, nearer macrocells first.
class Descent
{
public:
  Descent(const MacrocellHierarchy& hierarchy, const std::vector<double>& isovalues,
    const RayBeam& beam, std::vector<BeamBricks::Brick>& bricks)
    : Levels(hierarchy.GetLevels())
    , Beam(beam)
    , Bricks(bricks)
  {
    for (const double isovalue : isovalues)
    {
      this->Thresholds.push_back(RoundUp(isovalue));
    }
  }

  void Start()
  {
    const int top = static_cast<int>(this->Levels.size()) - 1;
    const int first[3] = { 0, 0, 0 };
    this->VisitBox(top, first, this->Levels[top].Size);
  }

private:
  /// Macrocells [first, last) of a level.
  void VisitBox(int number, const int first[3], const int last[3])
  {
    const MacrocellHierarchy::Level& level = this->Levels[number];
    const bool* forward = this->Beam.GetForward();
    const int size[3] = { last[0] - first[0], last[1] - first[1], last[2] - first[2] };
    for (int k = 0; k < size[2]; ++k)
    {
      const int z = forward[2] ? first[2] + k : last[2] - 1 - k;
      for (int j = 0; j < size[1]; ++j)
      {
        const int y = forward[1] ? first[1] + j : last[1] - 1 - j;
        const std::int64_t row = level.Size[0] * (y + std::int64_t{ level.Size[1] } * z);
        for (int i = 0; i < size[0]; ++i)
        {
          const int x = forward[0] ? first[0] + i : last[0] - 1 - i;
          if (this->MayHold(level.Ranges[static_cast<std::size_t>(row + x)]))
          {
            this->Visit(number, row + x, { x, y, z });
          }
        }
      }
    }
  }

  struct Place
  {
    int x;
    int y;
    int z;
  };

  void Visit(int number, std::int64_t index, const Place& place)
  {
    const MacrocellHierarchy::Level& level = this->Levels[number];
    const Lanes lower = Lanes(place.x, place.y, place.z, 0.0) * Lanes(level.Edge);
    const Lanes upper = lower + Lanes(level.Edge);
    if (!this->Beam.MayMeet(lower, upper))
    {
      return;
    }
    if (number == 0)
    {
      this->Bricks.push_back({ static_cast<dsm::BlockId>(index),
        { lower[0], lower[1], lower[2] }, { upper[0], upper[1], upper[2] } });
      return;
    }
    constexpr int ratio = 1 << MacrocellHierarchy::Shift;
    const int first[3] = { ratio * place.x, ratio * place.y, ratio * place.z };
    const int* size = this->Levels[number - 1].Size;
    const int last[3] = { std::min(first[0] + ratio, size[0]),
      std::min(first[1] + ratio, size[1]), std::min(first[2] + ratio, size[2]) };
    this->VisitBox(number - 1, first, last);
  }

  bool MayHold(const ValueRange& range) const
  {
    // ValueRange::MayHold: a float is below a value exactly when it is below the next float.
    return std::any_of(this->Thresholds.begin(), this->Thresholds.end(),
      [&](float threshold) { return range.First < threshold && threshold <= range.Last; });
  }

  const std::vector<MacrocellHierarchy::Level>& Levels;
  std::vector<float> Thresholds; ///< the isovalues, rounded up
  const RayBeam& Beam;
  std::vector<BeamBricks::Brick>& Bricks;
};

} // namespace

BeamBricks::BeamBricks(const MacrocellHierarchy& hierarchy, const std::vector<double>& isovalues,
  const GridRay corners[4])
{
  RayBeam beam;
  this->Usable = beam.Set(corners);
  if (this->Usable)
  {
    std::copy_n(beam.GetForward(), 3, this->Forward);
    Descent(hierarchy, isovalues, beam, this->Bricks).Start();
  }
}

} // namespace rt
