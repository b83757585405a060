// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_BrickMarch_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_BrickMarch_inl_h
#undef rt_BrickMarch_inl_h
#else
#define rt_BrickMarch_inl_h
#endif

#include "DSMBricks/layout/GridPlanes.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/MediumTolerance.h"
#include "DSMRayTracing/field/cells/MediumPieces-inl.h"
#include "DSMRayTracing/field/lattice/BrickSamples-inl.h"
#include "DSMRayTracing/field/lattice/GradientShading-inl.h"
#include "DSMRayTracing/field/lattice/MediumBrick.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <numeric>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The rays of a packet through a medium in a brick. Each goes from node to node in its own lane of a vector. It takes
/// a part of the brick or a macrocell in one step where all that this holds is invisible, or where values along any
/// ray are so nearly quadratic that the pixel cannot tell. Elsewhere it takes a cell. A step asks for values where it
/// begins, in its middle and where it ends.
///
/// In single precision, in coordinates of the brick. `IsStretched`: in a rectilinear grid.
template <class F, bool IsStretched>
class BrickMarch
{
public:
  using Vector = hn::Vec<F>;
  using Mask = hn::Mask<F>;
  using Pieces = MediumPieces<F>;
  using Field = BrickSamples<F, IsStretched>;
  using NumberTag = hn::RebindToSigned<F>;
  using Numbers = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(F()));

  /// `origin`: the brick's first cell. Keeps references.
  BrickMarch(const RayPacket& packet, MediumBrick& brick, const double origin[3],
    const TransferFunction& function, MediumLight& light)
    : Packet(packet)
    , Brick(brick)
    , Samples(brick)
    , Light(light)
    , Ways(function, light)
    , Fine(brick.IsNearest ? 2.0f : 1.0f)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = IsStretched ? packet.Planes->GetPlace(axis, origin[axis]) : origin[axis];
      this->Count[axis] = this->Fine * static_cast<float>(brick.Cells[axis]);
    }
  }

  /// Returns the subset of `rays` that are dark then.
  RayPacket::Mask March(RayPacket::Mask rays)
  {
    RayPacket::Mask dark = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      const std::uint32_t some = GetPart(rays, first, Width);
      if (some != 0)
      {
        dark |= RayPacket::Mask{ this->MarchSome(first, some) } << first;
      }
    }
    return dark;
  }

