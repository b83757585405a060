// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/PointGradients.h"

#include "DSMBricks/base/Float4.h"
#include "DSMBricks/cells/CornerOrder.h"
#include "DSMBricks/cells/ExactScale.h"
#include "DSMBricks/cells/PointNotes.h"
#include "DSMBricks/cells/ShownCells.h"
#include "DSMBricks/cells/SplitCell.h"
#include "DSMBricks/layout/PlaceInBrick.h"
#include "DSMCore/memory/BlockArena.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <type_traits>

namespace bricks
{

namespace
{

/// Part of the time until the scales are known.
constexpr double EndOfGradientScales = 0.3;

/// A point of a function that is linear in each tetrahedron.
struct GradientPoint
{
  double Value;   ///< NaN: the point has none, or no finite place
  float Place[4]; ///< the last is 0
};

/// Of one tetrahedron, or sums over several: gradients times volumes along three axes, and volumes, all six times.
/// A gradient times a volume needs no division: it is a sum of areas times differences of values.
constexpr int PartsOfGradient = 4;

/// Bounds of the sizes of all that tetrahedra of a cell may add.
struct GradientBounds
{
  double Gradient;
  double Volume;
};

/// The scales of a point's sums: of gradients in the upper 16 bits, of volumes in the lower ones.
class GradientScales
{
public:
  GradientScales() = default;
  explicit GradientScales(std::uint32_t bits)
    : Bits(bits)
  {
  }
  explicit GradientScales(const GradientBounds& bounds)
    : Bits(std::uint32_t(ExactScale(bounds.Gradient).GetPower()) << 16 |
        ExactScale(bounds.Volume).GetPower())
  {
  }
  std::uint32_t GetBits() const { return this->Bits; }
  ExactScale OfGradient() const
  {
    return ExactScale::FromPower(static_cast<std::uint16_t>(this->Bits >> 16));
  }
  ExactScale OfVolume() const
  {
    return ExactScale::FromPower(static_cast<std::uint16_t>(this->Bits & 0xffffu));
  }
  /// For the numbers of both.
  GradientScales Join(const GradientScales& other) const
  {
    return GradientScales(std::max(this->Bits & 0xffff0000u, other.Bits & 0xffff0000u) |
      std::max(this->Bits & 0xffffu, other.Bits & 0xffffu));
  }

private:
  std::uint32_t Bits = 0;
};

struct alignas(32) GradientSum
{
  std::int64_t Parts[PartsOfGradient];
};
static_assert(sizeof(GradientSum) == PartsOfGradient * sizeof(std::int64_t));

/// Tetrahedra of a cell: numbers of corners, in the order of their places, so that the result does not depend on how
/// the cell names them. The first corner is the same in all.
struct CellTetrahedra
{
  int Count = 0;
  std::uint8_t Corners[MostTetrahedra][4];
};

/// Finds the tetrahedra of cells. One for each thread: cells beside one another are often divided alike.
template <std::size_t Corners>
class TetrahedraFinder
{
public:
  const CellTetrahedra& Find(const float places[][3])
  {
    if (!this->Last || !this->Last->Fits(places))
    {
      std::uint8_t order[Corners];
      OrderCorners<Corners>(places, order);
      Key key;
      std::memcpy(&key, order, sizeof(key));
      constexpr Key factor = Key(0x9e3779b97f4a7c15u);
      this->Last = &this->Table[(key * factor) >> (8 * sizeof(Key) - TableBits)];
      if (this->Last->Order != key || !this->Last->IsSet)
      {
        this->Last->Set(key, order);
      }
    }
    return this->Last->Tetrahedra;
  }

private:
  static constexpr int TableBits = 8;
  using Key = std::conditional_t<Corners == 8, std::uint64_t, std::uint32_t>;
  static_assert(sizeof(Key) == Corners);

  struct Known
  {
    Key Order = 0;
    bool IsSet = false;
    bool IsStrict = false;        ///< no two corners have the same place
    std::uint8_t Sorted[Corners]; ///< the corners in ascending order
    CellTetrahedra Tetrahedra;

