// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellSurfaces_h
#define rt_CellSurfaces_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMRayTracing/field/IsosurfaceHit.h"
#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/tetrahedra/CellCrossings.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/CellSampler.h"
#include "DSMRayTracing/look/SheetTransmittance.h"
#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/ray/ChildrenInRange.h"
#include "DSMRayTracing/ray/ChildrenOnRay.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/ShearedRay.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rt
{

/// Looks for isovalues, which are ascending, in the values of a brick.
class IsovalueFilter
{
public:
  IsovalueFilter(const bricks::CellValueHeader& header, const std::vector<double>& isovalues)
    : Isovalues(isovalues.data())
    , Count(isovalues.size())
    , Lowest(isovalues.front())
    , Highest(isovalues.back())
  {
    // Bounds of the bytes of ranges that may hold an isovalue between the lowest and the highest.
    const auto get = [&](int byte)
    { return static_cast<double>(header.First + header.Step * static_cast<float>(byte)); };
    const double steps = header.Step > 0.0f ? 1.0 / static_cast<double>(header.Step) : 0.0;
    const auto find = [&](double isovalue)
    {
      return static_cast<int>(
        std::clamp((isovalue - static_cast<double>(header.First)) * steps, -1.0, 256.0));
    };
    int low = std::min(find(this->Highest) + 2, 255);
    while (low >= 0 && !(get(low) < this->Highest))
    {
      --low;
    }
    int high = std::max(find(this->Lowest) - 2, 0);
    while (high <= 255 && !(this->Lowest <= get(high)))
    {
      ++high;
    }
    this->LowMost = low;
    this->HighLeast = high;
  }

  unsigned FindChildren(const std::uint8_t* ranges) const
  {
    unsigned found = 0;
    for (int child = 0; child < bricks::WideBvhWidth; ++child)
    {
      const bool may =
        ranges[child] <= this->LowMost && ranges[bricks::WideBvhWidth + child] >= this->HighLeast;
      found |= static_cast<unsigned>(may) << child;
    }
    return found;
  }
  bool MayHold(float first, float last) const
  {
    if (!(static_cast<double>(first) < this->Highest && this->Lowest <= static_cast<double>(last)))
    {
      return false;
    }
    return this->Count == 1 ||
      std::any_of(this->Isovalues, this->Isovalues + this->Count,
        [&](double isovalue) {
          return bricks::ValueRange{ first, last }.MayHold(isovalue);
        });
  }

private:
  const double* Isovalues;
  std::size_t Count;
  double Lowest;
  double Highest;
  int LowMost = -1;
  int HighLeast = 256;
};

/// Finds the isosurfaces of a CellField: planes in tetrahedra. See LatticeSurfaces for what it has to do.
template <class Store>
class CellSurfaces
{
public:
  using Sets = LevelSets<CellField>;
  using Hit = IsosurfaceHit<CellPlace>;

  CellSurfaces(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
    , Values(store, worker)
  {
  }

  ///@{
  /// Bricks are not foreseen.
  template <class... Searched>
  std::unique_ptr<ObjectBeam> FindBeam(const Searched&...) const
  {
    return nullptr;
  }
  template <class Searched>
  bool Prefetch(const Searched&, const ObjectBeam&, std::size_t) const
  {
    return false;
  }
  ///@}

  template <class Open>
  RayMask Intersect(
    const Sets& sets, ObjectBeam*, const Ray* rays, RayMask wanted, const Open& open) const
  {
    Hit* hits[MaxRays];
    CellPlace places[MaxRays] = {};
    RayMask opened = 0;
    const RayMask found = FindRays(wanted,
      [&](int index)
      {
        const Ray ray = rays[index]; // `open` may end it
        Hit nearest;
        if (!this->FindNearest(sets, ray, nearest))
        {
          return false;
        }
        hits[index] = open(index, nearest.T);
        if (hits[index])
        {
          opened |= GetBit(index);
          sets.Field.MovePlace(ray.Origin + nearest.T * ray.Direction, nearest.At);
          places[index] = nearest.At;
          *hits[index] = nearest;
        }
        return true;
      });
    glm::dvec3 gradients[MaxRays];
    this->Values.FindGradients(sets.Field.GetValues(), places, opened, gradients);
    ForEachRay(opened,
      [&](int index)
      { hits[index]->Normal = sets.Field.GetNormal(gradients[index], rays[index].Direction); });
    return found;
  }

  RayMask FindOccluded(const Sets& sets, const Ray* rays, RayMask wanted) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        bool isMet = false;
        this->ForEachRoot(sets, rays[index],
          [&](ShearedRay& ray, double, std::size_t, bool, std::uint32_t, const std::uint16_t*)
          {
            isMet = true;
            ray.End();
          });
        return isMet;
      });
  }

  RayMask Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray* rays,
    RayMask wanted, glm::dvec3* transmittances) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        bool isDark = false;
        this->ForEachRoot(sets, rays[index],
          [&](ShearedRay& ray, double, std::size_t isovalue, bool, std::uint32_t,
            const std::uint16_t*)
          {
            isDark = isDark || PassSheet(sheets[isovalue], 1, transmittances[index]);
            if (isDark)
            {
              ray.End();
            }
          });
        return isDark;
      });
  }

