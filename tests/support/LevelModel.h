// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_LevelModel_h
#define tests_LevelModel_h

#include "DSMBricks/levels/LevelSource.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

/// Nested leaves of several levels, kept in the plainest way: for each cell of the finest lattice, the level of the
/// leaf that has it. Places are in cells of level 0.
class LevelModel
{
public:
  using Index3 = bricks::Index3;
  static constexpr int Nothing = -1;

  LevelModel(const Index3& roots, std::vector<Index3> scales)
    : Scales(std::move(scales))
    , Roots(roots)
    , Size(roots * this->Scales.back())
    , Levels(static_cast<std::size_t>(this->Size.x * this->Size.y * this->Size.z))
  {
  }

  /// Divides a leaf of level `from` into leaves of level `to`, or removes it. Does nothing if there is no such leaf.
  void Replace(int from, const Index3& cell, int to)
  {
    if (this->GetLevel(cell * this->GetParts(from)) == from)
    {
      bricks::ForEachIndex(this->GetFinest(from, cell),
        [&](const Index3& at)
        { this->Levels[this->GetOffset(at)] = static_cast<std::int8_t>(to); });
    }
  }
  /// The same in a box of cells of level `from`, for those with `chosen(cell)`.
  void ReplaceIn(
    int from, const bricks::Box& box, int to,
    const std::function<bool(const Index3&)>& chosen = [](const Index3&) { return true; })
  {
    const bricks::Box all{ Index3(0), this->Roots * this->Scales[from] };
    bricks::ForEachIndex(bricks::Intersect(box, all),
      [&](const Index3& cell)
      {
        if (chosen(cell))
        {
          this->Replace(from, cell, to);
        }
      });
  }

  /// Finest cells of a cell on each axis.
  Index3 GetParts(int level) const { return this->Scales.back() / this->Scales[level]; }
  bricks::Box GetFinest(int level, const Index3& cell) const
  {
    return { cell * this->GetParts(level), (cell + Index3(1)) * this->GetParts(level) };
  }
  /// The level of the leaf that has a cell of the finest lattice; Nothing, also beyond the lattice.
  int GetLevel(const Index3& finest) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (finest[axis] < 0 || finest[axis] >= this->Size[axis])
      {
        return Nothing;
      }
    }
    return this->Levels[this->GetOffset(finest)];
  }

  /// Calls `visit(level, cell)`.
  template <class Visit>
  void ForEachLeaf(const Visit& visit) const
  {
    bricks::ForEachIndex({ Index3(0), this->Size },
      [&](const Index3& at)
      {
        const int level = this->GetLevel(at);
        if (level != Nothing && at % this->GetParts(level) == Index3(0))
        {
          visit(level, at / this->GetParts(level));
        }
      });
  }

  /// The values: of cells, or of a level's points.
  double GetValue(int level, const Index3& number) const
  {
    const glm::dvec3 half(this->OfPoints ? 0.0 : 0.5);
    return this->Function(level, (glm::dvec3(number) + half) / glm::dvec3(this->Scales[level]));
  }

  std::vector<Index3> Scales;
  Index3 Roots;
  Index3 Size; ///< of the finest lattice
  bool OfPoints = false;
  bricks::ScalarType Type = bricks::ScalarType::Float32;
  /// The value of a leaf of a level at a place.
  std::function<double(int, const glm::dvec3&)> Function = [](int, const glm::dvec3& place)
  { return glm::length(place); };

private:
  std::size_t GetOffset(const Index3& at) const
  {
    return static_cast<std::size_t>(at.x + this->Size.x * (at.y + this->Size.y * at.z));
  }

  std::vector<std::int8_t> Levels;
};

/// Several levels with boxes, scattered leaves and, if wanted, holes, in all places: at the border, at edges, at
/// corners.
inline LevelModel CreateRandomLevels(unsigned seed, bool withHoles)
{
  using bricks::Index3;
  const std::vector<std::vector<std::int64_t>> scales{ { 1, 2, 4 }, { 1, 3, 6 }, { 1, 4, 8 },
    { 1, 8 }, { 1, 2, 4, 8, 16 }, { 1 }, { 1, 3, 9 }, { 1, 2, 16 } };
  std::vector<Index3> chosen;
  for (const std::int64_t scale : scales[seed % scales.size()])
  {
    chosen.emplace_back(scale);
  }
  std::mt19937 random(seed);
  const auto get = [&](std::int64_t count)
  { return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(count)); };
  LevelModel model(Index3(4 + get(3), 4 + get(2), 4 + get(3)), chosen);
  const int levels = static_cast<int>(model.Scales.size());
  for (int from = 0; from + 1 < levels; ++from)
  {
    for (int round = 0; round < 3; ++round)
    {
      int to = from + 1 + static_cast<int>(get(levels - from - 1));
      to = seed % 3 == 1 && to == 1 && levels > 2 ? 2 : to; // level 1 has no leaves
      const Index3 size = model.Roots * model.Scales[from];
      const Index3 first(get(size.x), get(size.y), get(size.z));
      const bricks::Box box{ first - Index3(1),
        first + Index3(1 + get(3), 1 + get(3), 1 + get(3)) };
      const std::int64_t part = 1 + get(3);
      model.ReplaceIn(from, box, to, [&](const Index3&) { return get(part) == 0; });
    }
  }
  for (int hole = 0; withHoles && hole < 12; ++hole)
  {
    const int level = static_cast<int>(get(levels));
    const Index3 size = model.Roots * model.Scales[level];
    model.Replace(level, { get(size.x), get(size.y), get(size.z) }, LevelModel::Nothing);
  }
  return model;
}

/// The leaves of a model that one rank has.
class LevelModelSource final : public bricks::LevelSource
{
public:
  using Index3 = bricks::Index3;

  /// `isOwn(level, cell)`: of leaves.
  LevelModelSource(
    const LevelModel& model,
    const std::function<bool(int, const Index3&)>& isOwn = [](int, const Index3&) { return true; })
    : Model(model)
  {
    model.ForEachLeaf(
      [&](int level, const Index3& cell)
      {
        if (!isOwn(level, cell))
        {
          return;
        }
        const std::size_t number = this->Cubes.Find(level, cell);
        this->Cubes.Count(number, cell);
        this->Leaves.resize(this->Cubes.GetAll().size());
        this->Leaves[number].push_back(cell);
      });
  }

  const std::vector<bricks::LevelCube>& GetCubes() const override { return this->Cubes.GetAll(); }
  bool IsOfPoints() const override { return this->Model.OfPoints; }

  void ReadCube(std::size_t number, double* values, std::uint8_t* isLeaf) const override
  {
    constexpr std::int64_t edge = bricks::LevelLattice::Edge;
    const std::int64_t more = this->Model.OfPoints ? 1 : 0;
    std::fill_n(isLeaf, edge * edge * edge, std::uint8_t{ 0 });
    const bricks::LevelCube& cube = this->Cubes.GetAll()[number];
    for (const Index3& cell : this->Leaves[number])
    {
      const Index3 first = bricks::LevelCubes::GetFirst(cube);
      const Index3 at = cell - first;
      isLeaf[at.x + edge * (at.y + edge * at.z)] = 1;
      bricks::ForEachIndex({ cell, cell + Index3(1 + more) },
        [&](const Index3& of)
        {
          const Index3 to = of - first;
          values[to.x + (edge + more) * (to.y + (edge + more) * to.z)] =
            this->Model.GetValue(cube.Level, of);
        });
    }
  }

private:
  const LevelModel& Model;
  bricks::LevelCubes Cubes;
  std::vector<std::vector<Index3>> Leaves;
};

#endif