    void Set(Key key, const std::uint8_t order[Corners])
    {
      this->Order = key;
      this->IsSet = true;
      std::uint32_t found = 0;
      for (std::size_t corner = 0; corner < Corners; ++corner)
      {
        this->Sorted[order[corner]] = static_cast<std::uint8_t>(corner);
        found |= 1u << order[corner];
      }
      this->IsStrict = found + 1 == 1u << Corners;
      this->Tetrahedra.Count = Divide(order, this->Tetrahedra.Corners);
    }
    /// Returns whether the corners of another cell are known to have this order.
    bool Fits(const float places[][3]) const
    {
      bool fits = this->IsStrict;
      for (std::size_t number = 0; fits && number + 1 < Corners; ++number)
      {
        const float* const one = places[this->Sorted[number]];
        const float* const next = places[this->Sorted[number + 1]];
        fits = one[0] < next[0] ||
          (one[0] == next[0] && (one[1] < next[1] || (one[1] == next[1] && one[2] < next[2])));
      }
      return fits;
    }
  };

  static int Divide(const std::uint8_t order[Corners], std::uint8_t tetrahedra[][4])
  {
    if constexpr (Corners == 8)
    {
      return SplitHexahedron(order, tetrahedra);
    }
    else
    {
      std::iota(tetrahedra[0], tetrahedra[0] + 4, std::uint8_t(0));
      return SortCorners(order, tetrahedra[0]) ? 1 : 0;
    }
  }

  Known* Last = nullptr;
  Known Table[1 << TableBits];
};

/// From the first corner of a tetrahedron to another one.
struct CellEdge
{
  glm::dvec3 Way;
  double Rise; ///< of the value
};

/// Writes what a tetrahedron adds to the sums of its corners, from its edges from the first of them.
inline void MeasureTetrahedron(const CellEdge& a, const CellEdge& b, const CellEdge& c,
  double gradientFactor, double volumeFactor, std::int64_t parts[PartsOfGradient])
{
  const glm::dvec3 areaOfA = glm::cross(b.Way, c.Way);
  const double volume = glm::dot(a.Way, areaOfA);
  // A flat tetrahedron has no gradient, and others may be inside out.
  const double factor = volume > 0.0 ? gradientFactor : volume < 0.0 ? -gradientFactor : 0.0;
  const glm::dvec3 gradient =
    a.Rise * areaOfA + b.Rise * glm::cross(c.Way, a.Way) + c.Rise * glm::cross(a.Way, b.Way);
  for (int axis = 0; axis < 3; ++axis)
  {
    parts[axis] = static_cast<std::int64_t>(gradient[axis] * factor);
  }
  parts[3] = static_cast<std::int64_t>(std::abs(volume) * volumeFactor);
}

class GradientFinder
{
public:
  GradientFinder(const CellSource& source, const BrickSpace& space,
    dsm::FunctionRef<double(std::uint64_t)> getValue, int threads)
    : Source(source)
    , Threads(threads)
    , Notes(source.GetPointCount())
  {
    this->ReadPoints(space, getValue);
  }

  /// Finds how large the numbers around each of this rank's points may be.
  void FindScales(dsm::FunctionRef<void(double)> progress)
  {
    SharedProgress advance(progress, 0.0, EndOfGradientScales, this->Source.GetCellCount());
    this->ForEachCell(advance,
      [this](const std::uint64_t* points, const auto& cell, const GradientBounds& bounds,
        std::size_t chunk, int)
      {
        const GradientScales scales(bounds);
        for (std::size_t corner = 0; corner < cell.size(); ++corner)
        {
          this->Notes.Add(points[corner], chunk,
            [&](std::uint32_t bits) { return scales.Join(GradientScales(bits)).GetBits(); });
        }
      });
  }

  void JoinScales(std::string_view what, const SharedPlaces& places)
  {
    places.Combine<std::uint32_t>(
      what, [this](std::uint64_t point) { return this->Notes.Get(point); },
      [this](std::uint64_t point, std::uint32_t bits) { this->Notes.Set(point, bits); },
      [](std::uint32_t& bits, std::uint32_t other)
      { bits = GradientScales(bits).Join(GradientScales(other)).GetBits(); });
  }

  /// Adds up what this rank's cells give to its points.
  void AddCells(dsm::FunctionRef<void(double)> progress)
  {
    SharedProgress advance(progress, EndOfGradientScales, 1.0, this->Source.GetCellCount());
    this->Memory = dsm::BlockArena(this->Notes.GetCount() * sizeof(GradientSum));
    this->Sums = reinterpret_cast<GradientSum*>(this->Memory.GetData());
    const auto threads = static_cast<std::size_t>(std::max(this->Threads, 1));
    std::vector<TetrahedraFinder<4>> ofTetrahedra(threads);
    std::vector<TetrahedraFinder<8>> ofHexahedra(threads);
    this->ForEachCell(advance,
      [&](const std::uint64_t* points, const auto& cell, const GradientBounds& bounds,
        std::size_t chunk, int thread)
      {
        const auto number = static_cast<std::size_t>(thread);
        if constexpr (std::tuple_size_v<std::decay_t<decltype(cell)>> == 8)
        {
          this->AddCell(ofHexahedra[number], points, cell, bounds, chunk);
        }
        else
        {
          this->AddCell(ofTetrahedra[number], points, cell, bounds, chunk);
        }
      });
  }

