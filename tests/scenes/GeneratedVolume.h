// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_scenes_GeneratedVolume_h
#define tests_scenes_GeneratedVolume_h

#include "DSMBricks/build/VoxelSource.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMBricks/layout/GridPlanes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>

/// Data with the same bits on every machine: made of integers, sums, products and roots alone.
namespace Generated
{

/// A 32-bit integer finalizer with low bias (C. Wellons, hash-prospector), of several numbers.
inline std::uint32_t Hash(std::int64_t a, std::int64_t b = 0, std::int64_t c = 0, unsigned seed = 0)
{
  std::uint32_t hash = seed;
  for (const std::int64_t number : { a, b, c })
  {
    hash += static_cast<std::uint32_t>(number) * 0x9e3779b9u + 1u;
    hash ^= hash >> 16;
    hash *= 0x7feb352du;
    hash ^= hash >> 15;
    hash *= 0x846ca68bu;
    hash ^= hash >> 16;
  }
  return hash;
}

/// In [0, 1).
inline double Random(std::int64_t a, std::int64_t b = 0, std::int64_t c = 0, unsigned seed = 0)
{
  return Hash(a, b, c, seed) / 4294967296.0;
}

/// Random numbers at integer places, and smoothly in between; in [0, 1).
inline double Noise(double x, double y, double z, unsigned seed)
{
  const double place[3] = { x, y, z };
  std::int64_t cell[3];
  double weight[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    cell[axis] = static_cast<std::int64_t>(std::floor(place[axis]));
    const double part = place[axis] - static_cast<double>(cell[axis]);
    weight[axis] = part * part * (3.0 - 2.0 * part);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    double share = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      share *= (corner >> axis & 1) != 0 ? weight[axis] : 1.0 - weight[axis];
    }
    sum += share *
      Random(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2), seed);
  }
  return sum;
}

/// What a volume is like. Its values are within [0, 100] before they become samples.
struct Recipe
{
  enum class Shape
  {
    Waves, ///< smooth
    Ball,  ///< 50 on a sphere
    Rough, ///< a random number at every point
    Steps, ///< cubes of two values
    Ramp   ///< planes through samples
  };
  /// Samples that are missing.
  enum class Hole
  {
    None,
    NotANumber,
    Infinite
  };
  Shape Form = Shape::Waves;
  bricks::ScalarType Type = bricks::ScalarType::Float32;
  bricks::Index3 Points{ 23, 19, 21 };
  int BrickEdge = 8;
  Hole Holes = Hole::None;
  bool Blanked = false; ///< some cells do not hold data
  /// Makes a rectilinear volume unless it is 1: each cell is so many times as wide as the one before it on x, and
  /// as the one after it on z. Widths on y are random.
  double Growth = 1.0;
  unsigned Seed = 1;
};

/// Where planes between cells are; null: at equal distances.
inline std::shared_ptr<const bricks::GridPlanes> CreatePlanes(const Recipe& recipe)
{
  if (recipe.Growth == 1.0)
  {
    return nullptr;
  }
  bricks::GridPlanes::Coordinates coordinates;
  for (int axis = 0; axis < 3; ++axis)
  {
    double place = 0.0;
    double width = 1.0;
    for (std::int64_t plane = 0; plane < recipe.Points[axis]; ++plane)
    {
      coordinates[axis].push_back(place);
      place += axis == 1 ? 0.1 + Random(plane, 0, 0, recipe.Seed) : width;
      width = axis == 0 ? width * recipe.Growth : width / recipe.Growth;
    }
  }
  return std::make_shared<bricks::GridPlanes>(coordinates);
}

