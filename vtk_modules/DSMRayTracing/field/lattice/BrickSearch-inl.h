// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_BrickSearch_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_BrickSearch_inl_h
#undef rt_BrickSearch_inl_h
#else
#define rt_BrickSearch_inl_h
#endif

#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/cells/CellCrossing-inl.h"
#include "DSMRayTracing/field/lattice/NodePath-inl.h"
#include "DSMRayTracing/field/lattice/NodePlanes-inl.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"
#include "DSMRayTracing/field/lattice/VoxelCrossing-inl.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The rays of a packet in a brick; what GridTraversal does for one ray, with the same bits. In a part
/// of 4 x 4 x 4 macrocells it is found out at once, for each ray, which of them it crosses (see
/// FindCrossedNodes). Then rays wait for their next macrocell, or the next cell in it, and those that
/// wait for the same fill the vectors, wherever they are: most meet few macrocells, and few cells there.
///
/// `Visitor` says what is looked for: it visits each VoxelCrossing. `Planes`: UniformPlanes or StretchedPlanes.
template <class D, class Visitor, class Planes = UniformPlanes<D>>
class BrickSearch
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  using NumberTag = hn::RebindToUnsigned<D>;
  using Numbers = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  /// `origin`: the brick's first cell. Keeps references.
  BrickSearch(
    const RayPacket& packet, const PacketBrick& brick, const double origin[3], Visitor& visitor)
    : Packet(packet)
    , Brick(brick)
    , Origin(origin)
    , Look(visitor)
    , Grid(packet)
    , Forward(packet.Forward)
  {
  }

  /// Returns the subset of `rays` whose search ends in the brick.
  RayPacket::Mask Search(RayPacket::Mask rays)
  {
    int parts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      parts[axis] = (this->Brick.GetMacrocells(axis) + 3) / 4;
    }
    for (int k = 0; k < parts[2]; ++k)
    {
      for (int j = 0; j < parts[1]; ++j)
      {
        for (int i = 0; i < parts[0]; ++i)
        {
          // In the order in which they are met.
          this->Part[0] = this->Forward[0] ? i : parts[0] - 1 - i;
          this->Part[1] = this->Forward[1] ? j : parts[1] - 1 - j;
          this->Part[2] = this->Forward[2] ? k : parts[2] - 1 - k;
          this->SearchPart(rays & ~this->Found);
          if (this->Found == rays)
          {
            return rays;
          }
        }
      }
    }
    return this->Found;
  }