  std::int64_t* GetSums() { return this->Sums->Parts; }

  std::vector<PackedGradient> Pack() const
  {
    constexpr std::size_t pointsOfChunk = std::size_t(1) << 16;
    std::vector<PackedGradient> gradients(this->Notes.GetCount());
    ParallelForChunks(this->Threads, gradients.size(), pointsOfChunk,
      [&](std::size_t begin, std::size_t end, std::size_t, int)
      {
        for (std::size_t point = begin; point < end; ++point)
        {
          gradients[point] = this->PackPoint(point);
        }
      });
    return gradients;
  }

private:
  template <std::size_t Corners>
  using CellPoints = std::array<const GradientPoint*, Corners>;

  void ReadPoints(const BrickSpace& space, dsm::FunctionRef<double(std::uint64_t)> getValue)
  {
    constexpr std::size_t pointsOfChunk = std::size_t(1) << 14;
    this->PointMemory = dsm::BlockArena(this->Notes.GetCount() * sizeof(GradientPoint));
    this->Points = reinterpret_cast<GradientPoint*>(this->PointMemory.GetData());
    ParallelForChunks(this->Threads, this->Notes.GetCount(), pointsOfChunk,
      [&](std::size_t begin, std::size_t end, std::size_t, int)
      {
        for (std::size_t number = begin; number < end; ++number)
        {
          GradientPoint& point = this->Points[number];
          double position[3];
          this->Source.GetPosition(number, position);
          const bool isFinite = PlaceInBrick(space, position, point.Place);
          const double value = getValue(number);
          point.Value =
            isFinite && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
        }
      });
  }

  /// Calls visit(points, CellPoints, bounds, chunk, thread) for every cell that counts.
  template <class Visit>
  void ForEachCell(SharedProgress& progress, const Visit& visit) const
  {
    ForEachShownCell(this->Source, this->Threads, progress,
      [&](std::uint64_t, const std::uint64_t* points, int corners, std::size_t chunk, int thread)
      {
        corners == 4 ? this->VisitCell<4>(points, chunk, thread, visit)
                     : this->VisitCell<8>(points, chunk, thread, visit);
      });
  }

  template <std::size_t Corners, class Visit>
  void VisitCell(
    const std::uint64_t* points, std::size_t chunk, int thread, const Visit& visit) const
  {
    CellPoints<Corners> cell;
    bool isFinite = true;
    for (std::size_t corner = 0; corner < Corners; ++corner)
    {
      cell[corner] = this->Points + points[corner];
      isFinite = isFinite && !std::isnan(cell[corner]->Value);
    }
    if (!isFinite)
    {
      return;
    }
    const GradientBounds bounds = FindBounds(cell);
    if (std::isfinite(bounds.Gradient))
    {
      visit(points, cell, bounds, chunk, thread);
    }
  }

  template <std::size_t Corners>
  static GradientBounds FindBounds(const CellPoints<Corners>& cell)
  {
    Float4 lower = Float4::Load(cell[0]->Place);
    Float4 upper = lower;
    double lowest = cell[0]->Value;
    double highest = lowest;
    for (std::size_t corner = 1; corner < Corners; ++corner)
    {
      const Float4 place = Float4::Load(cell[corner]->Place);
      lower = Min(lower, place);
      upper = Max(upper, place);
      lowest = std::min(lowest, cell[corner]->Value);
      highest = std::max(highest, cell[corner]->Value);
    }
    float first[4];
    float last[4];
    lower.Store(first);
    upper.Store(last);
    double size[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      size[axis] = static_cast<double>(last[axis]) - static_cast<double>(first[axis]);
    }
    // Twice the volume of a box is the largest determinant of three edges in it. A component of the gradient is one,
    // too, with values in place of an axis.
    const double face = std::max({ size[0] * size[1], size[1] * size[2], size[2] * size[0] });
    return { 2.0 * face * (highest - lowest), 2.0 * size[0] * size[1] * size[2] };
  }

