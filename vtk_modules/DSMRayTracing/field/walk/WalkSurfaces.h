// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkSurfaces_h
#define rt_WalkSurfaces_h

#include "DSMRayTracing/field/IsosurfaceHit.h"
#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/walk/WalkSearch.h"
#include "DSMRayTracing/look/SheetTransmittance.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace rt
{

/// Finds the isosurfaces of a field by its Walk and Sampler; see LatticeSurfaces.
template <class FieldType, class Store>
class WalkSurfaces : public WalkSearch<FieldType, Store>
{
public:
  using Sets = LevelSets<FieldType>;
  using Hit = IsosurfaceHit<typename FieldType::Place>;

  WalkSurfaces(Store& store, typename Store::Worker& worker)
    : WalkSearch<FieldType, Store>(store, worker)
    , Values(store, worker)
  {
  }

  template <class Open>
  RayMask Intersect(
    const Sets& sets, ObjectBeam*, const Ray* rays, RayMask wanted, const Open& open) const
  {
    Hit* hits[MaxRays];
    std::vector<int> opened;
    std::vector<glm::dvec3> points;
    const RayMask found = FindRays(wanted,
      [&](int index)
      {
        const Ray ray = rays[index]; // `open` may end it
        Hit nearest;
        if (!this->FindSegment(sets, ray,
              [&](const Segment& segment) { return FindFirst(sets.Isovalues, segment, nearest); }))
        {
          return false;
        }
        hits[index] = open(index, nearest.T);
        if (hits[index])
        {
          opened.push_back(index);
          points.push_back(ray.Origin + nearest.T * ray.Direction);
          sets.Field.MovePlace(points.back(), nearest.At);
          *hits[index] = nearest;
        }
        return true;
      });
    std::vector<glm::dvec3> gradients(points.size(), glm::dvec3(0.0));
    this->Values.FindSmoothGradients(sets.Field, points, gradients);
    for (std::size_t number = 0; number < opened.size(); ++number)
    {
      const int index = opened[number];
      hits[index]->Normal = sets.Field.GetNormal(gradients[number], rays[index].Direction);
    }
    return found;
  }

  RayMask FindOccluded(const Sets& sets, const Ray* rays, RayMask wanted) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        return this->FindSegment(sets, rays[index],
          [&](const Segment& segment)
          {
            bool isCrossed = false;
            ForEachIsovalue(sets.Isovalues, segment,
              [&](std::size_t, const Cubic& cubic, double last)
              { isCrossed = isCrossed || HasCrossing(cubic, last); });
            return isCrossed;
          });
      });
  }

  RayMask Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray* rays,
    RayMask wanted, glm::dvec3* transmittances) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        return this->FindSegment(sets, rays[index],
          [&](const Segment& segment)
          {
            bool isDark = false;
            ForEachIsovalue(sets.Isovalues, segment,
              [&](std::size_t number, const Cubic& cubic, double last)
              {
                const int crossings = CountCrossings(cubic, last);
                isDark = PassSheet(sheets[number], crossings, transmittances[index]);
              });
            return isDark;
          });
      });
  }

private:
  using typename WalkSearch<FieldType, Store>::Segment;

  template <class Visit>
  bool FindSegment(const Sets& sets, const Ray& ray, const Visit& visit) const
  {
    return this->Way.Find(sets.Field, ray, IsovaluePredicate(sets.Isovalues), visit);
  }

  /// Calls `visit(number, cubic, last)` for the isovalues that may be within a segment, with how far its values are
  /// above.
  template <class Visit>
  static void ForEachIsovalue(
    const std::vector<double>& isovalues, const Segment& segment, const Visit& visit)
  {
    for (std::size_t number = 0; number < isovalues.size(); ++number)
    {
      if (segment.Range.MayHold(isovalues[number]))
      {
        Cubic above = segment.Values;
        above.Coefficients[0] -= isovalues[number];
        visit(number, above, segment.Last - isovalues[number]);
      }
    }
  }

  /// Finds the first crossing of any isovalue; of equally near ones, that of the lowest.
  static bool FindFirst(const std::vector<double>& isovalues, const Segment& segment, Hit& first)
  {
    double nearest = 2.0;
    ForEachIsovalue(isovalues, segment,
      [&](std::size_t number, const Cubic& cubic, double last)
      {
        double part;
        if (FindFirstCrossing(cubic, last, part) && part < nearest)
        {
          nearest = part;
          first.T = segment.GetT(part);
          first.Isovalue = static_cast<int>(number);
          first.FromInside = cubic.Coefficients[0] >= 0.0;
          first.At = segment.At;
        }
      });
    return nearest <= 1.0;
  }

  typename FieldType::template Sampler<Store> Values;
};

} // namespace rt

#endif