private:
  /// The nodes that rays are in: first and last planes, in cells, and where rays leave.
  struct Nodes
  {
    Vector Low[3];
    Vector High[3];
    Vector Leave[3]; ///< through the plane of each axis
    Vector Exit;
  };

  /// Where rays are. T of the steps is 0 where they enter the brick, 1 where they leave it.
  struct Rays
  {
    Vector Start[3];
    Vector Way[3];
    Vector Inverse[3];
    Vector Length; ///< from 0 to 1, in the space of the medium
    Vector ToViewer[3];
    Vector T;
    Vector Cell[3];
    Numbers Ray; ///< in the packet
  };

  std::uint32_t MarchSome(int first, std::uint32_t some)
  {
    const F tag;
    HWY_ALIGN double enter[Width];
    HWY_ALIGN double distance[Width];
    Rays rays;
    this->SetRays(first, some, enter, distance, rays);
    std::size_t number[Width];
    std::iota(number, number + Width, static_cast<std::size_t>(first));
    this->Ways.SetRays(number, some, enter, distance);
    Mask open = GetBitMask(tag, some);
    Vector value = hn::Zero(tag);
    Mask hasValue = hn::Lt(value, value);
    const Vector tolerance = hn::Set(tag, static_cast<float>(MediumTolerance::Joint));
    while (!hn::AllFalse(tag, open))
    {
      const Vector seenLength = this->Ways.GetSeen(rays.Length);
      const auto isJoined = [&](const Nodes& nodes, Vector error, Numbers node)
      {
        const Vector seen = hn::Mul(hn::Sub(nodes.Exit, rays.T), seenLength);
        const Mask isSmooth = hn::Le(hn::Mul(error, seen), tolerance);
        if (!this->Brick.Shading)
        {
          return isSmooth;
        }
        const Vector glare = hn::GatherIndex(tag, this->Brick.Glare, node);
        return hn::Or(hn::Lt(error, hn::Zero(tag)),
          hn::And(isSmooth,
            hn::Le(
              hn::Mul(glare, seen), hn::Set(tag, static_cast<float>(MediumTolerance::Glare)))));
      };
      Nodes nodes = this->GetNodes(rays, MediumBrick::PartCells);
      Numbers node = this->GetNumbers(nodes, MediumBrick::PartCells, this->Brick.Parts, 0);
      Vector error = this->FindErrors(node, open);
      Mask joined = isJoined(nodes, error, node);
      if (!hn::AllFalse(tag, hn::AndNot(joined, open)))
      {
        const Nodes smaller = this->GetNodes(rays, MediumBrick::MacrocellCells);
        const Numbers own = this->GetNumbers(
          smaller, MediumBrick::MacrocellCells, this->Brick.Macrocells, this->Brick.FirstMacrocell);
        const Vector ownError = this->FindErrors(own, hn::AndNot(joined, open));
        Choose(joined, smaller, nodes);
        node = hn::IfThenElse(hn::RebindMask(NumberTag(), joined), node, own);
        error = hn::IfThenElse(joined, error, ownError);
        joined = isJoined(nodes, error, node);
        const Mask cells = hn::AndNot(joined, open);
        if (!hn::AllFalse(tag, cells))
        {
          const Mask seen = this->GoToCells(rays, cells, own, nodes);
          error = hn::IfThenElse(hn::AndNot(seen, cells), hn::Set(tag, MediumBrick::Unseen), error);
          if (this->Brick.Shading)
          {
            this->Halve(rays, hn::And(seen, cells), node, seenLength, nodes);
          }
        }
      }
      const Mask visible = hn::AndNot(hn::Lt(error, hn::Zero(tag)), open);
      const Mask hidden = hn::AndNot(visible, open);
      if (!hn::AllFalse(tag, hidden))
      {
        // The others wait until as many as possible have something to see.
        hasValue = hn::And(hasValue, visible);
        open = hn::Or(visible, this->GoOn(rays, nodes, hidden));
        continue;
      }
      this->Step(rays, nodes, node, joined, visible, value, hasValue);
      open = hn::AndNot(this->Ways.FindDark(), this->GoOn(rays, nodes, open));
    }
    const std::uint32_t dark = GetMaskBits(tag, this->Ways.FindDark()) & some;
    this->Ways.PutRays(some);
    return dark;
  }

  /// Sets T where rays enter the brick, and from there to where they leave it.
  void SetRays(int first, std::uint32_t some, double* enter, double* distance, Rays& rays) const
  {
    const F tag;
    const hn::CappedTag<double, (Width + 1) / 2> doubles;
    // Copies of one that is there stand for those that are not.
    const int other = first + __builtin_ctz(some);
    const auto load = [&](const double* numbers, int part)
    {
      return hn::IfThenElse(GetBitMask(doubles, some >> part),
        hn::LoadU(doubles, numbers + first + part), hn::Set(doubles, numbers[other]));
    };
    for (int part = 0; part < Width; part += static_cast<int>(hn::MaxLanes(doubles)))
    {
      const auto begin = load(this->Packet.BrickEnter, part);
      hn::Store(begin, doubles, enter + part);
      hn::Store(hn::Sub(load(this->Packet.BrickLeave, part), begin), doubles, distance + part);
    }
    const Vector zero = hn::Zero(tag);
    const auto fine = hn::Set(doubles, IsStretched ? 1.0 : static_cast<double>(this->Fine));
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto getStart = [&](int part)
      {
        const auto way =
          hn::Mul(hn::Load(doubles, enter + part), load(this->Packet.Direction[axis], part));
        const auto start = hn::Add(load(this->Packet.Origin[axis], part), way);
        return hn::Mul(hn::Sub(start, hn::Set(doubles, this->Origin[axis])), fine);
      };
      const auto getWay = [&](int part)
      {
        const auto direction = load(this->Packet.Direction[axis], part);
        return hn::Mul(hn::Mul(direction, hn::Load(doubles, distance + part)), fine);
      };
      const auto getInverse = [&](int part)
      {
        const auto largest = hn::Set(doubles, 1e30);
        const auto inverse = hn::Div(hn::Set(doubles, 1.0), getWay(part));
        return hn::Min(hn::Max(inverse, hn::Neg(largest)), largest);
      };
      rays.Start[axis] = DemoteLanes<F>(getStart);
      rays.Way[axis] = DemoteLanes<F>(getWay);
      rays.Inverse[axis] = DemoteLanes<F>(getInverse);
      rays.ToViewer[axis] =
        hn::IfThenElse(GetBitMask(tag, some), hn::LoadU(tag, this->Light.ToViewer[axis] + first),
          hn::Set(tag, this->Light.ToViewer[axis][other]));
      const Vector last = hn::Set(tag, this->Count[axis] - 1.0f);
      rays.Cell[axis] =
        this->Samples.FindCells(axis, rays.Start[axis], zero, last, Field::LargestSteps);
    }
    rays.Length = DemoteLanes<F>([&](int part)
      { return hn::Mul(load(this->Light.Length, part), hn::Load(doubles, distance + part)); });
    rays.T = zero;
    rays.Ray = hn::Iota(NumberTag(), std::int32_t{ first });
  }

  /// The nodes of so many cells along an edge that rays are in.
  HWY_INLINE Nodes GetNodes(const Rays& rays, int cells) const
  {
    const F tag;
    const float size = this->Fine * static_cast<float>(cells);
    const Vector edge = hn::Set(tag, size);
    const Vector inverse = hn::Set(tag, 1.0f / size);
    Nodes nodes;
    for (int axis = 0; axis < 3; ++axis)
    {
      nodes.Low[axis] = hn::Mul(hn::Floor(hn::Mul(rays.Cell[axis], inverse)), edge);
      nodes.High[axis] = hn::Min(hn::Add(nodes.Low[axis], edge), hn::Set(tag, this->Count[axis]));
    }
    this->SetExit(rays, nodes);
    return nodes;
  }
  /// Replaces `macrocells` with the cells that rays are in, or with blocks of 2 x 2 x 2 cells that show nothing.
  /// Returns those of them that may show anything. `number`: of the nodes.
  HWY_INLINE Mask GoToCells(const Rays& rays, Mask macrocells, Numbers number, Nodes& nodes) const
  {
    const F tag;
    const NumberTag numbers;
    const hn::RebindToUnsigned<F> words;
    const Vector one = hn::Set(tag, 1.0f);
    const Vector two = hn::Set(tag, 2.0f);
    const Vector half = hn::Set(tag, 0.5f);
    Vector block[3];
    Vector within[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector cell = hn::Floor(
        hn::Mul(hn::Sub(rays.Cell[axis], nodes.Low[axis]), hn::Set(tag, 1.0f / this->Fine)));
      block[axis] = hn::Floor(hn::Mul(cell, half));
      within[axis] = hn::Sub(cell, hn::Mul(two, block[axis]));
    }
    // Two words for each macrocell; blocks are 2, 8 and 32 bits apart.
    const Numbers first =
      hn::Sub(number, hn::Set(numbers, std::int32_t{ this->Brick.FirstMacrocell }));
    const Numbers at = hn::IfThenElseZero(hn::RebindMask(numbers, macrocells),
      hn::Add(hn::ShiftLeft<1>(first), hn::ConvertTo(numbers, block[2])));
    const Numbers all =
      hn::GatherIndex(numbers, reinterpret_cast<const std::int32_t*>(this->Brick.SeenCells), at);
    const auto ofBlock = hn::Shr(hn::BitCast(words, all),
      hn::BitCast(words,
        hn::ConvertTo(
          numbers, hn::Add(hn::Mul(two, block[0]), hn::Mul(hn::Set(tag, 8.0f), block[1])))));
    const auto isSet = [&](auto bits)
    { return hn::RebindMask(tag, hn::Ne(bits, hn::Zero(words))); };
    const Mask isBlockSeen = isSet(hn::And(ofBlock, hn::Set(words, 0x00330033u)));
    const auto ofCell = hn::Shr(ofBlock,
      hn::BitCast(words,
        hn::ConvertTo(numbers,
          hn::Add(within[0],
            hn::Add(
              hn::Mul(hn::Set(tag, 4.0f), within[1]), hn::Mul(hn::Set(tag, 16.0f), within[2]))))));
    Nodes cells;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector blockLow =
        hn::Add(nodes.Low[axis], hn::Mul(hn::Set(tag, 2.0f * this->Fine), block[axis]));
      const Vector blockHigh =
        hn::Min(hn::Add(blockLow, hn::Set(tag, 2.0f * this->Fine)), nodes.High[axis]);
      cells.Low[axis] = hn::IfThenElse(isBlockSeen, rays.Cell[axis], blockLow);
      cells.High[axis] = hn::IfThenElse(isBlockSeen, hn::Add(rays.Cell[axis], one), blockHigh);
    }
    this->SetExit(rays, cells);
    Choose(hn::Not(macrocells), cells, nodes);
    return isSet(hn::And(ofCell, hn::Set(words, 1u)));
  }
  HWY_INLINE void SetExit(const Rays& rays, Nodes& nodes) const
  {
    nodes.Exit = hn::Set(F(), 1.0f);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector plane = this->Samples.GetPlanes(
        axis, this->Packet.Forward[axis] ? nodes.High[axis] : nodes.Low[axis]);
      nodes.Leave[axis] = hn::Mul(hn::Sub(plane, rays.Start[axis]), rays.Inverse[axis]);
      nodes.Exit = hn::Min(nodes.Exit, nodes.Leave[axis]);
    }
    nodes.Exit = hn::Max(nodes.Exit, rays.T);
  }
  /// Lets those of `cells` that are dense, and where normals turn, end their steps in the middle of their cells.
  HWY_INLINE void Halve(
    const Rays& rays, Mask cells, Numbers node, Vector seenLength, Nodes& nodes) const
  {
    const F tag;
    const Vector way = hn::Sub(nodes.Exit, rays.T);
    const Vector glare =
      hn::Mul(hn::GatherIndex(tag, this->Brick.Glare, node), hn::Mul(way, seenLength));
    const Mask bright = hn::Gt(glare, hn::Set(tag, static_cast<float>(MediumTolerance::CellGlare)));
    nodes.Exit = hn::IfThenElse(
      hn::And(cells, bright), hn::Add(rays.T, hn::Mul(hn::Set(tag, 0.5f), way)), nodes.Exit);
  }
  /// Keeps the nodes of `kept`, and takes the others from `other`.
  static HWY_INLINE void Choose(Mask kept, const Nodes& other, Nodes& nodes)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      nodes.Low[axis] = hn::IfThenElse(kept, nodes.Low[axis], other.Low[axis]);
      nodes.High[axis] = hn::IfThenElse(kept, nodes.High[axis], other.High[axis]);
      nodes.Leave[axis] = hn::IfThenElse(kept, nodes.Leave[axis], other.Leave[axis]);
    }
    nodes.Exit = hn::IfThenElse(kept, nodes.Exit, other.Exit);
  }

  /// Numbers of nodes in MediumBrick. `count`: of those on each axis.
  HWY_INLINE Numbers GetNumbers(
    const Nodes& nodes, int cells, const int count[3], int firstNode) const
  {
    const F tag;
    const Vector inverse = hn::Set(tag, 1.0f / (this->Fine * static_cast<float>(cells)));
    const Vector rows = hn::Add(hn::Mul(nodes.Low[1], inverse),
      hn::Mul(hn::Mul(nodes.Low[2], inverse), hn::Set(tag, static_cast<float>(count[1]))));
    const Vector number = hn::Add(
      hn::Mul(nodes.Low[0], inverse), hn::Mul(rows, hn::Set(tag, static_cast<float>(count[0]))));
    return hn::Add(
      hn::ConvertTo(NumberTag(), number), hn::Set(NumberTag(), std::int32_t{ firstNode }));
  }
  /// MediumBrick::Error of the nodes of `rays`.
  HWY_INLINE Vector FindErrors(Numbers node, Mask rays)
  {
    const F tag;
    const Vector error = hn::GatherIndex(tag, this->Brick.Error, node);
    const Mask unknown = hn::And(rays, hn::Eq(error, hn::Set(tag, MediumBrick::Unknown)));
    if (hn::AllFalse(tag, unknown))
    {
      return error;
    }
    this->Describe(node, GetMaskBits(tag, unknown));
    return hn::GatherIndex(tag, this->Brick.Error, node);
  }
  HWY_NOINLINE void Describe(Numbers node, std::uint32_t lanes)
  {
    HWY_ALIGN std::int32_t numbers[Width];
    hn::Store(node, NumberTag(), numbers);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int number = numbers[__builtin_ctz(lanes)];
      if (this->Brick.Error[number] == MediumBrick::Unknown)
      {
        this->Brick.Describe(number);
      }
    }
  }

  /// Where rays are at `t`, in cells of nodes.
  HWY_INLINE typename Field::Places FindPlaces(const Rays& rays, const Nodes& nodes, Vector t) const
  {
    Vector points[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      points[axis] = hn::Add(rays.Start[axis], hn::Mul(t, rays.Way[axis]));
    }
    return this->Samples.FindPlaces(points, nodes.Low, nodes.High);
  }

  /// Takes rays that see something through their nodes. `value`: where they are, of those that have one.
  HWY_INLINE void Step(const Rays& rays, const Nodes& nodes, Numbers node, Mask joined,
    Mask visible, Vector& value, Mask& hasValue)
  {
    const F tag;
    const Vector half = hn::Set(tag, 0.5f);
    typename Pieces::Ways ways;
    ways.Begin = rays.T;
    ways.End = nodes.Exit;
    ways.Length = hn::Mul(hn::Sub(nodes.Exit, rays.T), rays.Length);
    ways.Cubic = hn::Zero(tag);
    const typename Field::Places middle =
      this->FindPlaces(rays, nodes, hn::Mul(half, hn::Add(rays.T, nodes.Exit)));
    // In a cell, samples are the same at all places.
    const bool areCells = hn::AllFalse(tag, hn::And(joined, visible));
    Vector corners[8];
    if (this->Brick.IsNearest)
    {
      ways.Middle = this->Samples.FindNearest(middle.Cell);
      ways.First = ways.Middle;
      ways.Last = ways.Middle;
    }
    else
    {
      this->Samples.LoadCorners(middle.Cell, corners);
      ways.Middle = this->Samples.Interpolate(corners, middle.Within);
      const Mask cells = hn::AndNot(joined, visible);
      const auto findValues = [&](Vector t)
      {
        const typename Field::Places places = this->FindPlaces(rays, nodes, t);
        return areCells ? this->Samples.Interpolate(corners, places.Within)
                        : this->Samples.FindValues(places);
      };
      ways.First = value;
      if (!hn::AllFalse(tag, hn::AndNot(hasValue, visible)))
      {
        ways.First = hn::IfThenElse(hasValue, value, findValues(rays.T));
      }
      ways.Last = findValues(nodes.Exit);
      if (!hn::AllFalse(tag, cells))
      {
        this->SetCubics(rays, nodes, cells, corners, ways);
      }
    }
    // Neither is a value that is not finite.
    Mask there = hn::And(visible, hn::Eq(hn::Sub(ways.Middle, ways.Middle), hn::Zero(tag)));
    if (this->Brick.Mask)
    {
      there = hn::And(there, this->Samples.FindCovered(middle.Cell, there));
    }
    for (Vector* const place : { &ways.First, &ways.Middle, &ways.Last, &ways.Cubic })
    {
      *place = hn::IfThenElseZero(there, *place);
    }
    const Vector change = hn::GatherIndex(tag, this->Brick.Change, node);
    const Vector deep = hn::GatherIndex(tag, this->Brick.Deep, node);
    if (this->Brick.Shading)
    {
      this->Ways.BeginShaded();
      this->Ways.Add(ways, there, { change, deep });
      if (this->Ways.HasShaded())
      {
        const Vector center = this->Ways.FindCenter(hn::Mul(half, hn::Add(rays.T, nodes.Exit)));
        this->Shade(rays, this->FindPlaces(rays, nodes, center));
      }
    }
    else
    {
      this->Ways.Add(ways, there, { change, deep });
    }
    value = ways.Last;
    hasValue = there;
  }

  /// Shades what MediumPieces has kept apart, at places.
  HWY_INLINE void Shade(const Rays& rays, const typename Field::Places& places)
  {
    using Shading = GradientShading<F>;
    Vector gradient[3];
    Shading::FindGradients(this->Brick, places.Cell, places.Within, gradient);
    Vector ofEmission[3];
    Vector ofOpacity[3];
    const auto arrives = [&](std::size_t lamp, int channel)
    { return this->FindArriving(rays, lamp, channel); };
    Shading::Shade(*this->Brick.Shading, gradient, rays.ToViewer, arrives, ofEmission, ofOpacity);
    this->Ways.EndShaded(ofEmission, ofOpacity);
  }

  /// The part of a lamp's light that arrives at what is shaded: on the line through two places of MediumLight::Place.
  HWY_INLINE Vector FindArriving(const Rays& rays, std::size_t lamp, int channel) const
  {
    const F tag;
    const NumberTag numbers;
    constexpr auto places = static_cast<float>(MediumLight::Places);
    const Vector zero = hn::Zero(tag);
    const Vector place =
      hn::Sub(hn::Mul(this->Ways.GetOpacity(), hn::Set(tag, places)), hn::Set(tag, 0.5f));
    const Vector first = hn::Min(hn::Max(hn::Floor(place), zero), hn::Set(tag, places - 2.0f));
    const float* const all =
      this->Light.Arriving.data() + MediumLight::GetArriving(lamp, channel, 0, 0);
    const Numbers at = hn::Add(
      hn::Mul(hn::ConvertTo(numbers, first), hn::Set(numbers, std::int32_t{ MaxRays })), rays.Ray);
    const Vector before = hn::GatherIndex(tag, all, at);
    const Vector behind = hn::GatherIndex(tag, all + MaxRays, at);
    const Vector arriving =
      hn::Add(before, hn::Mul(hn::Sub(place, first), hn::Sub(behind, before)));
    return hn::Min(hn::Max(arriving, zero), hn::Set(tag, 1.0f));
  }

  /// Along a ray in a cell, values are a cubic.
  HWY_INLINE void SetCubics(const Rays& rays, const Nodes& nodes, Mask cells,
    const Vector corners[8], typename Pieces::Ways& ways) const
  {
    const F tag;
    const Vector quarter = hn::Set(tag, 0.25f);
    const Vector t = hn::Add(rays.T, hn::Mul(quarter, hn::Sub(nodes.Exit, rays.T)));
    const Vector value =
      this->Samples.Interpolate(corners, this->FindPlaces(rays, nodes, t).Within);
    const Vector twice = hn::Add(ways.Middle, ways.Middle);
    // The quadratic at 1 / 4.
    const Vector bend = hn::Sub(hn::Add(ways.First, ways.Last), twice);
    const Vector line = hn::Add(ways.First, hn::Mul(quarter, hn::Sub(ways.Last, ways.First)));
    const Vector quadratic = hn::Sub(line, hn::Mul(hn::Set(tag, 0.375f), bend));
    const Vector cubic =
      hn::Mul(hn::Sub(value, quadratic), hn::Set(tag, static_cast<float>(64.0 / 3.0)));
    ways.Cubic = hn::IfThenElseZero(cells, cubic);
  }

  /// Takes `some` rays to the nodes behind theirs. Returns those of them that are still in the brick.
  HWY_INLINE Mask GoOn(Rays& rays, const Nodes& nodes, Mask some) const
  {
    const F tag;
    const Vector one = hn::Set(tag, 1.0f);
    rays.T = hn::IfThenElse(some, nodes.Exit, rays.T);
    Mask open = hn::And(some, hn::Lt(rays.T, one));
    Vector cells[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector point = hn::Add(rays.Start[axis], hn::Mul(rays.T, rays.Way[axis]));
      const Vector inside = this->Samples.FindCells(
        axis, point, nodes.Low[axis], hn::Sub(nodes.High[axis], one), Field::PartSteps);
      const Vector next =
        this->Packet.Forward[axis] ? nodes.High[axis] : hn::Sub(nodes.Low[axis], one);
      cells[axis] = hn::IfThenElse(hn::Le(nodes.Leave[axis], rays.T), next, inside);
      open = hn::And(open,
        hn::And(hn::Ge(cells[axis], hn::Zero(tag)),
          hn::Lt(cells[axis], hn::Set(tag, this->Count[axis]))));
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      // Rays that have left the brick need cells that exist, too.
      rays.Cell[axis] =
        hn::IfThenElse(some, hn::IfThenElseZero(open, cells[axis]), rays.Cell[axis]);
    }
    return open;
  }

  const RayPacket& Packet;
  MediumBrick& Brick;
  Field Samples;
  MediumLight& Light;
  Pieces Ways;
  float Fine; ///< coordinates in a cell
  double Origin[3];
  float Count[3];
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
