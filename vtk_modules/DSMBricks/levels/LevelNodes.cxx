// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/levels/LevelNodes.h"

#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cmath>

namespace bricks
{

namespace
{

Index3 GetCornerOf(int corner)
{
  return { corner & 1, corner >> 1 & 1, corner >> 2 };
}

int GetNumber(const Index3& corner)
{
  return static_cast<int>(corner.x + 2 * corner.y + 4 * corner.z);
}

} // namespace

LevelNodes::LevelNodes(const LevelLattice& lattice, dsm::BlockId id, bool ofPoints)
  : Lattice(lattice)
  , Brick(lattice.GetBrick(id))
  , OfPoints(ofPoints)
  , Around{ this->Brick.Cells.Min - Index3(1), this->Brick.Cells.Max + Index3(1) }
  , AroundSize(this->Around.GetSize())
  , Levels(static_cast<std::size_t>(this->Around.GetCount()), std::int8_t{ Nothing })
  , CellValues(lattice.GetScalarType())
  , Values(lattice.GetScalarType())
{
  if (ofPoints)
  {
    this->Values.Assign(this->CountPoints());
    this->Known.resize(this->Values.GetCount(), std::int8_t{ Nothing });
  }
  else
  {
    this->CellValues.Assign(this->Levels.size());
  }
}

std::size_t LevelNodes::CountPoints() const
{
  const Box points{ this->Brick.Cells.Min, this->Brick.Cells.Max + Index3(1) };
  return static_cast<std::size_t>(points.GetCount());
}

void LevelNodes::AddLeaves(const Box& box, const double* values, const std::uint8_t* isLeaf)
{
  const Box cells = Intersect(box, this->Around);
  const Index3 size = box.GetSize();
  ForEachIndex(cells,
    [&](const Index3& cell)
    {
      const Index3 at = cell - box.Min;
      const auto number = static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z));
      if (isLeaf[number] == 0)
      {
        return;
      }
      const std::size_t place = this->GetAround(cell);
      this->Levels[place] = static_cast<std::int8_t>(this->Brick.Level);
      if (!this->OfPoints)
      {
        this->CellValues.Set(place, values[number]);
        return;
      }
      for (int corner = 0; corner < 8; ++corner)
      {
        const Index3 from = at + GetCornerOf(corner);
        const double value = values[from.x + (size.x + 1) * (from.y + (size.y + 1) * from.z)];
        this->OfferValue(cell + GetCornerOf(corner), this->Brick.Level, value);
      }
    });
}

void LevelNodes::OfferValue(const Index3& point, int level, double value)
{
  const Box points{ this->Brick.Cells.Min, this->Brick.Cells.Max + Index3(1) };
  if (Intersect(points, { point, point + Index3(1) }).IsEmpty())
  {
    return;
  }
  const std::size_t place = this->GetPoint(point);
  std::int8_t& known = this->Known[place];
  // Where blocks disagree, the result does not depend on which came first.
  const double now = this->Values.Get(place);
  const bool isLess = value < now || (!std::isnan(value) && std::isnan(now)) ||
    (value == now && std::signbit(value) && !std::signbit(now));
  if (level > known || (level == known && isLess))
  {
    known = static_cast<std::int8_t>(level);
    this->Values.Set(place, value);
  }
}

bool LevelNodes::TouchesLeaf(const Index3& cell) const
{
  bool touches = false;
  ForEachIndex(Intersect({ cell - Index3(1), cell + Index3(2) }, this->Brick.Cells),
    [&](const Index3& near) { touches = touches || this->IsLeaf(near); });
  return touches;
}

