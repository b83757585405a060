// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VolumeTracer_txx
#define rt_VolumeTracer_txx

#include "DSMRayTracing/brick/VoxelBrick.h"
#include "DSMRayTracing/kernel/BrickWalk.h"
#include "DSMRayTracing/kernel/CellNeighbourhood.h"
#include "DSMRayTracing/kernel/GridTraversal.h"
#include "DSMRayTracing/kernel/IndexSpace.h"
#include "DSMRayTracing/kernel/IsovalueLevel.h"
#include "DSMRayTracing/kernel/TrilinearCell.h"
#include "DSMRayTracing/kernel/TypedPacketBrick.h"

#include <cmath>
#include <limits>

namespace rt
{

template <class Store>
bool VolumeTracer<Store>::Intersect(
  const IsosurfaceObject& object, const Ray& ray, SurfaceHit& hit) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  const BrickLattice& lattice = object.Field->Lattice;
  GridRay line;
  double enter = ray.Min;
  double leave = ray.Max;
  if (!space.GetGridRay(ray, line) || !line.Clip(lattice.GetCells(), enter, leave))
  {
    return false;
  }
  return Dispatch(lattice.GetScalarType(),
    [&](auto sample)
    {
      double gradient[3];
      if (!this->IntersectBricks<decltype(sample)>(object, line, enter, leave, hit, gradient))
      {
        return false;
      }
      hit.Normal = space.GetNormal(gradient, ray.Direction);
      return true;
    });
}

template <class Store>
template <class T>
bool VolumeTracer<Store>::IntersectBricks(const IsosurfaceObject& object, const GridRay& line,
  double enter, double leave, SurfaceHit& hit, double gradient[3]) const
{
  const VoxelField& field = *object.Field;
  BrickWalk walk(field.Hierarchy, line, object.Isovalues, enter, leave);
  while (walk.Next())
  {
    CellHit cell;
    bool hasGradient = false;
    if (!this->IntersectBrick<T>(object, line, walk, cell, hit.Isovalue, gradient, hasGradient))
    {
      continue;
    }
    if (!hasGradient)
    {
      this->FindGradient<T>(field, walk.GetId(), cell, object.Isovalues[hit.Isovalue], gradient);
    }
    hit.T = cell.T;
    hit.Brick = walk.GetId();
    for (int axis = 0; axis < 3; ++axis)
    {
      hit.IndexPoint[axis] = walk.GetOrigin()[axis] + cell.Cell[axis] + cell.Local[axis];
    }
    return true;
  }
  return false;
}

template <class Store>
template <class T>
bool VolumeTracer<Store>::IntersectBrick(const IsosurfaceObject& object, const GridRay& line,
  const BrickWalk& walk, CellHit& cell, int& isovalue, double gradient[3], bool& hasGradient) const
{
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *object.Field->Segment, walk.GetId());
  const VoxelBrick<T> voxels(pin.GetData());
  const ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  const GridTraversal<T> traversal(line, voxels, walk.GetOrigin());
  bool found = false;
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t index = 0; index < object.Isovalues.size(); ++index)
  {
    CellHit candidate;
    if (range.MayHold(object.Isovalues[index]) &&
      traversal.FindFirst(IsovalueLevel<T>(object.Isovalues[index]), walk.GetEnter(),
        walk.GetLeave(), limit, candidate) &&
      candidate.T < limit)
    {
      found = true;
      limit = candidate.T;
      cell = candidate;
      isovalue = static_cast<int>(index);
    }
  }
  if (!found)
  {
    return false;
  }
  hasGradient = CellNeighbourhood::IsWithin(voxels, cell.Cell);
  if (hasGradient)
  {
    CellNeighbourhood samples;
    samples.CopyAll(voxels, cell.Cell, IsovalueLevel<T>(object.Isovalues[isovalue]));
    samples.GetGradient(cell.Local, gradient);
  }
  return true;
}

template <class Store>
BeamBricks VolumeTracer<Store>::FindBricks(
  const IsosurfaceObject& object, const Ray corners[4]) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  GridRay lines[4];
  for (int corner = 0; corner < 4; ++corner)
  {
    if (!space.GetGridRay(corners[corner], lines[corner]))
    {
      return BeamBricks();
    }
  }
  return BeamBricks(object.Field->Hierarchy, object.Isovalues, lines);
}