  template <std::size_t Corners>
  void AddCell(TetrahedraFinder<Corners>& finder, const std::uint64_t* points,
    const CellPoints<Corners>& cell, const GradientBounds& bounds, std::size_t chunk)
  {
    float places[Corners][3];
    for (std::size_t corner = 0; corner < Corners; ++corner)
    {
      std::copy_n(cell[corner]->Place, 3, places[corner]);
    }
    const CellTetrahedra& tetrahedra = finder.Find(places);
    const GradientScales scales(bounds);
    std::int64_t sums[Corners][PartsOfGradient] = {};
    if (tetrahedra.Count > 0)
    {
      CellEdge edges[Corners];
      const GradientPoint& origin = *cell[tetrahedra.Corners[0][0]];
      for (std::size_t corner = 0; corner < Corners; ++corner)
      {
        CellEdge& edge = edges[corner];
        edge.Way = glm::dvec3(glm::make_vec3(cell[corner]->Place)) -
          glm::dvec3(glm::make_vec3(origin.Place));
        edge.Rise = cell[corner]->Value - origin.Value;
      }
      const double gradientFactor = scales.OfGradient().GetFactor();
      const double volumeFactor = scales.OfVolume().GetFactor();
      for (int tetrahedron = 0; tetrahedron < tetrahedra.Count; ++tetrahedron)
      {
        const std::uint8_t* const corners = tetrahedra.Corners[tetrahedron];
        std::int64_t integers[PartsOfGradient];
        MeasureTetrahedron(edges[corners[1]], edges[corners[2]], edges[corners[3]], gradientFactor,
          volumeFactor, integers);
        for (int corner = 0; corner < 4; ++corner)
        {
          for (int part = 0; part < PartsOfGradient; ++part)
          {
            sums[corners[corner]][part] += integers[part];
          }
        }
      }
    }
    for (std::size_t corner = 0; corner < Corners; ++corner)
    {
      this->AddToPoint(points[corner], sums[corner], scales, chunk);
    }
  }

  /// Adds what a cell gives to a point, whose scales may be larger.
  void AddToPoint(std::uint64_t point, const std::int64_t parts[PartsOfGradient],
    const GradientScales& scales, std::size_t chunk)
  {
    this->Notes.Run(point, chunk,
      [&](std::uint32_t number)
      {
        const GradientScales ofPoint(number);
        const int shift = ofPoint.OfGradient().CountBitsAbove(scales.OfGradient());
        const int volumeShift = ofPoint.OfVolume().CountBitsAbove(scales.OfVolume());
        std::int64_t* const sum = this->Sums[point].Parts;
        for (int axis = 0; axis < 3; ++axis)
        {
          sum[axis] += parts[axis] >> shift;
        }
        sum[3] += parts[3] >> volumeShift;
      });
  }

  PackedGradient PackPoint(std::size_t point) const
  {
    const std::int64_t* const parts = this->Sums[point].Parts;
    if (parts[3] <= 0)
    {
      return {};
    }
    const GradientScales scales(this->Notes.Get(point));
    const double perVolume = scales.OfGradient().GetUnit() / scales.OfVolume().GetUnit();
    double gradient[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[axis] = static_cast<double>(parts[axis]) / static_cast<double>(parts[3]) * perVolume;
    }
    return PackedGradient(gradient);
  }

  const CellSource& Source;
  int Threads;
  PointNotes Notes; ///< GradientScales
  dsm::BlockArena PointMemory;
  GradientPoint* Points = nullptr; ///< in PointMemory
  dsm::BlockArena Memory;
  GradientSum* Sums = nullptr; ///< of points, in Memory
};

} // namespace

std::vector<PackedGradient> FindPointGradients(std::string_view what, const CellSource& source,
  const BrickSpace& space, const SharedPlaces& places,
  dsm::FunctionRef<double(std::uint64_t point)> getValue, int threads, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress)
{
  std::optional<GradientFinder> finder;
  messenger.RunTogether(what,
    [&]
    {
      finder.emplace(source, space, getValue, threads);
      finder->FindScales(progress);
    });
  finder->JoinScales(what, places);
  messenger.RunTogether(what, [&] { finder->AddCells(progress); });
  places.Sum(what, finder->GetSums(), PartsOfGradient);
  std::vector<PackedGradient> gradients;
  messenger.RunTogether(what, [&] { gradients = finder->Pack(); });
  return gradients;
}

} // namespace bricks