void LevelNodes::AddLeaf(const ForeignLeaf& leaf)
{
  const LevelScales& scales = this->Lattice.GetScales();
  const Index3 cell(leaf.Cell[0], leaf.Cell[1], leaf.Cell[2]);
  if (leaf.Level < this->Brick.Level)
  {
    const Index3 ratio = scales.GetRatio(leaf.Level, this->Brick.Level);
    const Box covered{ cell * ratio, (cell + Index3(1)) * ratio };
    ForEachIndex(Intersect(covered, this->Around),
      [&](const Index3& part)
      {
        const std::size_t place = this->GetAround(part);
        this->Levels[place] = static_cast<std::int8_t>(leaf.Level);
        if (!this->OfPoints)
        {
          this->CellValues.Set(place, leaf.Values[0]);
        }
      });
    return;
  }
  const Index3 ratio = scales.GetRatio(this->Brick.Level, leaf.Level);
  const Index3 home = DivideDown(cell, ratio);
  if (Intersect(this->Around, { home, home + Index3(1) }).IsEmpty() || !this->TouchesLeaf(home))
  {
    return;
  }
  const std::size_t place = this->GetAround(home);
  this->Levels[place] = Smaller;
  const Index3 at = cell - home * ratio;
  for (int corner = 0; corner < 8; ++corner)
  {
    // Only a leaf in a corner of the cell touches that point.
    const Index3 side = GetCornerOf(corner);
    if (at != side * (ratio - Index3(1)))
    {
      continue;
    }
    this->Smalls[place][static_cast<std::size_t>(corner)] = { leaf.Values[corner], leaf.Level };
    if (this->OfPoints)
    {
      this->OfferValue(home + side, leaf.Level, leaf.Values[corner]);
    }
  }
}

LevelNodes::Corner LevelNodes::GetOctant(const Index3& point, int octant) const
{
  const Index3 side = GetCornerOf(octant);
  const std::size_t place = this->GetAround(point - Index3(1) + side);
  const int level = this->Levels[place];
  if (level == Smaller)
  {
    const int corner = GetNumber(Index3(1) - side);
    return this->Smalls.at(place)[static_cast<std::size_t>(corner)];
  }
  return { this->OfPoints || level == Nothing ? 0.0 : this->CellValues.Get(place), level };
}

int LevelNodes::GetOctantLevel(const Index3& point, int octant) const
{
  const std::size_t place = this->GetAround(point - Index3(1) + GetCornerOf(octant));
  return this->Levels[place];
}

void LevelNodes::FindMeans()
{
  if (!this->OfPoints)
  {
    this->Values.Assign(this->CountPoints());
  }
  ForEachIndex({ this->Brick.Cells.Min, this->Brick.Cells.Max + Index3(1) },
    [this](const Index3& point) { this->FindMean(point); });
  this->CellValues.Free();
}

void LevelNodes::FindMean(const Index3& point)
{
  Corner octants[8];
  int coarsest = Smaller;
  bool isOfLeaf = false;
  Index3 least(1); // sides on which there is anything
  Index3 most(0);
  for (int octant = 0; octant < 8; ++octant)
  {
    octants[octant] = this->GetOctant(point, octant);
    const int level = octants[octant].Level;
    if (level != Nothing)
    {
      coarsest = std::min(coarsest, level);
      isOfLeaf = isOfLeaf || level == this->Brick.Level;
      least = glm::min(least, GetCornerOf(octant));
      most = glm::max(most, GetCornerOf(octant));
    }
  }
  if (!isOfLeaf)
  {
    return;
  }
  const Index3 inward = least + most - Index3(1);
  const bool isAtBorder = !this->OfPoints && inward != Index3(0);
  if (coarsest < this->Brick.Level)
  {
    const Index3 ratio = this->Lattice.GetScales().GetRatio(coarsest, this->Brick.Level);
    if (isAtBorder || DivideDown(point, ratio) * ratio != point)
    {
      this->Hanging.push_back(point);
      return;
    }
  }
  if (this->OfPoints)
  {
    return;
  }
  double sum = 0.0;
  double weights = 0.0;
  double count = 0.0;
  for (const Corner& octant : octants)
  {
    if (octant.Level != Nothing)
    {
      count += 1.0;
      const LevelScales& scales = this->Lattice.GetScales();
      const double weight = scales.GetSize(coarsest) / scales.GetSize(octant.Level);
      sum += weight * octant.Value;
      weights += weight;
    }
  }
  this->Values.Set(this->GetPoint(point), sum / weights);
  const Box points{ this->Brick.Cells.Min, this->Brick.Cells.Max + Index3(1) };
  const Index3 next = point + inward;
  if (isAtBorder && !Intersect(points, { next, next + Index3(1) }).IsEmpty())
  {
    this->Border.push_back({ point, next, 1.0 / (2.0 * weights / count - 1.0) });
  }
}