private:
  bool FindNearest(const Sets& sets, const Ray& ray, Hit& nearest) const
  {
    bool isFound = false;
    this->ForEachRoot(sets, ray,
      [&](ShearedRay& there, double t, std::size_t isovalue, bool fromInside, std::uint32_t brick,
        const std::uint16_t* corners)
      {
        if (isFound && !(t < nearest.T))
        {
          return;
        }
        isFound = true;
        nearest.T = t;
        nearest.Isovalue = static_cast<int>(isovalue);
        nearest.FromInside = fromInside;
        nearest.At.Brick = brick;
        std::copy_n(corners, 4, nearest.At.Corners);
        there.Shorten(t);
      });
    return isFound;
  }

  /// Calls `visit(ray, t, isovalue, fromInside, brick, corners)` for the crossings of isovalues on the ray, nearer bricks
  /// and cells first, but in no strict order. It may shorten the ray.
  template <class Visit>
  void ForEachRoot(const Sets& sets, const Ray& ray, const Visit& visit) const
  {
    ShearedRay there;
    if (sets.Isovalues.empty() || !SetRay(sets.Field, ray, there))
    {
      return;
    }
    const bricks::CellValues& values = *sets.Field.Voxels;
    const IsovaluePredicate mayHold(sets.Isovalues);
    const ChildrenInRange wanted(ChildrenOnRay(there.Boxes, there.BoxesEnd), mayHold);
    TraverseWideBvh(values.Hierarchy.GetNodes(), wanted,
      [&](std::uint32_t leaf)
      {
        const std::uint32_t brick = bricks::RangedBrickBvh::GetBrick(leaf);
        const auto pins = this->Blocks.AcquirePair(
          this->Self, *values.Cells->Segment, brick, *values.Segment, brick);
        const bricks::CellBrick cells(pins.first.GetData());
        const bricks::CellValueBrick numbers(pins.second.GetData());
        const IsovalueFilter filter(numbers.GetHeader(), sets.Isovalues);
        BrickCrossings(cells, numbers, there, filter)
          .ForEach(
            [&](const TetrahedronCrossing& crossing, const std::uint16_t* corners)
            {
              VisitRoots(sets.Isovalues, crossing, there.Triangles,
                [&](double t, std::size_t isovalue, bool fromInside)
                { visit(there, t, isovalue, fromInside, brick, corners); });
            });
      });
  }

  /// Calls `visit(t, isovalue, fromInside)` for the isovalues that are crossed within the ray.
  template <class Visit>
  static void VisitRoots(const std::vector<double>& isovalues, const TetrahedronCrossing& crossing,
    const TriangleRay& ray, const Visit& visit)
  {
    for (std::size_t number = 0; number < isovalues.size(); ++number)
    {
      const bool isInside = crossing.First >= isovalues[number];
      if (isInside != (crossing.Last >= isovalues[number]))
      {
        const double part = (isovalues[number] - crossing.First) / (crossing.Last - crossing.First);
        const double t = std::clamp(
          crossing.Enter + part * (crossing.Exit - crossing.Enter), crossing.Enter, crossing.Exit);
        if (t >= ray.Min && t <= ray.Max)
        {
          visit(t, number, isInside);
        }
      }
    }
  }

  Store& Blocks;
  typename Store::Worker& Self;
  CellSampler<Store> Values;
};

} // namespace rt

#endif
