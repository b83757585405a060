// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/CellAverages.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace bricks
{

namespace
{

std::size_t GetIndex(const Box& box, const Index3& cell)
{
  const Index3 at = cell - box.Min;
  const Index3 size = box.GetSize();
  return static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z));
}

/// Calls `visit(from, to, count)` for each row of the cells that two boxes have in common: where it begins in either.
template <class Visit>
void ForEachCommonRow(const Box& from, const Box& to, const Box& cells, const Visit& visit)
{
  const Box common = Intersect(Intersect(from, to), cells);
  if (common.IsEmpty())
  {
    return;
  }
  const auto count = static_cast<std::size_t>(common.GetSize().x);
  for (std::int64_t z = common.Min.z; z < common.Max.z; ++z)
  {
    for (std::int64_t y = common.Min.y; y < common.Max.y; ++y)
    {
      const Index3 first(common.Min.x, y, z);
      visit(GetIndex(from, first), GetIndex(to, first), count);
    }
  }
}

/// As vtkMath::RoundDoubleToIntegralIfNecessary does.
template <class T>
T Round(double value)
{
  constexpr auto least = static_cast<double>(std::numeric_limits<T>::lowest());
  constexpr auto most = static_cast<double>(std::numeric_limits<T>::max());
  if constexpr (std::is_same_v<T, double>)
  {
    return value;
  }
  else if constexpr (std::is_same_v<T, float>)
  {
    // Comparisons with what is not a number are false, so it stays what it is.
    return static_cast<float>(value < least ? least : value > most ? most : value);
  }
  else
  {
    // The largest 64-bit integers are no doubles.
    return value >= most ? std::numeric_limits<T>::max()
      : value <= least   ? std::numeric_limits<T>::lowest()
                         : static_cast<T>(value >= 0.0 ? value + 0.5 : value - 0.5);
  }
}

/// Four cells beside one another, in the order of vtkStructuredData::GetPointCells: first of them all the one before.
struct Around
{
  const double* Cells[4];
};

/// Cells that do not count have the value 0.
inline double Add(const Around& around, double weight)
{
  double sum = 0.0;
  for (int side = 0; side < 2; ++side)
  {
    for (const double* const cell : around.Cells)
    {
      sum += weight * cell[side];
    }
  }
  return sum;
}

} // namespace

CellAverages::CellAverages(std::shared_ptr<const CellReader> piece)
  : Piece(std::move(piece))
{
  for (const Box& box : GetLayer(this->Piece->GetCells()))
  {
    this->Layer.push_back({ box, {}, {}, {} });
  }
}

std::vector<Box> CellAverages::GetLayer(const Box& piece)
{
  std::vector<Box> layer;
  if (piece.IsEmpty())
  {
    return layer;
  }
  Box rest{ piece.Min - Index3(1), piece.Max + Index3(1) };
  for (int axis = 0; axis < 3; ++axis)
  {
    Box below = rest;
    Box above = rest;
    below.Max[axis] = piece.Min[axis];
    above.Min[axis] = piece.Max[axis];
    layer.push_back(below);
    layer.push_back(above);
    rest.Min[axis] = piece.Min[axis];
    rest.Max[axis] = piece.Max[axis];
  }
  return layer;
}

std::size_t CellAverages::CountBytesOfCell() const
{
  return static_cast<std::size_t>(this->Piece->CountComponents()) *
    bricks::GetBytes(this->Piece->GetType());
}

void CellAverages::AddNeighbors(
  std::uint32_t piece, const Box& cells, const std::byte* bytes, std::size_t count)
{
  const auto cellCount = static_cast<std::size_t>(cells.GetCount());
  const auto place = std::find_if(this->Layer.begin(), this->Layer.end(),
    [&](const Neighbors& box)
    { return Intersect(box.Cells, cells).GetCount() == cells.GetCount(); });
  if (place == this->Layer.end() || count != cellCount * (1 + this->CountBytesOfCell()))
  {
    throw dsm::Error(
      "Cells arrived that are not next to the piece. Do all ranks run the same build "
      "and agree on the dataset's extent and scalar type?");
  }
  const auto all = static_cast<std::size_t>(place->Cells.GetCount());
  if (place->States.empty())
  {
    place->States.resize(all, CellReader::NoData);
    place->Origins.resize(all, std::numeric_limits<std::uint64_t>::max());
    place->Values.resize(all * this->CountBytesOfCell());
  }
  const std::size_t valueBytes = bricks::GetBytes(this->Piece->GetType());
  const std::byte* const values = bytes + cellCount;
  std::size_t from = 0;
  ForEachIndex(cells,
    [&](const Index3& cell)
    {
      const std::size_t to = GetIndex(place->Cells, cell);
      const auto state = static_cast<std::uint8_t>(bytes[from]);
      const std::uint64_t origin = (state == CellReader::Own ? 0 : std::uint64_t(1) << 32) + piece;
      if (state != CellReader::NoData && origin < place->Origins[to])
      {
        place->States[to] = state;
        place->Origins[to] = origin;
        for (int component = 0; component < this->Piece->CountComponents(); ++component)
        {
          const auto number = static_cast<std::size_t>(component);
          std::memcpy(&place->Values[(number * all + to) * valueBytes],
            values + (number * cellCount + from) * valueBytes, valueBytes);
        }
      }
      ++from;
    });
}

void CellAverages::ReadCellMask(const Box& cells, std::uint8_t* out) const
{
  this->Piece->ReadStates(cells, out);
  std::transform(out, out + cells.GetCount(), out,
    [](std::uint8_t state) { return state == CellReader::Own ? 1 : 0; });
}

