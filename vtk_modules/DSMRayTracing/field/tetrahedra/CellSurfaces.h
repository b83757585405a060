// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellSurfaces_h
#define rt_CellSurfaces_h

#include "DSMBricks/cells/CellBrick.h"
#include "DSMRayTracing/field/IsosurfaceHit.h"
#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/tetrahedra/CellCrossings.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/field/tetrahedra/CellSampler.h"
#include "DSMRayTracing/look/SheetTransmittance.h"
#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

namespace rt
{

/// Looks for isovalues, which are ascending, in the values of a brick.
class IsovalueFilter
{
public:
  static constexpr bool HoldsAny = false;

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

  CellSurfaces(
    Store& store, typename Store::Worker& worker, const CellKernel& kernel = CellKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
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
    Nearest nearest[MaxRays];
    const RayMask found = this->FindNearest(sets, rays, wanted, nearest);
    Hit* hits[MaxRays];
    CellPlace places[MaxRays] = {};
    const RayMask opened = FindRays(found,
      [&](int index)
      {
        const glm::dvec3 origin = rays[index].Origin; // `open` may end the ray
        const glm::dvec3 direction = rays[index].Direction;
        Hit& hit = nearest[index].At;
        hits[index] = open(index, hit.T);
        if (hits[index] == nullptr)
        {
          return false;
        }
        sets.Field.MovePlace(origin + hit.T * direction, hit.At);
        places[index] = hit.At;
        *hits[index] = hit;
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
    RayMask met = 0;
    this->ForEachRoot(sets, rays, wanted,
      [&](CellPacket& packet, const Root& root)
      {
        met |= GetBit(packet.Rays[root.Lane]);
        packet.End(root.Lane);
      });
    return met;
  }

  RayMask Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray* rays,
    RayMask wanted, glm::dvec3* transmittances) const
  {
    // The product does not depend on the order in which surfaces are met.
    std::vector<std::array<int, MaxRays>> crossings(sheets.size());
    glm::dvec3 left[MaxRays];
    ForEachRay(wanted, [&](int ray) { left[ray] = transmittances[ray]; });
    this->ForEachRoot(sets, rays, wanted,
      [&](CellPacket& packet, const Root& root)
      {
        const int ray = packet.Rays[root.Lane];
        ++crossings[root.Isovalue][static_cast<std::size_t>(ray)];
        if (PassSheet(sheets[root.Isovalue], 1, left[ray]))
        {
          packet.End(root.Lane);
        }
      });
    return FindRays(wanted,
      [&](int ray)
      {
        bool isDark = false;
        for (std::size_t sheet = 0; sheet < sheets.size(); ++sheet)
        {
          const int count = crossings[sheet][static_cast<std::size_t>(ray)];
          isDark = PassSheet(sheets[sheet], count, transmittances[ray]);
        }
        return isDark;
      });
  }

private:
  /// Where a ray crosses an isosurface in a tetrahedron.
  struct Root
  {
    int Lane; ///< of the packet
    double T;
    std::size_t Isovalue;
    bool FromInside;
    std::uint32_t Brick;
    const std::uint16_t* Corners;
    const bricks::CellBrick& Cells;
  };

  /// The nearest root so far. Several at the same T are told apart, in whatever order they are met.
  struct Nearest
  {
    Hit At;
    double Place[3]; ///< sums over the corners of the tetrahedron

    void Set(const Root& root, const double place[3])
    {
      this->At.T = root.T;
      this->At.Isovalue = static_cast<int>(root.Isovalue);
      this->At.FromInside = root.FromInside;
      this->At.At.Brick = root.Brick;
      std::copy_n(root.Corners, 4, this->At.At.Corners);
      std::copy_n(place, 3, this->Place);
    }
    bool IsBehind(const Root& root, const double place[3]) const
    {
      const int isovalue = static_cast<int>(root.Isovalue);
      return std::tie(root.T, isovalue, root.FromInside, place[0], place[1], place[2]) <
        std::tie(this->At.T, this->At.Isovalue, this->At.FromInside, this->Place[0], this->Place[1],
          this->Place[2]);
    }
  };

  RayMask FindNearest(const Sets& sets, const Ray* rays, RayMask wanted, Nearest* nearest) const
  {
    RayMask found = 0;
    this->ForEachRoot(sets, rays, wanted,
      [&](CellPacket& packet, const Root& root)
      {
        const int ray = packet.Rays[root.Lane];
        const RayMask bit = GetBit(ray);
        double place[3] = {};
        for (int corner = 0; corner < 4; ++corner)
        {
          float point[3];
          root.Cells.GetPoint(root.Corners[corner], point);
          for (int axis = 0; axis < 3; ++axis)
          {
            place[axis] += static_cast<double>(point[axis]);
          }
        }
        if ((found & bit) == 0 || nearest[ray].IsBehind(root, place))
        {
          found |= bit;
          nearest[ray].Set(root, place);
          packet.Shorten(root.Lane, root.T);
        }
      });
    return found;
  }

  /// Calls `visit(packet, root)` for the crossings of isovalues on rays, nearer bricks and cells first, but in no
  /// strict order. It may shorten the packet's rays.
  template <class Visit>
  void ForEachRoot(const Sets& sets, const Ray* rays, RayMask wanted, const Visit& visit) const
  {
    if (sets.Isovalues.empty())
    {
      return;
    }
    const bricks::CellValues& values = *sets.Field.Voxels;
    const IsovaluePredicate mayHold(sets.Isovalues);
    ForEachPacket(sets.Field, rays, wanted,
      [&](CellPacket& packet)
      {
        ForEachBrick(this->Kernel, packet, values.Hierarchy, mayHold,
          [&](std::uint32_t brick, RayMask lanes, float)
          { this->SearchBrick(sets, brick, packet, lanes, visit); });
      });
  }

  template <class Visit>
  void SearchBrick(const Sets& sets, std::uint32_t brick, CellPacket& packet, RayMask lanes,
    const Visit& visit) const
  {
    const bricks::CellValues& values = *sets.Field.Voxels;
    const auto pins =
      this->Blocks.AcquirePair(this->Self, *values.Cells->Segment, brick, *values.Segment, brick);
    const bricks::CellBrick cells(pins.first.GetData());
    const bricks::CellValueBrick numbers(pins.second.GetData());
    const IsovalueFilter filter(numbers.GetHeader(), sets.Isovalues);
    BrickCrossings(this->Kernel, packet, cells, numbers, filter)
      .ForEach(lanes,
        [&](const CellKernel::Crossing& crossing, const std::uint16_t* corners)
        {
          const int lane = crossing.Lane;
          VisitRoots(sets.Isovalues, crossing,
            [&](double t, std::size_t isovalue, bool fromInside)
            {
              if (t >= packet.Lanes[lane].Min && t <= packet.Lanes[lane].Max && packet.IsOpen(lane))
              {
                visit(packet, Root{ lane, t, isovalue, fromInside, brick, corners, cells });
              }
            });
        });
  }

  /// Calls `visit(t, isovalue, fromInside)` for the isovalues that are crossed.
  template <class Visit>
  static void VisitRoots(
    const std::vector<double>& isovalues, const CellKernel::Crossing& crossing, const Visit& visit)
  {
    for (std::size_t number = 0; number < isovalues.size(); ++number)
    {
      const bool isInside = crossing.First >= isovalues[number];
      if (isInside != (crossing.Last >= isovalues[number]))
      {
        const double part = (isovalues[number] - crossing.First) / (crossing.Last - crossing.First);
        const double t = std::clamp(
          crossing.Enter + part * (crossing.Exit - crossing.Enter), crossing.Enter, crossing.Exit);
        visit(t, number, isInside);
      }
    }
  }

  Store& Blocks;
  typename Store::Worker& Self;
  const CellKernel& Kernel;
  CellSampler<Store> Values;
};

} // namespace rt

#endif