void LevelNodes::AddCorners(const ForeignLeaf& leaf)
{
  const Index3 cell(leaf.Cell[0], leaf.Cell[1], leaf.Cell[2]);
  std::array<double, 8>& corners = this->Larger[GetPlace(leaf.Level, cell)];
  std::copy_n(leaf.Values, 8, corners.begin());
}

bool LevelNodes::Interpolate(
  const Index3& point, int level, const Index3& leaf, double& value) const
{
  const auto found = this->Larger.find(GetPlace(level, leaf));
  if (found == this->Larger.end())
  {
    return false;
  }
  const Index3 ratio = this->Lattice.GetScales().GetRatio(level, this->Brick.Level);
  const Index3 corner = (point - leaf * ratio) / ratio;
  if ((leaf + corner) * ratio == point)
  {
    value = found->second[static_cast<std::size_t>(GetNumber(corner))];
    return true;
  }
  const glm::dvec3 at = glm::dvec3(point - leaf * ratio) / glm::dvec3(ratio);
  const auto mix = [](double a, double b, double part) { return (1.0 - part) * a + part * b; };
  const std::array<double, 8>& c = found->second;
  const double front = mix(mix(c[0], c[1], at.x), mix(c[2], c[3], at.x), at.y);
  const double back = mix(mix(c[4], c[5], at.x), mix(c[6], c[7], at.x), at.y);
  // Rounding does not lead out of what the leaf has, by which rays skip it.
  const auto [least, most] = std::minmax_element(c.begin(), c.end());
  const double exact = mix(front, back, at.z);
  value = exact < *least ? *least : (exact > *most ? *most : exact);
  return true;
}

void LevelNodes::FindHanging()
{
  for (const Index3& point : this->Hanging)
  {
    // Leaves that are equally large have the same value: the first in the order of octants counts.
    int coarsest = this->Brick.Level;
    Index3 leaf(0);
    for (int octant = 0; octant < 8; ++octant)
    {
      const int level = this->GetOctantLevel(point, octant);
      if (level != Nothing && level < coarsest)
      {
        coarsest = level;
        leaf = DivideDown(point - Index3(1) + GetCornerOf(octant),
          this->Lattice.GetScales().GetRatio(level, this->Brick.Level));
      }
    }
    double value = 0.0;
    if (!this->Interpolate(point, coarsest, leaf, value))
    {
      throw dsm::Error("The corners of a cell of level " + std::to_string(coarsest) +
        " are missing. Do all ranks run the same build?");
    }
    this->Values.Set(this->GetPoint(point), value);
  }
}

void LevelNodes::ExtendToBorder(const std::array<double, 2>& limits)
{
  std::vector<double> values; // from those that all points had before
  for (const BorderPoint& one : this->Border)
  {
    const double mean = this->Values.Get(this->GetPoint(one.Point));
    const double growth = mean - this->Values.Get(this->GetPoint(one.Next));
    const double value = mean + one.Reach * growth;
    values.push_back(std::isfinite(value) ? std::clamp(value, limits[0], limits[1]) : mean);
  }
  for (std::size_t number = 0; number < values.size(); ++number)
  {
    this->Values.Set(this->GetPoint(this->Border[number].Point), values[number]);
  }
}

std::uint8_t LevelNodes::FindBorders() const
{
  std::uint8_t borders = 0;
  ForEachIndex(this->Brick.Cells,
    [&](const Index3& cell)
    {
      for (int side = 0; side < 6 && this->IsLeaf(cell); ++side)
      {
        Index3 next = cell;
        next[side / 2] += side % 2 == 0 ? -1 : 1;
        const int level = this->Levels[this->GetAround(next)];
        if (level != Nothing && level != this->Brick.Level)
        {
          borders |= this->Brick.Has(next) ? VoxelBrickHeader::InnerBorder
                                           : static_cast<std::uint8_t>(1 << side);
        }
      }
    });
  return borders;
}

ForeignLeaf LevelNodes::GetLeaf(const Index3& cell) const
{
  ForeignLeaf leaf{};
  leaf.Level = this->Brick.Level;
  for (int axis = 0; axis < 3; ++axis)
  {
    leaf.Cell[axis] = static_cast<std::int32_t>(cell[axis]);
  }
  for (int corner = 0; corner < 8; ++corner)
  {
    leaf.Values[corner] = this->Values.Get(this->GetPoint(cell + GetCornerOf(corner)));
  }
  return leaf;
}

} // namespace bricks
