// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/LatticeSections.h"

#include "DSMRayTracing/field/lattice/LatticeField.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace rt
{

namespace
{

/// A plane that rises by no more than this in a cell is taken for one along the axes.
constexpr double Flat = 1e-12;
/// Cells, over the lattice's size: a plane that is this near to samples goes through them, so that values of cells and
/// masks do not depend on the rounding of a ray's place.
constexpr double NearSamples = 1e-9;
/// Cells, over the coordinates: room for the rounding of where rays meet a plane.
constexpr double Rounding = 1e-6;

double GetSlope(const SectionPlane& plane, const Ray& ray)
{
  return glm::dot(plane.Normal, ray.Direction);
}

/// The same operations as in ClipRegion, so that a plane in the border of a region is met there.
double GetT(const SectionPlane& plane, const Ray& ray, double slope)
{
  return -glm::dot(plane.Normal, ray.Origin - plane.Point) / slope;
}

} // namespace

LatticeSections::LatticeSections(const LatticeField& field, const std::vector<SectionPlane>& planes)
  : Voxels(*field.Voxels)
  , Planes(planes)
  , Space(field.GetIndexSpace())
{
  const glm::dvec3 size(this->Voxels.Lattice.GetCells());
  for (const SectionPlane& plane : planes)
  {
    IndexPlane indexed{ plane.Normal * glm::dmat3(field.IndexToWorld),
      glm::dot(plane.Normal, plane.Point - this->Space.GetOrigin()), 0, false, 0.0 };
    const glm::dvec3 steepness = glm::abs(indexed.Normal);
    for (const int axis : { 1, 2 })
    {
      indexed.Steepest = steepness[axis] > steepness[indexed.Steepest] ? axis : indexed.Steepest;
    }
    const int axis = indexed.Steepest;
    indexed.Offset /= steepness[axis];
    indexed.Normal /= steepness[axis];
    indexed.IsAlongAxes = std::abs(indexed.Normal[(axis + 1) % 3]) < Flat &&
      std::abs(indexed.Normal[(axis + 2) % 3]) < Flat;
    indexed.Coordinate = indexed.Offset / indexed.Normal[axis];
    const double place = indexed.Coordinate;
    if (place >= 0.0 && place <= size[axis])
    {
      indexed.Coordinate = this->ToIndex(axis, place);
    }
    const double nearest = std::round(indexed.Coordinate);
    if (std::abs(place - this->ToPlace(axis, nearest)) < NearSamples * size[axis])
    {
      indexed.Coordinate = nearest;
    }
    this->IndexPlanes.push_back(indexed);
  }
}

bool LatticeSections::FindPlace(
  const Line& line, double t, const IndexPlane& plane, LatticePlace& place) const
{
  const bricks::BrickLattice& lattice = this->Voxels.Lattice;
  const bricks::Index3 cells = lattice.GetCells();
  const Lanes point = line.GetPoint(t);
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool isKnown = plane.IsAlongAxes && axis == plane.Steepest;
    const double coordinate = isKnown ? plane.Coordinate : point[axis];
    if (!(coordinate >= 0.0 && coordinate <= static_cast<double>(cells[axis])))
    {
      return false;
    }
    const double index = isKnown ? coordinate : this->ToIndex(axis, coordinate);
    place.IndexPoint[axis] = index;
    place.Cell[axis] =
      static_cast<int>(std::min(static_cast<std::int64_t>(index), cells[axis] - 1));
  }
  place.Brick = lattice.GetId(place.GetCell() / bricks::Index3(lattice.GetEdge()));
  return !this->Voxels.Hole.Has(place.GetCell());
}

bool LatticeSections::FindNext(const Ray& ray, const Line& line, Hit& hit) const
{
  const Hit last = hit;
  bool found = false;
  for (std::size_t number = 0; number < this->Planes.size(); ++number)
  {
    const double slope = GetSlope(this->Planes[number], ray);
    const double t = GetT(this->Planes[number], ray, slope);
    const auto index = static_cast<int>(number);
    const bool isBehind = last.Plane < 0 || t > last.T || (t == last.T && index > last.Plane);
    // Not where the ray lies in the plane, and T is not a number.
    if (!(t >= ray.Min && t <= ray.Max) || !isBehind || (found && t >= hit.T))
    {
      continue;
    }
    LatticePlace place;
    if (this->FindPlace(line, t, this->IndexPlanes[number], place))
    {
      hit = { t, index, place };
      found = true;
    }
  }
  return found;
}

