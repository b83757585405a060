// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellCrossings_h
#define rt_CellCrossings_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/SplitCells.h"
#include "DSMRayTracing/field/tetrahedra/TetrahedronCrossing.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/ShearedRay.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rt
{

/// Finds the tetrahedra of a brick that a ray crosses.
template <class Filter>
class BrickCrossings
{
public:
  /// `filter` tells what values are looked for:
  /// - `FindChildren(ranges)`: bit i set when child i may have such, by the node's ranges (CellValueBrick);
  /// - `MayHold(first, last)`: whether values between these may be such.
  /// All is kept by reference.
  BrickCrossings(const bricks::CellBrick& brick, const bricks::CellValueBrick& values,
    const ShearedRay& ray, const Filter& filter)
    : Brick(brick)
    , Nodes(brick.GetNodes())
    , Values(values)
    , Numbers(values.GetValues())
    , Ray(ray)
    , Wanted(filter)
  {
  }

  /// Calls `visit(crossing, corners)` for the crossings between the ray's Min and Max, nearer cells first, but in no
  /// strict order. `corners`: numbers of the tetrahedron's points. It may shorten the ray.
  template <class Visit>
  void ForEach(const Visit& visit) const
  {
    TraverseWideBvh(this->Nodes, *this,
      [&](std::uint16_t leaf)
      {
        std::uint16_t corners[bricks::CellBrick::GroupSize][bricks::CellBrick::MostCorners];
        const int cells = this->Brick.ReadGroup(bricks::CellBrick::GetGroup(leaf), corners);
        for (int cell = 0; cell < cells; ++cell)
        {
          this->VisitCell(corners[cell], visit);
        }
      });
  }

  unsigned FindChildren(
    const bricks::CellBrick::Node& node, float enter[bricks::WideBvhWidth]) const
  {
    const auto number = static_cast<std::uint32_t>(&node - this->Nodes);
    const unsigned wanted = this->Wanted.FindChildren(this->Values.GetRanges(number));
    return wanted == 0 ? 0 : wanted & this->Ray.Boxes.FindChildren(node, this->Ray.BoxesEnd, enter);
  }
  bool IsOpen(float enter) const { return enter <= this->Ray.BoxesEnd; }

private:
  template <class Visit>
  void VisitCell(const std::uint16_t* cell, const Visit& visit) const
  {
    const int count = this->Brick.GetHeader().Corners;
    float least = this->Numbers[cell[0]];
    float most = least;
    for (int corner = 1; corner < count; ++corner)
    {
      const float value = this->Numbers[cell[corner]];
      least = std::min(value, least);
      most = std::max(value, most);
    }
    if (!this->Wanted.MayHold(least, most) || !HasValues(this->Numbers, cell, count))
    {
      return;
    }
    SeenPoint seen[bricks::CellBrick::MostCorners];
    if (!this->See(cell, count, seen))
    {
      return;
    }
    std::uint8_t tetrahedra[bricks::MostTetrahedra][4];
    const int parts = SplitCell(this->Brick, cell, tetrahedra);
    const TriangleRay& ray = this->Ray.Triangles;
    for (int part = 0; part < parts; ++part)
    {
      const std::uint8_t* const at = tetrahedra[part];
      TetrahedronCrossing crossing;
      if (this->MayHold(cell, at) &&
        crossing.Find(ray, seen[at[0]], seen[at[1]], seen[at[2]], seen[at[3]]) &&
        crossing.Exit >= ray.Min && crossing.Enter <= ray.Max)
      {
        const std::uint16_t corners[4] = { cell[at[0]], cell[at[1]], cell[at[2]], cell[at[3]] };
        visit(crossing, corners);
      }
    }
  }

  bool MayHold(const std::uint16_t* cell, const std::uint8_t* corners) const
  {
    const float a = this->Numbers[cell[corners[0]]];
    const float b = this->Numbers[cell[corners[1]]];
    const float c = this->Numbers[cell[corners[2]]];
    const float d = this->Numbers[cell[corners[3]]];
    return this->Wanted.MayHold(
      std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d)));
  }

  /// False where all corners are on one side of the ray.
  bool See(const std::uint16_t* cell, int count, SeenPoint* seen) const
  {
    double lowest[2] = { std::numeric_limits<double>::infinity(),
      std::numeric_limits<double>::infinity() };
    double highest[2] = { -lowest[0], -lowest[1] };
    for (int corner = 0; corner < count; ++corner)
    {
      SeenPoint& point = seen[corner];
      point.Set(
        this->Ray.Triangles, this->Brick.GetPoint(cell[corner]), this->Numbers[cell[corner]]);
      lowest[0] = std::min(lowest[0], point.X);
      lowest[1] = std::min(lowest[1], point.Y);
      highest[0] = std::max(highest[0], point.X);
      highest[1] = std::max(highest[1], point.Y);
    }
    return lowest[0] <= 0.0 && lowest[1] <= 0.0 && highest[0] >= 0.0 && highest[1] >= 0.0;
  }

  const bricks::CellBrick& Brick;
  const bricks::CellBrick::Node* Nodes;
  const bricks::CellValueBrick& Values;
  const float* Numbers;
  const ShearedRay& Ray;
  const Filter& Wanted;
};

/// A ray in the space of a field's bricks. Returns false where it meets none.
inline bool SetRay(const CellField& field, const Ray& ray, ShearedRay& there)
{
  const bricks::CellBricks& cells = *field.Voxels->Cells;
  const glm::dvec3 origin = field.ToIndex(ray.Origin);
  const glm::dvec3 direction = glm::dmat3(field.WorldToIndex) * ray.Direction;
  return !field.Voxels->Hierarchy.IsEmpty() &&
    there.Set(&origin.x, &direction.x, ray.Min, ray.Max, &cells.Lower.x, &cells.Upper.x);
}

/// Looks by a predicate for ranges of values (ValuePredicates.h), which is kept by reference.
template <class Predicate>
class PredicateFilter
{
public:
  PredicateFilter(const bricks::CellValueHeader& header, const Predicate& mayHold)
    : First(header.First)
    , Step(header.Step)
    , Predicates(mayHold)
  {
  }

  unsigned FindChildren(const std::uint8_t* ranges) const
  {
    unsigned found = 0;
    for (int child = 0; child < bricks::WideBvhWidth; ++child)
    {
      const std::uint8_t low = ranges[child];
      const std::uint8_t high = ranges[bricks::WideBvhWidth + child];
      found |=
        static_cast<unsigned>(low <= high &&
          this->Predicates(bricks::ValueRange{ this->First + this->Step * static_cast<float>(low),
            this->First + this->Step * static_cast<float>(high) }))
        << child;
    }
    return found;
  }
  bool MayHold(float first, float last) const
  {
    return this->Predicates(bricks::ValueRange{ first, last });
  }

private:
  float First;
  float Step;
  const Predicate& Predicates;
};

/// Looks for any value.
class AnyFilter
{
public:
  static unsigned FindChildren(const std::uint8_t* ranges)
  {
    unsigned found = 0;
    for (int child = 0; child < bricks::WideBvhWidth; ++child)
    {
      found |= static_cast<unsigned>(ranges[child] <= ranges[bricks::WideBvhWidth + child])
        << child;
    }
    return found;
  }
  static bool MayHold(float, float) { return true; }
};

} // namespace rt

#endif