void CellAverages::ReadSamples(const Box& points, std::byte* out) const
{
  Dispatch(
    this->Piece->GetType(), [&](auto sample) { this->Average<decltype(sample)>(points, out); });
}

template <class T>
void CellAverages::Average(const Box& points, std::byte* out) const
{
  const Box around{ points.Min - Index3(1), points.Max };
  const Box own = Intersect(around, this->Piece->GetCells());
  const auto ownCount = static_cast<std::size_t>(own.GetCount());
  const auto cellCount = static_cast<std::size_t>(around.GetCount());
  const auto pointCount = static_cast<std::size_t>(points.GetCount());

  // Which cells count: 1, else 0.
  std::vector<std::uint8_t> counts(cellCount, 0);
  std::vector<std::uint8_t> states(ownCount, CellReader::Own);
  if (this->Piece->HasMask())
  {
    this->Piece->ReadStates(own, states.data());
  }
  const auto count = [&](const std::uint8_t* from, std::size_t to, std::size_t row)
  {
    for (std::size_t cell = 0; cell < row; ++cell)
    {
      counts[to + cell] = from[cell] != CellReader::NoData ? 1 : 0;
    }
  };
  ForEachCommonRow(own, around, own,
    [&](std::size_t from, std::size_t to, std::size_t row) { count(&states[from], to, row); });
  for (const Neighbors& box : this->Layer)
  {
    if (!box.States.empty())
    {
      ForEachCommonRow(box.Cells, around, box.Cells,
        [&](std::size_t from, std::size_t to, std::size_t row)
        { count(&box.States[from], to, row); });
    }
  }

  const auto rowOfCells = static_cast<std::size_t>(around.GetSize().x);
  const auto sliceOfCells = rowOfCells * static_cast<std::size_t>(around.GetSize().y);
  const auto rowOfPoints = static_cast<std::size_t>(points.GetSize().x);
  // Calls visit(first cell around the row's first point, the row's first point).
  const auto forEachRow = [&](const auto& visit)
  {
    std::size_t point = 0;
    for (std::int64_t z = 0; z < points.GetSize().z; ++z)
    {
      for (std::int64_t y = 0; y < points.GetSize().y; ++y, point += rowOfPoints)
      {
        visit(static_cast<std::size_t>(z) * sliceOfCells + static_cast<std::size_t>(y) * rowOfCells,
          point);
      }
    }
  };

  // Where all cells count, each has an eighth.
  const bool isWhole =
    std::all_of(counts.begin(), counts.end(), [](std::uint8_t one) { return one != 0; });
  std::vector<double> weights(isWhole ? 0 : pointCount);
  if (!isWhole)
  {
    double weightOf[9] = {};
    for (int number = 1; number <= 8; ++number)
    {
      weightOf[number] = 1.0 / number;
    }
    forEachRow(
      [&](std::size_t cell, std::size_t point)
      {
        const std::uint8_t* const near = &counts[cell];
        const std::uint8_t* const far = near + sliceOfCells;
        for (std::size_t x = 0; x < rowOfPoints; ++x)
        {
          const std::size_t y = x + rowOfCells;
          weights[point + x] = weightOf[near[x] + near[x + 1] + near[y] + near[y + 1] + far[x] +
            far[x + 1] + far[y] + far[y + 1]];
        }
      });
  }

  const int components = this->Piece->CountComponents();
  std::vector<T> averages(pointCount * static_cast<std::size_t>(components));
  std::vector<T> ownValues(ownCount);
  std::vector<double> values(cellCount, 0.0);
  const auto take = [&](const T* from, std::size_t to, std::size_t row)
  {
    for (std::size_t cell = to; cell < to + row; ++cell, ++from)
    {
      values[cell] = counts[cell] ? static_cast<double>(*from) : 0.0;
    }
  };
  for (int component = 0; component < components; ++component)
  {
    if (ownCount > 0)
    {
      this->Piece->ReadValues(component, own, reinterpret_cast<std::byte*>(ownValues.data()));
    }
    ForEachCommonRow(own, around, own,
      [&](std::size_t from, std::size_t to, std::size_t row) { take(&ownValues[from], to, row); });
    for (const Neighbors& box : this->Layer)
    {
      if (!box.States.empty())
      {
        const T* const boxValues =
          reinterpret_cast<const T*>(box.Values.data()) + component * box.Cells.GetCount();
        ForEachCommonRow(box.Cells, around, box.Cells,
          [&](std::size_t from, std::size_t to, std::size_t row)
          { take(boxValues + from, to, row); });
      }
    }
    T* const result = &averages[pointCount * static_cast<std::size_t>(component)];
    const auto addAll = [&](const auto& getWeight)
    {
      forEachRow(
        [&](std::size_t cell, std::size_t point)
        {
          const double* const yz = &values[cell]; // (y - 1, z - 1)
          const double* const z = yz + rowOfCells;
          const double* const y = yz + sliceOfCells;
          const double* const at = y + rowOfCells;
          T* const row = result + point;
          for (std::size_t x = 0; x < rowOfPoints; ++x)
          {
            row[x] = Round<T>(Add({ { at + x, y + x, yz + x, z + x } }, getWeight(point + x)));
          }
        });
    };
    isWhole ? addAll([](std::size_t) { return 0.125; })
            : addAll([&](std::size_t point) { return weights[point]; });
  }
  this->Piece->Combine(pointCount, reinterpret_cast<const std::byte*>(averages.data()), out);
}

} // namespace bricks