SectionBeam LatticeSections::FindBeam(const Ray corners[4]) const
{
  struct Section
  {
    double Distance;
    const IndexPlane* Plane;
    Box Bounds;
  };
  SectionBeam beam;
  beam.Usable = true;
  beam.IsKnown = true;
  std::vector<Section> sections;
  for (std::size_t number = 0; number < this->Planes.size(); ++number)
  {
    const SectionPlane& plane = this->Planes[number];
    Section section{ 0.0, &this->IndexPlanes[number],
      { glm::dvec3(std::numeric_limits<double>::infinity()),
        glm::dvec3(-std::numeric_limits<double>::infinity()) } };
    int forward = 0; // corners that look to the normal's side
    int ahead = 0;   // those that have the plane before them
    bool isFinite = true;
    for (int corner = 0; corner < 4; ++corner)
    {
      const Ray& ray = corners[corner];
      const double slope = GetSlope(plane, ray);
      const double t = GetT(plane, ray, slope);
      forward += slope > 0.0 ? 1 : 0;
      ahead += t >= 0.0 ? 1 : 0;
      const glm::dvec3 place =
        this->Space.GetWorldToIndex() * (ray.Origin - this->Space.GetOrigin() + t * ray.Direction);
      const glm::dvec3 room = Rounding * (1.0 + glm::abs(place));
      isFinite = isFinite && std::isfinite(t + place.x + place.y + place.z);
      section.Distance += t;
      section.Bounds.Lower = glm::min(section.Bounds.Lower, place - room);
      section.Bounds.Upper = glm::max(section.Bounds.Upper, place + room);
    }
    // If all corner rays approach the plane from the same side, the rays between them meet it
    // between the corners. If all move away from it, none of them meets it.
    if (!isFinite || forward % 4 != 0 || ahead % 4 != 0)
    {
      beam.IsKnown = false;
    }
    else if (ahead == 4)
    {
      sections.push_back(section);
    }
  }
  std::stable_sort(sections.begin(), sections.end(),
    [](const Section& a, const Section& b) { return a.Distance < b.Distance; });
  for (const Section& section : sections)
  {
    this->AddBricks(*section.Plane, section.Bounds, beam.Bricks);
  }
  return beam;
}

/// Those that the plane passes through in a box.
void LatticeSections::AddBricks(
  const IndexPlane& plane, const Box& box, std::vector<dsm::BlockId>& bricks) const
{
  const bricks::BrickLattice& lattice = this->Voxels.Lattice;
  const glm::dvec3 size(lattice.GetCells());
  const double edge = lattice.GetEdge();
  glm::dvec3 lower = glm::max(box.Lower, glm::dvec3(0.0));
  glm::dvec3 upper = glm::min(box.Upper, size);
  const int steepest = plane.Steepest;
  if (plane.IsAlongAxes)
  {
    const double place = plane.Coordinate >= 0.0 && plane.Coordinate <= size[steepest]
      ? this->ToPlace(steepest, plane.Coordinate)
      : plane.Coordinate;
    lower[steepest] = std::max(place, 0.0);
    upper[steepest] = std::min(place, size[steepest]);
  }
  if (lower.x > upper.x || lower.y > upper.y || lower.z > upper.z)
  {
    return;
  }
  const auto getBrick = [&](double coordinate, int axis)
  {
    return std::min(static_cast<std::int64_t>(this->ToIndex(axis, coordinate) / edge),
      lattice.GetBricks()[axis] - 1);
  };
  const int first = (steepest + 1) % 3;
  const int second = (steepest + 2) % 3;
  bricks::Index3 brick;
  for (brick[second] = getBrick(lower[second], second);
       brick[second] <= getBrick(upper[second], second); ++brick[second])
  {
    for (brick[first] = getBrick(lower[first], first);
         brick[first] <= getBrick(upper[first], first); ++brick[first])
    {
      double low = lower[steepest];
      double high = upper[steepest];
      if (!plane.IsAlongAxes)
      {
        // How far the plane rises over the column of bricks.
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (int corner = 0; corner < 4; ++corner)
        {
          const auto get = [&](int axis, bool isUpper)
          {
            const double end =
              this->ToPlace(axis, edge * static_cast<double>(brick[axis] + (isUpper ? 1 : 0)));
            return std::clamp(end, lower[axis], upper[axis]);
          };
          const double height = (plane.Offset - plane.Normal[first] * get(first, corner & 1) -
                                  plane.Normal[second] * get(second, corner >> 1)) /
            plane.Normal[steepest];
          least = std::min(least, height);
          most = std::max(most, height);
        }
        low = std::max(low, least - Rounding * (1.0 + std::abs(least)));
        high = std::min(high, most + Rounding * (1.0 + std::abs(most)));
      }
      if (!(low <= high))
      {
        continue;
      }
      for (brick[steepest] = getBrick(low, steepest); brick[steepest] <= getBrick(high, steepest);
           ++brick[steepest])
      {
        bricks.push_back(lattice.GetId(brick));
      }
    }
  }
}

} // namespace rt
