// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelIntegrals_h
#define rt_VoxelIntegrals_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/grid/BrickCells.h"
#include "DSMRayTracing/field/grid/StretchedRay.h"
#include "DSMRayTracing/field/grid/TrilinearCell.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/VoxelSearch.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayIntegrals.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace rt
{

/// Integrates the values of a field along rays, where cells hold data. It is exact but for rounding: in a cell, the
/// values along a ray are a cubic. Ray by ray, since the frame's time is not what matters here.
template <class FieldType, class Store>
class VoxelIntegrals : public VoxelSearch<FieldType, Store>
{
public:
  using VoxelSearch<FieldType, Store>::VoxelSearch;

  /// See BeamFinder.
  static std::unique_ptr<ObjectBeam> FindBeam(const FieldType& field, const Ray corners[4])
  {
    return VoxelIntegrals::FindBricks(field, HasValues(), corners);
  }

  /// Adds the integrals along those of the rays that are `wanted`, in [ray.Min, ray.Max].
  void Add(const FieldType& field, ObjectBeam* beam, const Ray* rays, RayMask wanted,
    RayIntegrals& integrals) const
  {
    ForEachPacket(field, HasValues(), this->Kernel, static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, auto& packets)
      {
        this->AddPacket(field, bricks, packets, integrals);
        return RayMask{ 0 };
      });
  }

private:
  struct HasValues
  {
    bool operator()(const bricks::ValueRange& range) const { return range.First <= range.Last; }
  };

  /// `packets`: LatticePackets or LevelPackets.
  template <class Packets>
  void AddPacket(
    const FieldType& field, BeamBricks& bricks, Packets& packets, RayIntegrals& integrals) const
  {
    VoxelIntegrals::Dispatch(field,
      [&](auto sample)
      {
        // A ray's sum depends on the order of its bricks.
        for (const std::size_t place : packets.GetOrder(bricks))
        {
          const BeamBricks::Brick& brick = bricks.Bricks[place];
          RayPacket& packet = packets.Get(brick.Id);
          const RayMask meets =
            this->Kernel.MeetBrick(packet, packet.Rays, brick.Lower, brick.Upper);
          if (meets == 0)
          {
            continue;
          }
          bricks.Reached = std::max(bricks.Reached, place + 1);
          const typename Store::Pin pin =
            this->Blocks.Acquire(this->Self, *field.Voxels->Segment, brick.Id);
          const bricks::VoxelBrick<decltype(sample)> voxels(pin.GetData());
          ForEachRay(
            meets, [&](int ray) { AddBrick(packet, ray, voxels, brick.Lower, integrals); });
        }
      });
  }

  template <class T>
  static void AddBrick(const RayPacket& packet, int ray, const bricks::VoxelBrick<T>& voxels,
    const double lower[3], RayIntegrals& integrals)
  {
    const auto add = [&](auto line)
    {
      const double origin[3] = { packet.Origin[0][ray], packet.Origin[1][ray],
        packet.Origin[2][ray] };
      const double direction[3] = { packet.Direction[0][ray], packet.Direction[1][ray],
        packet.Direction[2][ray] };
      if (line.Set(origin, direction))
      {
        AddCells(
          BrickCells<T, decltype(line)>(line, voxels, Lanes(lower[0], lower[1], lower[2], 0.0)),
          packet.BrickEnter[ray], packet.BrickLeave[ray], ray, integrals);
      }
    };
    if (packet.Planes)
    {
      add(StretchedRay(*packet.Planes));
    }
    else
    {
      add(GridRay());
    }
  }

  template <class T, class Line>
  static void AddCells(
    const BrickCells<T, Line>& cells, double enter, double leave, int ray, RayIntegrals& integrals)
  {
    cells.VisitCells(
      enter, leave, leave,
      [](const bricks::MacrocellRange<T>& range) { return range.Min <= range.Max; },
      [&](const GridWalk& walk, const T* corner, double in, double out)
      {
        const Lanes cell = cells.GetCell(walk);
        double corners[8];
        if (cells.IsCovered(cell) && GetCorners(cells.GetBrick(), corner, corners))
        {
          const Lanes start = cells.GetLocal(cell, in);
          const Cubic values = GetCubic(corners, start, cells.GetLocal(cell, out) - start);
          integrals.Add(ray, in, out, values.GetMean());
        }
        return false;
      });
  }

  /// Returns whether all are numbers.
  template <class T>
  static bool GetCorners(const bricks::VoxelBrick<T>& voxels, const T* corner, double corners[8])
  {
    double check = 0.0;
    for (int number = 0; number < 8; ++number)
    {
      corners[number] =
        static_cast<double>(corner[voxels.GetOffset(number & 1, number >> 1 & 1, number >> 2)]);
      check += corners[number] * 0.0; // not a number where a corner is not finite
    }
    return std::is_integral_v<T> || check == 0.0;
  }
};

} // namespace rt

#endif