template <class Store>
RayPacket::Mask VolumeTracer<Store>::IntersectPacket(const IsosurfaceObject& object,
  const BeamBricks& bricks, const Ray* rays, RayPacket::Mask wanted, SurfaceHit* hits) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  const BrickLattice& lattice = object.Field->Lattice;
  RayPacket::Mask found = 0;
  RayPacket packet;
  packet.Clear();
  std::copy_n(bricks.Forward, 3, packet.Forward);
  for (RayPacket::Mask left = wanted; left != 0; left &= left - 1)
  {
    const int index = GetLowest(left);
    GridRay line;
    double enter = rays[index].Min;
    double leave = rays[index].Max;
    if (!bricks.Usable || !space.GetGridRay(rays[index], line) ||
      !RayPacket::Fits(line, bricks.Forward))
    {
      found |= RayPacket::Mask{ this->Intersect(object, rays[index], hits[index]) } << index;
    }
    else if (line.Clip(lattice.GetCells(), enter, leave))
    {
      packet.Set(index, line, enter, leave);
    }
  }
  if (packet.Rays == 0)
  {
    return found;
  }
  return Dispatch(lattice.GetScalarType(),
    [&](auto sample)
    {
      glm::dvec3 gradients[RayPacket::Size];
      const RayPacket::Mask met =
        this->IntersectBricks<decltype(sample)>(object, packet, bricks, hits, gradients);
      for (RayPacket::Mask left = met; left != 0; left &= left - 1)
      {
        const int index = GetLowest(left);
        hits[index].Normal = space.GetNormal(&gradients[index].x, rays[index].Direction);
      }
      return found | met;
    });
}

template <class Store>
template <class T>
RayPacket::Mask VolumeTracer<Store>::IntersectBricks(const IsosurfaceObject& object,
  const RayPacket& packet, const BeamBricks& bricks, SurfaceHit* hits,
  glm::dvec3* gradients) const
{
  alignas(64) double enter[RayPacket::Size];
  alignas(64) double leave[RayPacket::Size];
  PacketHits cells;
  int isovalues[RayPacket::Size];
  RayPacket::Mask found = 0;
  for (const BeamBricks::Brick& brick : bricks.Bricks)
  {
    const RayPacket::Mask rays = this->Kernel.MeetBox(
      packet, packet.Rays & ~found, brick.Lower, brick.Upper, enter, leave);
    if (rays == 0)
    {
      continue;
    }
    RayPacket::Mask haveGradients = 0;
    const RayPacket::Mask met = this->IntersectBrick<T>(
      object, packet, rays, brick, enter, leave, cells, isovalues, gradients, haveGradients);
    for (RayPacket::Mask left = met; left != 0; left &= left - 1)
    {
      const int index = GetLowest(left);
      const CellHit cell = cells.Get(index);
      SurfaceHit& hit = hits[index];
      hit.T = cell.T;
      hit.Isovalue = isovalues[index];
      hit.Brick = brick.Id;
      for (int axis = 0; axis < 3; ++axis)
      {
        hit.IndexPoint[axis] = brick.Lower[axis] + cell.Cell[axis] + cell.Local[axis];
      }
      if ((haveGradients >> index & 1) == 0)
      {
        this->FindGradient<T>(*object.Field, brick.Id, cell, object.Isovalues[hit.Isovalue],
          &gradients[index].x);
      }
    }
    found |= met;
    if (found == packet.Rays)
    {
      break;
    }
  }
  return found;
}

template <class Store>
template <class T>
RayPacket::Mask VolumeTracer<Store>::IntersectBrick(const IsosurfaceObject& object,
  const RayPacket& packet, RayPacket::Mask rays, const BeamBricks::Brick& brick,
  const double* enter, const double* leave, PacketHits& cells, int* isovalues,
  glm::dvec3* gradients, RayPacket::Mask& haveGradients) const
{
  const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *object.Field->Segment, brick.Id);
  const VoxelBrick<T> voxels(pin.GetData());
  const ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  RayPacket::Mask found = 0;
  for (std::size_t number = 0; number < object.Isovalues.size(); ++number)
  {
    if (!range.MayHold(object.Isovalues[number]))
    {
      continue;
    }
    const IsovalueLevel<T> level(object.Isovalues[number]);
    PacketHits candidates;
    const RayPacket::Mask met = this->Kernel.SearchBrick(packet, rays,
      TypedPacketBrick<T>(voxels, level), brick.Lower, enter, leave, candidates);
    for (RayPacket::Mask left = met; left != 0; left &= left - 1)
    {
      const int index = GetLowest(left);
      if ((found >> index & 1) == 0 || candidates.T[index] < cells.T[index])
      {
        cells.Set(index, candidates);
        isovalues[index] = static_cast<int>(number);
      }
    }
    found |= met;
  }
  haveGradients = 0;
  for (RayPacket::Mask left = found; left != 0; left &= left - 1)
  {
    const int index = GetLowest(left);
    const CellHit cell = cells.Get(index);
    if (CellNeighbourhood::IsWithin(voxels, cell.Cell))
    {
      CellNeighbourhood samples;
      samples.CopyAll(voxels, cell.Cell, IsovalueLevel<T>(object.Isovalues[isovalues[index]]));
      samples.GetGradient(cell.Local, &gradients[index].x);
      haveGradients |= RayPacket::Mask{ 1 } << index;
    }
  }
  return found;
}