private:
  /// Rays that wait for the same thing.
  class WaitingRays
  {
  public:
    int GetCount() const { return this->Count; }
    /// Adds a ray, if `isWaiting`.
    void Add(int ray, bool isWaiting)
    {
      this->Rays[this->Count] = static_cast<std::uint8_t>(ray);
      this->Count += isWaiting;
    }
    /// Removes the last `count`, and returns the first of them.
    const std::uint8_t* Take(int count)
    {
      this->Count -= count;
      return this->Rays + this->Count;
    }

  private:
    int Count = 0;
    std::uint8_t Rays[RayPacket::Size + 1];
  };

  /// The rays of a vector. Where they are fewer, the first of them stands for the rest.
  struct Batch
  {
    int Count;
    std::size_t Ray[Width];

    explicit Batch(WaitingRays& from)
      : Count(std::min(Width, from.GetCount()))
    {
      const std::uint8_t* const taken = from.Take(this->Count);
      for (int lane = 0; lane < Width; ++lane)
      {
        this->Ray[lane] = taken[lane < this->Count ? lane : 0];
      }
    }

    /// Bits of those that are there.
    std::uint32_t GetLanes() const { return (1u << this->Count) - 1; }
  };

  static HWY_INLINE Vector Load(const Batch& batch, const double* numbers)
  {
    return LoadLanes<double, Width>(numbers, batch.Ray);
  }

  HWY_INLINE RayLines<D> LoadLines(const Batch& batch) const
  {
    RayLines<D> lines;
    for (int axis = 0; axis < 3; ++axis)
    {
      lines.Origin[axis] = Load(batch, this->Packet.Origin[axis]);
      lines.Inverse[axis] = Load(batch, this->Packet.Inverse[axis]);
    }
    return lines;
  }

  /// Searches Part.
  void SearchPart(RayPacket::Mask rays)
  {
    const PacketPart& known = this->Brick.FindPart(this->Part);
    if (known.Macrocells == 0)
    {
      return;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const int begin = this->Part[axis] + (this->Forward[axis] ? 0 : 1);
      this->Start[axis] = this->Origin[axis] + 4.0 * bricks::MacrocellEdge * begin;
    }
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      const std::uint32_t some = GetPart(rays, first, Width);
      if (some != 0)
      {
        this->FindMacrocells(first, some, known);
      }
    }
    for (;;)
    {
      const int forCell = this->ForCell.GetCount();
      const int forMacrocell = this->ForMacrocell.GetCount();
      if (forCell == 0 && forMacrocell == 0)
      {
        return;
      }
      // Vectors that are not full can wait as long as there is something else to do.
      if (forCell >= Width || forMacrocell == 0)
      {
        this->SearchCells(Batch(this->ForCell));
      }
      else
      {
        this->SearchMacrocells(Batch(this->ForMacrocell), known);
      }
    }
  }

  /// Finds the macrocells that rays cross, of ray `first` and those after it `some` (bits).
  HWY_INLINE void FindMacrocells(int first, std::uint32_t some, const PacketPart& known)
  {
    const D tag;
    const RayLines<D> lines(this->Packet, first);
    Vector entry[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      entry[axis] = hn::Set(tag, this->Start[axis]);
    }
    const Numbers crossed =
      FindCrossedNodes<D>(lines, typename Planes::Box(this->Grid, entry, bricks::MacrocellEdge),
        hn::Load(tag, this->Packet.BrickEnter + first),
        hn::Load(tag, this->Packet.BrickLeave + first));
    hn::Store(hn::And(crossed, hn::Set(NumberTag(), known.Macrocells)), NumberTag(),
      this->Macrocells + first);
    for (; some != 0; some &= some - 1)
    {
      const int ray = first + __builtin_ctz(some);
      this->ForMacrocell.Add(ray, this->Macrocells[ray] != 0);
    }
  }

  /// Finds the cells that rays cross in the macrocell for which they wait.
  HWY_INLINE void SearchMacrocells(const Batch& batch, const PacketPart& known)
  {
    const D tag;
    const RayLines<D> lines = this->LoadLines(batch);
    const Numbers macrocells =
      GetLowestBits(LoadLanes<std::uint64_t, Width>(this->Macrocells, batch.Ray));
    Vector entry[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = this->Forward[axis] ? bricks::MacrocellEdge : -bricks::MacrocellEdge;
      entry[axis] = hn::Add(hn::Set(tag, this->Start[axis]),
        hn::Mul(hn::Set(tag, step), ToReal(GetCoordinate(macrocells, axis))));
    }
    std::size_t numbers[Width];
    for (int lane = 0; lane < Width; ++lane)
    {
      const int macrocell = __builtin_ctzll(this->Macrocells[batch.Ray[lane]]);
      numbers[lane] = static_cast<std::size_t>(macrocell);
      if ((known.Known >> macrocell & 1) == 0)
      {
        this->Brick.FindCells(this->Part, macrocell);
      }
    }
    const Numbers crossed = FindCrossedNodes<D>(lines, typename Planes::Box(this->Grid, entry, 1),
      Load(batch, this->Packet.BrickEnter), Load(batch, this->Packet.BrickLeave));
    HWY_ALIGN std::uint64_t cells[Width];
    hn::Store(
      hn::And(crossed, LoadLanes<std::uint64_t, Width>(known.Cells, numbers)), NumberTag(), cells);
    for (int lane = 0; lane < batch.Count; ++lane)
    {
      const std::size_t ray = batch.Ray[lane];
      this->Cells[ray] = cells[lane];
      this->GoOn(ray, true);
    }
  }

  /// Lets a ray wait for what comes next, if it is `open`.
  HWY_INLINE void GoOn(std::size_t ray, bool open)
  {
    const bool hasCell = this->Cells[ray] != 0;
    const std::uint64_t macrocells = this->Macrocells[ray];
    const std::uint64_t left = hasCell ? macrocells : macrocells & (macrocells - 1);
    this->Macrocells[ray] = left;
    this->ForCell.Add(static_cast<int>(ray), open & hasCell);
    this->ForMacrocell.Add(static_cast<int>(ray), open & !hasCell & (left != 0));
  }

  /// The corners of cells (`place`: coordinates in the brick), less the isovalue; returns the rays
  /// whose cells hold data.
  HWY_INLINE Mask LoadCorners(const Vector place[3], Vector values[8]) const
  {
    const D tag;
    const PacketBrick::FloatSamples& samples = this->Brick.Floats;
    const hn::Rebind<float, D> floats;
    const hn::RebindToUnsigned<decltype(floats)> words;
    const Vector row = hn::Mul(place[1], hn::Set(tag, samples.Row));
    const Vector slice = hn::Mul(place[2], hn::Set(tag, samples.Slice));
    HWY_ALIGN std::uint64_t places[Width];
    hn::Store(ToNumbers(hn::Add(hn::Add(place[0], row), slice)), NumberTag(), places);
    const Vector isovalue = hn::Set(tag, samples.Isovalue);
    Vector check = hn::Zero(tag);
    for (int pair = 0; pair < 4; ++pair)
    {
      const float* const first = samples.First + (pair & 1) * static_cast<int>(samples.Row) +
        (pair >> 1) * static_cast<int>(samples.Slice);
      // A row of two corners at once.
      const Numbers both = SetLanes<std::uint64_t, Width>(
        [&](int lane)
        {
          std::uint64_t two;
          std::memcpy(&two, first + places[lane], sizeof(two));
          return two;
        });
      const auto low = hn::BitCast(floats, hn::TruncateTo(words, both));
      const auto high = hn::BitCast(floats, hn::TruncateTo(words, hn::ShiftRight<32>(both)));
      values[2 * pair] = hn::Sub(hn::PromoteTo(tag, low), isovalue);
      values[2 * pair + 1] = hn::Sub(hn::PromoteTo(tag, high), isovalue);
      // Becomes, and stays, not a number where one of them is not finite.
      check =
        hn::Add(check, hn::Mul(hn::Add(values[2 * pair], values[2 * pair + 1]), hn::Zero(tag)));
    }
    return hn::Eq(check, hn::Zero(tag));
  }

  /// The same for samples of other types, and where cells are masked; of `rays` (bits).
  HWY_INLINE Mask AskForCorners(std::uint32_t rays, const Vector place[3], Vector values[8]) const
  {
    const D tag;
    HWY_ALIGN double corners[8][Width];
    for (double* const corner : corners)
    {
      hn::Store(hn::Zero(tag), tag, corner);
    }
    HWY_ALIGN double places[3][Width];
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::Store(place[axis], tag, places[axis]);
    }
    const std::uint8_t held[8] = { static_cast<std::uint8_t>(
      this->Brick.GetCorners(rays, places[0], corners[0], Width)) };
    for (int corner = 0; corner < 8; ++corner)
    {
      values[corner] = hn::Load(tag, corners[corner]);
    }
    return hn::LoadMaskBits(tag, held);
  }

  /// Searches the cell for which rays wait.
  HWY_INLINE void SearchCells(const Batch& batch)
  {
    const D tag;
    const Numbers macrocells =
      GetLowestBits(LoadLanes<std::uint64_t, Width>(this->Macrocells, batch.Ray));
    const Numbers nodes = GetLowestBits(LoadLanes<std::uint64_t, Width>(this->Cells, batch.Ray));
    const RayLines<D> lines = this->LoadLines(batch);
    const Vector one = hn::Set(tag, 1.0);
    Vector enter = Load(batch, this->Packet.BrickEnter);
    Vector exit = Load(batch, this->Packet.BrickLeave);
    const auto getIndex = [&](int axis)
    {
      const Vector steps = ToReal(
        hn::Or(hn::ShiftLeft<2>(GetCoordinate(macrocells, axis)), GetCoordinate(nodes, axis)));
      const Vector start = hn::Set(tag, this->Start[axis]);
      return this->Forward[axis] ? hn::Add(start, steps) : hn::Sub(hn::Sub(start, steps), one);
    };
    const Vector index[3] = { getIndex(0), getIndex(1), getIndex(2) };
    using Cell = typename Planes::Cell;
    const Cell sides[3] = { Cell(this->Grid, 0, index[0]), Cell(this->Grid, 1, index[1]),
      Cell(this->Grid, 2, index[2]) };
    Vector place[3];
    Vector in[3];
    Vector out[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool forward = this->Forward[axis];
      place[axis] = hn::Sub(index[axis], hn::Set(tag, this->Origin[axis]));
      const Cell& side = sides[axis];
      in[axis] = lines.GetPlaneT(axis, forward ? side.Lower : side.Upper);
      out[axis] = lines.GetPlaneT(axis, forward ? side.Upper : side.Lower);
      enter = hn::Max(enter, in[axis]);
      exit = hn::Min(exit, out[axis]);
    }
    VoxelCrossing<D> cells;
    cells.Ray = batch.Ray;
    cells.There = batch.GetLanes();
    cells.Enter = enter;
    cells.Exit = exit;
    cells.Brick = &this->Brick;
    cells.Forward = this->Forward;
    cells.Crossing = this->Brick.Floats.First
      ? this->LoadCorners(place, cells.Corners)
      : this->AskForCorners(batch.GetLanes(), place, cells.Corners);
    // Rays that only touch the cell do not cross it.
    cells.Crossing = hn::And(cells.Crossing, hn::Lt(enter, exit));
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector origin = lines.Origin[axis];
      const Vector direction = Load(batch, this->Packet.Direction[axis]);
      const Vector entry = hn::Set(tag, this->Forward[axis] ? 0.0 : 1.0);
      const auto getLocal = [&](Vector t, Vector planeT, Vector plane)
      {
        // Exactly 0 or 1 where they meet a plane of the cell.
        const Vector point = hn::Add(origin, hn::Mul(t, direction));
        return hn::IfThenElse(hn::Eq(planeT, t), plane, ClampToUnit(sides[axis].GetWithin(point)));
      };
      cells.Place[axis] = place[axis];
      cells.Start[axis] = getLocal(enter, in[axis], entry);
      cells.End[axis] = getLocal(exit, out[axis], hn::Sub(one, entry));
    }
    const std::uint32_t ended = this->Look.Visit(cells) & batch.GetLanes();
    for (int lane = 0; lane < batch.Count; ++lane)
    {
      const std::size_t ray = batch.Ray[lane];
      this->Cells[ray] &= this->Cells[ray] - 1;
      const std::uint64_t isOver = ended >> lane & 1;
      this->Found |= isOver << ray;
      this->GoOn(ray, isOver == 0);
    }
  }

  const RayPacket& Packet;
  const PacketBrick& Brick;
  const double* Origin;
  Visitor& Look;
  Planes Grid;
  const bool* Forward;
  int Part[3];
  double Start[3]; ///< planes through which rays enter the part
  RayPacket::Mask Found = 0;
  WaitingRays ForMacrocell;
  WaitingRays ForCell;
  HWY_ALIGN std::uint64_t
    Macrocells[RayPacket::Size];                  ///< macrocells that each ray has yet to cross
  HWY_ALIGN std::uint64_t Cells[RayPacket::Size]; ///< the same in the first of its macrocells
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