inline double Evaluate(const Recipe& recipe, const bricks::Index3& point)
{
  const auto x = static_cast<double>(point.x);
  const auto y = static_cast<double>(point.y);
  const auto z = static_cast<double>(point.z);
  switch (recipe.Form)
  {
    case Recipe::Shape::Waves:
      return 100.0 * Noise(0.21 * x, 0.23 * y, 0.19 * z, recipe.Seed);
    case Recipe::Shape::Ball:
    {
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double half = 0.5 * static_cast<double>(recipe.Points[axis] - 1);
        const double part = (static_cast<double>(point[axis]) - half) / half;
        square += part * part;
      }
      return 100.0 * std::max(0.0, 1.0 - square);
    }
    case Recipe::Shape::Rough:
      return Hash(point.x, point.y, point.z, recipe.Seed) % 101u;
    case Recipe::Shape::Steps:
      return (point.x / 3 + point.y / 4 + point.z / 5) % 2 == 0 ? 75.0 : 25.0;
    case Recipe::Shape::Ramp:
      return 2.0 * x + y + 0.5 * z;
  }
  return 0.0;
}

/// The sample that a value becomes: integers of all sizes, signed ones on both sides of zero.
inline double Scale(bricks::ScalarType type, double value)
{
  switch (type)
  {
    case bricks::ScalarType::Int8:
      return value - 50.0;
    case bricks::ScalarType::UInt8:
      return 2.0 * value;
    case bricks::ScalarType::Int16:
      return 500.0 * (value - 50.0);
    case bricks::ScalarType::UInt16:
      return 600.0 * value;
    case bricks::ScalarType::Int32:
      return 4e7 * (value - 50.0);
    case bricks::ScalarType::UInt32:
      return 4e7 * value;
    case bricks::ScalarType::Int64:
      return 1.5e17 * (value - 50.0);
    case bricks::ScalarType::UInt64:
      return 1.5e17 * value;
    case bricks::ScalarType::Float32:
      return value;
    case bricks::ScalarType::Float64:
      return 1e-3 * (value - 50.0);
  }
  return value;
}

/// A piece of a volume.
class Volume final : public bricks::VoxelSource
{
public:
  Volume(const Recipe& recipe, const bricks::Box& cells)
    : Made(recipe)
    , Cells(cells)
  {
  }

  bricks::Box GetCells() const override { return this->Cells; }

  void ReadSamples(const bricks::Box& points, std::byte* out) const override
  {
    bricks::Dispatch(this->Made.Type,
      [&](auto type)
      {
        using Sample = decltype(type);
        ForEach(points,
          [&](const bricks::Index3& point)
          {
            const Sample sample = this->GetSample<Sample>(point);
            std::memcpy(out, &sample, sizeof(sample));
            out += sizeof(sample);
          });
      });
  }

  bool HasCellMask() const override { return this->Made.Blanked; }
  void ReadCellMask(const bricks::Box& cells, std::uint8_t* out) const override
  {
    ForEach(cells,
      [&](const bricks::Index3& cell)
      { *out++ = Hash(cell.x, cell.y, cell.z, this->Made.Seed + 7) % 9 != 0 ? 1 : 0; });
  }

private:
  template <class Use>
  static void ForEach(const bricks::Box& box, const Use& use)
  {
    bricks::Index3 at;
    for (at.z = box.Min.z; at.z < box.Max.z; ++at.z)
    {
      for (at.y = box.Min.y; at.y < box.Max.y; ++at.y)
      {
        for (at.x = box.Min.x; at.x < box.Max.x; ++at.x)
        {
          use(at);
        }
      }
    }
  }

  template <class Sample>
  Sample GetSample(const bricks::Index3& point) const
  {
    if constexpr (std::numeric_limits<Sample>::has_quiet_NaN)
    {
      if (this->Made.Holes != Recipe::Hole::None &&
        Hash(point.x, point.y, point.z, this->Made.Seed + 3) % 40 == 0)
      {
        return this->Made.Holes == Recipe::Hole::NotANumber
          ? std::numeric_limits<Sample>::quiet_NaN()
          : std::numeric_limits<Sample>::infinity();
      }
    }
    return static_cast<Sample>(Scale(this->Made.Type, Evaluate(this->Made, point)));
  }

  Recipe Made;
  bricks::Box Cells;
};

} // namespace Generated

#endif