template <class Store>
template <class T>
void VolumeTracer<Store>::FindGradient(const VoxelField& field, dsm::BlockId id,
  const CellHit& cell, double isovalue, double gradient[3]) const
{
  const BrickLattice& lattice = field.Lattice;
  const IsovalueLevel<T> level(isovalue);
  const Index3 edge(lattice.GetEdge());
  const Index3 home = lattice.GetBrick(id);
  const Index3 place = home * edge + Index3(cell.Cell[0], cell.Cell[1], cell.Cell[2]);
  const Index3 first = glm::max(place - Index3(1), Index3(0)) / edge;
  const Index3 last = glm::min(place + Index3(1), lattice.GetCells() - Index3(1)) / edge;
  CellNeighbourhood samples;
  if (lattice.HasCellMask())
  {
    samples.Clear();
  }
  else
  {
    samples.CoverWithin(place, lattice.GetCells());
  }
  for (std::int64_t z = first.z; z <= last.z; ++z)
  {
    for (std::int64_t y = first.y; y <= last.y; ++y)
    {
      for (std::int64_t x = first.x; x <= last.x; ++x)
      {
        // Differences along the axes only need the bricks across faces; the others tell no more
        // than whether their cells are blanked.
        const int axesApart = (x != home.x) + (y != home.y) + (z != home.z);
        if (axesApart > 1 && !lattice.HasCellMask())
        {
          continue;
        }
        const Index3 brick(x, y, z);
        const Index3 local = place - brick * edge;
        const int localCell[3] = { static_cast<int>(local.x), static_cast<int>(local.y),
          static_cast<int>(local.z) };
        const typename Store::Pin pin =
          this->Blocks.Acquire(this->Self, *field.Segment, lattice.GetId(brick));
        samples.CopyPart(VoxelBrick<T>(pin.GetData()), localCell, level);
      }
    }
  }
  samples.GetGradient(cell.Local, gradient);
}

template <class Store>
double VolumeTracer<Store>::Sample(const VoxelField& field, const glm::dvec3& indexPoint) const
{
  const Index3 cells = field.Lattice.GetCells();
  Index3 cell;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(indexPoint[axis] >= 0.0 && indexPoint[axis] <= static_cast<double>(cells[axis])))
    {
      return std::numeric_limits<double>::quiet_NaN();
    }
    cell[axis] = std::min(static_cast<std::int64_t>(indexPoint[axis]), cells[axis] - 1);
  }
  return Dispatch(field.Lattice.GetScalarType(),
    [&](auto sample)
    {
      using T = decltype(sample);
      // A point on a face belongs to the cells on both sides; either may hold data.
      double value = std::numeric_limits<double>::quiet_NaN();
      for (int side = 0; side < 8 && std::isnan(value); ++side)
      {
        const Index3 back(side & 1, side >> 1 & 1, side >> 2);
        bool touches = true;
        for (int axis = 0; axis < 3; ++axis)
        {
          touches = touches &&
            (back[axis] == 0 ||
              (cell[axis] > 0 && indexPoint[axis] == static_cast<double>(cell[axis])));
        }
        if (touches)
        {
          value = this->SampleCell<T>(field, cell - back, indexPoint);
        }
      }
      return value;
    });
}

template <class Store>
template <class T>
double VolumeTracer<Store>::SampleCell(
  const VoxelField& field, const Index3& cell, const glm::dvec3& indexPoint) const
{
  const Index3 brick = cell / Index3(field.Lattice.GetEdge());
  const Index3 local = cell - brick * Index3(field.Lattice.GetEdge());
  const int x = static_cast<int>(local.x);
  const int y = static_cast<int>(local.y);
  const int z = static_cast<int>(local.z);
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *field.Segment, field.Lattice.GetId(brick));
  const VoxelBrick<T> voxels(pin.GetData());
  if (!voxels.HoldsData(x, y, z))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double corners[8];
  for (int corner = 0; corner < 8; ++corner)
  {
    corners[corner] = static_cast<double>(
      voxels.GetSample(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)));
  }
  const glm::dvec3 inside = indexPoint - glm::dvec3(cell);
  return EvaluateTrilinear(corners, Lanes(inside.x, inside.y, inside.z, 0.0));
}

} // namespace rt

#endif
