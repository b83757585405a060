// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/PointGradients.h"

#include "DSMBricks/cells/CornerOrder.h"
#include "DSMBricks/cells/ExactScale.h"
#include "DSMBricks/cells/PointNotes.h"
#include "DSMBricks/cells/ShownCells.h"
#include "DSMBricks/cells/SplitCell.h"
#include "DSMBricks/layout/PlaceInBrick.h"
#include "DSMCore/memory/BlockArena.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace bricks
{

namespace
{

/// Corners of a cell with a function that is linear in each tetrahedron.
struct CellCorners
{
  float Places[CellSource::MostCorners][3];
  double Values[CellSource::MostCorners];
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

/// Writes what a tetrahedron adds to the sums of its corners. They are in the order of their places, so that the result
/// does not depend on how the cell names them.
void MeasureTetrahedron(
  const CellCorners& cell, const std::uint8_t corners[4], double parts[PartsOfGradient])
{
  double edges[3][3];
  double rises[3];
  const float* const origin = cell.Places[corners[0]];
  for (int edge = 0; edge < 3; ++edge)
  {
    const float* const end = cell.Places[corners[edge + 1]];
    for (int axis = 0; axis < 3; ++axis)
    {
      edges[edge][axis] = static_cast<double>(end[axis]) - static_cast<double>(origin[axis]);
    }
    rises[edge] = cell.Values[corners[edge + 1]] - cell.Values[corners[0]];
  }
  double volume = 0.0;
  std::fill_n(parts, 3, 0.0);
  for (int edge = 0; edge < 3; ++edge)
  {
    const double* const one = edges[(edge + 1) % 3];
    const double* const other = edges[(edge + 2) % 3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const int y = (axis + 1) % 3;
      const int z = (axis + 2) % 3;
      const double area = one[y] * other[z] - one[z] * other[y];
      parts[axis] += rises[edge] * area;
      volume += edge == 0 ? edges[0][axis] * area : 0.0;
    }
  }
  // A flat tetrahedron has no gradient, and others may be inside out.
  const double sign = volume > 0.0 ? 1.0 : volume < 0.0 ? -1.0 : 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    parts[axis] *= sign;
  }
  parts[3] = std::abs(volume);
}

class GradientFinder
{
public:
  GradientFinder(const CellSource& source, const BrickSpace& space,
    dsm::FunctionRef<double(std::uint64_t)> getValue, int threads)
    : Source(source)
    , Space(space)
    , GetValue(getValue)
    , Threads(threads)
    , Notes(source.GetPointCount())
  {
  }

  /// Finds how large the numbers around each of this rank's points may be.
  void FindScales()
  {
    this->ForEachCell(
      [this](const std::uint64_t* points, auto corners, const CellCorners&,
        const GradientBounds& bounds, std::size_t chunk)
      {
        const GradientScales scales(bounds);
        for (int corner = 0; corner < corners(); ++corner)
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
  void AddCells()
  {
    this->Memory = dsm::BlockArena(this->Notes.GetCount() * sizeof(GradientSum));
    this->Sums = reinterpret_cast<GradientSum*>(this->Memory.GetData());
    this->ForEachCell([this](const std::uint64_t* points, auto corners, const CellCorners& cell,
                        const GradientBounds& bounds, std::size_t chunk)
      { this->AddCell(points, corners, cell, bounds, chunk); });
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
  template <int Count>
  using CornerCount = std::integral_constant<int, Count>;

  /// Calls visit(points, CornerCount, corners, bounds, chunk) for every cell that counts.
  template <class Visit>
  void ForEachCell(const Visit& visit) const
  {
    ForEachShownCell(this->Source, this->Threads,
      [&](std::uint64_t, const std::uint64_t* points, int corners, std::size_t chunk)
      {
        corners == 4 ? this->VisitCell<4>(points, chunk, visit)
                     : this->VisitCell<8>(points, chunk, visit);
      });
  }

  template <int Corners, class Visit>
  void VisitCell(const std::uint64_t* points, std::size_t chunk, const Visit& visit) const
  {
    CellCorners cell;
    GradientBounds bounds;
    if (this->ReadCell<Corners>(points, cell, bounds))
    {
      visit(points, CornerCount<Corners>(), cell, bounds, chunk);
    }
  }

  /// Returns whether the cell counts.
  template <int Corners>
  bool ReadCell(const std::uint64_t* points, CellCorners& cell, GradientBounds& bounds) const
  {
    double positions[Corners][3];
    for (int corner = 0; corner < Corners; ++corner)
    {
      this->Source.GetPosition(points[corner], positions[corner]);
      cell.Values[corner] = this->GetValue(points[corner]);
    }
    const BrickSpace space = this->Space; // no call in between may change it
    bool isFinite = true;
    for (int corner = 0; corner < Corners; ++corner)
    {
      isFinite = PlaceInBrick(space, positions[corner], cell.Places[corner]) && isFinite;
    }
    double size[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      float lower = cell.Places[0][axis];
      float upper = lower;
      for (int corner = 1; corner < Corners; ++corner)
      {
        lower = std::min(lower, cell.Places[corner][axis]);
        upper = std::max(upper, cell.Places[corner][axis]);
      }
      size[axis] = static_cast<double>(upper) - static_cast<double>(lower);
    }
    double lowest = cell.Values[0];
    double highest = lowest;
    for (int corner = 0; corner < Corners; ++corner)
    {
      lowest = std::min(lowest, cell.Values[corner]);
      highest = std::max(highest, cell.Values[corner]);
      isFinite = isFinite && std::isfinite(cell.Values[corner]);
    }
    // Twice the volume of a box is the largest determinant of three edges in it. A component of the gradient is one,
    // too, with values in place of an axis.
    const double face = std::max({ size[0] * size[1], size[1] * size[2], size[2] * size[0] });
    bounds = { 2.0 * face * (highest - lowest), 2.0 * size[0] * size[1] * size[2] };
    return isFinite && std::isfinite(bounds.Gradient);
  }

  template <int Corners>
  void AddCell(const std::uint64_t* points, CornerCount<Corners>, const CellCorners& cell,
    const GradientBounds& bounds, std::size_t chunk)
  {
    std::uint8_t order[Corners];
    OrderCorners<Corners>(cell.Places, order);
    std::uint8_t tetrahedra[MostTetrahedra][4] = { { 0, 1, 2, 3 } };
    int count;
    if constexpr (Corners == 8)
    {
      count = SplitHexahedron(order, tetrahedra);
    }
    else
    {
      count = SortCorners(order, tetrahedra[0]) ? 1 : 0;
    }
    const GradientScales scales(bounds);
    const double gradientFactor = scales.OfGradient().GetFactor();
    const double volumeFactor = scales.OfVolume().GetFactor();
    std::int64_t sums[Corners][PartsOfGradient] = {};
    for (int tetrahedron = 0; tetrahedron < count; ++tetrahedron)
    {
      double parts[PartsOfGradient];
      MeasureTetrahedron(cell, tetrahedra[tetrahedron], parts);
      std::int64_t integers[PartsOfGradient];
      for (int axis = 0; axis < 3; ++axis)
      {
        integers[axis] = static_cast<std::int64_t>(parts[axis] * gradientFactor);
      }
      integers[3] = static_cast<std::int64_t>(parts[3] * volumeFactor);
      for (const std::uint8_t corner : tetrahedra[tetrahedron])
      {
        for (int part = 0; part < PartsOfGradient; ++part)
        {
          sums[corner][part] += integers[part];
        }
      }
    }
    for (int corner = 0; corner < Corners; ++corner)
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
  const BrickSpace& Space;
  dsm::FunctionRef<double(std::uint64_t)> GetValue;
  int Threads;
  PointNotes Notes; ///< GradientScales
  dsm::BlockArena Memory;
  GradientSum* Sums = nullptr; ///< of points, in Memory
};

} // namespace

std::vector<PackedGradient> FindPointGradients(std::string_view what, const CellSource& source,
  const BrickSpace& space, const SharedPlaces& places,
  dsm::FunctionRef<double(std::uint64_t point)> getValue, int threads, dsm::Messenger& messenger)
{
  std::optional<GradientFinder> finder;
  messenger.RunTogether(what,
    [&]
    {
      finder.emplace(source, space, getValue, threads);
      finder->FindScales();
    });
  finder->JoinScales(what, places);
  messenger.RunTogether(what, [&] { finder->AddCells(); });
  places.Sum(what, finder->GetSums(), PartsOfGradient);
  std::vector<PackedGradient> gradients;
  messenger.RunTogether(what, [&] { gradients = finder->Pack(); });
  return gradients;
}

} // namespace bricks
