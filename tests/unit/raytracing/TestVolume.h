// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_TestVolume_h
#define tests_TestVolume_h

#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMRayTracing/scene/Scene.h"
#include "MemoryStore.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <vector>

/// The C++ type's name among the scalar types.
template <class T>
constexpr bricks::ScalarType GetScalarType()
{
  if constexpr (std::is_same_v<T, float>)
  {
    return bricks::ScalarType::Float32;
  }
  else if constexpr (std::is_same_v<T, double>)
  {
    return bricks::ScalarType::Float64;
  }
  else
  {
    constexpr bricks::ScalarType types[4][2] = { { bricks::ScalarType::Int8,
                                                   bricks::ScalarType::UInt8 },
      { bricks::ScalarType::Int16, bricks::ScalarType::UInt16 },
      { bricks::ScalarType::Int32, bricks::ScalarType::UInt32 },
      { bricks::ScalarType::Int64, bricks::ScalarType::UInt64 } };
    constexpr int size = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
    return types[size][std::is_unsigned_v<T> ? 1 : 0];
  }
}

/// A whole volume in memory, x fastest, with an optional mask of cells.
template <class T>
struct TestVolume
{
  bricks::Index3 Points{ 2 };
  std::vector<T> Samples;
  std::vector<std::uint8_t> Mask; ///< empty: all cells hold data

  explicit TestVolume(const bricks::Index3& points)
    : Points(points)
    , Samples(static_cast<std::size_t>(points.x * points.y * points.z))
  {
  }
  TestVolume(const bricks::Index3& points, const std::function<T(int, int, int)>& function)
    : TestVolume(points)
  {
    for (int z = 0; z < points.z; ++z)
    {
      for (int y = 0; y < points.y; ++y)
      {
        for (int x = 0; x < points.x; ++x)
        {
          this->At(x, y, z) = function(x, y, z);
        }
      }
    }
  }

  bricks::Index3 GetCells() const { return this->Points - bricks::Index3(1); }
  T& At(std::int64_t x, std::int64_t y, std::int64_t z)
  {
    return this->Samples[x + this->Points.x * (y + this->Points.y * z)];
  }
  T At(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return this->Samples[x + this->Points.x * (y + this->Points.y * z)];
  }
  std::size_t GetCellIndex(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return x + (this->Points.x - 1) * (y + (this->Points.y - 1) * z);
  }
  void Blank(int x, int y, int z)
  {
    if (this->Mask.empty())
    {
      const bricks::Index3 cells = this->GetCells();
      this->Mask.assign(static_cast<std::size_t>(cells.x * cells.y * cells.z), 1);
    }
    this->Mask[this->GetCellIndex(x, y, z)] = 0;
  }
  bool IsCovered(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return this->Mask.empty() || this->Mask[this->GetCellIndex(x, y, z)] != 0;
  }
};

/// A box of cells of a volume.
template <class T>
class VolumePiece final : public bricks::VoxelSource
{
public:
  VolumePiece(const TestVolume<T>& volume, const bricks::Box& cells)
    : Volume(volume)
    , Cells(cells)
  {
  }
  bricks::Box GetCells() const override { return this->Cells; }
  void ReadSamples(const bricks::Box& points, std::byte* out) const override
  {
    for (std::int64_t z = points.Min.z; z < points.Max.z; ++z)
    {
      for (std::int64_t y = points.Min.y; y < points.Max.y; ++y)
      {
        for (std::int64_t x = points.Min.x; x < points.Max.x; ++x)
        {
          const T sample = this->Volume.At(x, y, z);
          std::memcpy(out, &sample, sizeof(T));
          out += sizeof(T);
        }
      }
    }
  }
  bool HasCellMask() const override { return !this->Volume.Mask.empty(); }
  void ReadCellMask(const bricks::Box& cells, std::uint8_t* out) const override
  {
    for (std::int64_t z = cells.Min.z; z < cells.Max.z; ++z)
    {
      for (std::int64_t y = cells.Min.y; y < cells.Max.y; ++y)
      {
        for (std::int64_t x = cells.Min.x; x < cells.Max.x; ++x)
        {
          *out++ = this->Volume.Mask[this->Volume.GetCellIndex(x, y, z)];
        }
      }
    }
  }

private:
  const TestVolume<T>& Volume;
  bricks::Box Cells;
};

using Pieces = std::vector<std::shared_ptr<const bricks::VoxelSource>>;

template <class T>
Pieces GetWhole(const TestVolume<T>& volume)
{
  return { std::make_shared<VolumePiece<T>>(
    volume, bricks::Box{ bricks::Index3(0), volume.GetCells() }) };
}

inline std::shared_ptr<MemoryStore::Segment> PublishPieces(
  MemoryStore& store, const bricks::BrickLattice& lattice, Pieces pieces)
{
  bricks::VoxelFragmentSource source(lattice, std::move(pieces));
  bricks::VoxelBrickSink sink(lattice);
  return store.Publish(lattice.CreateDirectory(1), source, sink);
}

/// The volume in bricks of `edge` cells; 0 means the default edge.
template <class T>
std::shared_ptr<bricks::VoxelField> CreateField(
  MemoryStore& store, const TestVolume<T>& volume, int edge = 0)
{
  const bricks::ScalarType type = GetScalarType<T>();
  const auto field = std::make_shared<bricks::VoxelField>();
  field->Lattice = bricks::BrickLattice(volume.Points, type, !volume.Mask.empty(),
    edge != 0 ? edge : bricks::BrickLattice::GetDefaultEdge(type));
  const auto segment = PublishPieces(store, field->Lattice, GetWhole(volume));
  std::vector<bricks::ValueRange> ranges;
  segment->ForEachResident(
    [&](dsm::BlockId, const std::byte* block, std::size_t)
    {
      const auto& header = *reinterpret_cast<const bricks::VoxelBrickHeader*>(block);
      ranges.push_back({ header.First, header.Last });
    });
  field->Segment = segment;
  field->Hierarchy = bricks::MacrocellHierarchy(field->Lattice, std::move(ranges));
  return field;
}

/// Null, or where planes between cells are.
using Planes = std::shared_ptr<const bricks::GridPlanes>;

/// Planes of cells whose widths differ by up to `ratio`: they grow along x, are random along y, and fall along z, where
/// coordinates fall, too.
inline Planes CreatePlanes(const bricks::Index3& cells, double ratio, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  bricks::GridPlanes::Coordinates coordinates;
  for (int axis = 0; axis < 3; ++axis)
  {
    double place = 5.0;
    coordinates[axis].push_back(place);
    for (std::int64_t cell = 0; cell < cells[axis]; ++cell)
    {
      const double part = axis == 1 ? uniform(random)
                                    : static_cast<double>(cell) /
          static_cast<double>(std::max<std::int64_t>(cells[axis] - 1, 1));
      const double width = std::pow(ratio, axis == 2 ? -part : part);
      place += axis == 2 ? -width : width;
      coordinates[axis].push_back(place);
    }
  }
  return std::make_shared<bricks::GridPlanes>(coordinates);
}

template <class T>
rt::LatticeIsosurface CreateObject(MemoryStore& store, const TestVolume<T>& volume,
  std::vector<double> isovalues, int edge = 0, const Planes& planes = nullptr)
{
  rt::LatticeIsosurface object;
  const auto field = CreateField(store, volume, edge);
  field->Planes = planes;
  object.Field.Voxels = field;
  object.Isovalues = std::move(isovalues);
  return object;
}

#endif
