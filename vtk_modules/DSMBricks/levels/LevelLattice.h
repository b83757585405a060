// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LevelLattice_h
#define bricks_LevelLattice_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockDirectory.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bricks
{

/// Lattices of cells of different size in the same space: level 0 has the largest cells, and a level's cells divide
/// each cell of the one before into the same whole number of parts on an axis. Cell and point (0, 0, 0) of all
/// levels are at the same place.
class LevelScales
{
public:
  LevelScales() = default;
  /// `scales`: cells of a level on each axis for one of level 0; those of a level are multiples of those before.
  explicit LevelScales(std::vector<Index3> scales);

  int GetCount() const { return static_cast<int>(this->Scales.size()); }
  const Index3& Get(int level) const { return this->Scales[static_cast<std::size_t>(level)]; }
  /// Edge length of a cube with as much volume as a cell of a level, where one of level 0 has 1.
  double GetSize(int level) const { return this->Sizes[static_cast<std::size_t>(level)]; }
  /// Cells of the finer level for one of the coarser, on each axis.
  Index3 GetRatio(int coarser, int finer) const { return this->Get(finer) / this->Get(coarser); }
  bool operator==(const LevelScales& other) const { return this->Scales == other.Scales; }

private:
  std::vector<Index3> Scales;
  std::vector<double> Sizes;
};

/// Rounds towards minus infinity.
Index3 DivideDown(const Index3& number, const Index3& by);
/// Rounds towards infinity.
Index3 DivideUp(const Index3& number, const Index3& by);

/// The leaves of some levels, cells that no finer ones cover, among the cells of one cube of LevelLattice::Edge.
/// Plain, for messages between ranks.
struct LevelCube
{
  std::int32_t Level;
  std::int32_t Place[3]; ///< cubes from the one at (0, 0, 0)
  /// Bounds of the leaves, as cells of the cube, half-open.
  std::uint8_t Min[3];
  std::uint8_t Max[3];
  /// Number of leaves in each part of LevelLattice::PartEdge cells, x fastest.
  std::uint8_t Leaves[64];
  std::uint8_t Unused[2];

  /// Counts a leaf; `cell`: of the cube.
  void Count(const Index3& cell);
};

/// A brick of one level: a box of cells, some of which may be no leaves.
struct LevelBrick
{
  Box Cells; ///< of the level
  int Level;
  bool HasMask; ///< some cells are no leaves

  bool Has(const Index3& cell) const { return this->Cells.Has(cell); }
};

/// How the leaves of all levels are cut into bricks. A brick lies in one cube of cells of its level; its bounds are
/// shrunk to the leaves in it, and a cube whose leaves are far apart becomes several. Depends on the leaves alone,
/// not on what rank has which. Bricks are numbered level by level.
class LevelLattice
{
public:
  static constexpr std::int64_t Edge = 16;
  static constexpr int EdgeShift = 4;
  static constexpr std::int64_t PartEdge = 4;

  LevelLattice() = default;
  /// `cubes`: of all ranks, in any order; those of one cube are joined.
  LevelLattice(LevelScales scales, const std::vector<LevelCube>& cubes, ScalarType type);

  const LevelScales& GetScales() const { return this->Scales; }
  ScalarType GetScalarType() const { return this->Type; }
  const std::vector<LevelBrick>& GetBricks() const { return this->Bricks; }
  const LevelBrick& GetBrick(dsm::BlockId id) const
  {
    return this->Bricks[static_cast<std::size_t>(id)];
  }
  dsm::BlockId GetBrickCount() const { return this->Bricks.size(); }
  /// The bricks of a level are [first, second).
  std::pair<dsm::BlockId, dsm::BlockId> GetBricksOf(int level) const
  {
    const auto index = static_cast<std::size_t>(level);
    return { this->Begins[index], this->Begins[index + 1] };
  }
  /// Bounds of all leaves, in cells of level 0.
  const std::array<glm::dvec3, 2>& GetBounds() const { return this->Bounds; }
  std::uint64_t CountLeaves() const { return this->Leaves; }

  /// The number of no brick.
  static constexpr dsm::BlockId None = ~dsm::BlockId{ 0 };
  /// The brick of a level that has a cell; None. The cell may be no leaf.
  dsm::BlockId Find(int level, const Index3& cell) const;

  /// Calls `visit(id, brick)` for the bricks of `level` that have a point in common with the box of cells of
  /// `ofLevel`; points on their boundaries count.
  template <class Visit>
  void ForEachTouching(int ofLevel, const Box& box, int level, const Visit& visit) const
  {
    const Index3 from = this->Scales.Get(ofLevel);
    const Index3 to = this->Scales.Get(level);
    const auto [begin, end] = this->GetBricksOf(level);
    const auto touches = [&](const LevelBrick& brick)
    {
      return glm::all(glm::lessThanEqual(brick.Cells.Min * from, box.Max * to)) &&
        glm::all(glm::lessThanEqual(box.Min * to, brick.Cells.Max * from));
    };
    const Box cubes{ DivideDown(DivideDown(box.Min * to, from) - Index3(1), Index3(Edge)),
      DivideDown(DivideUp(box.Max * to, from), Index3(Edge)) + Index3(1) };
    if (cubes.GetCount() > static_cast<std::int64_t>(end - begin))
    {
      for (dsm::BlockId id = begin; id < end; ++id)
      {
        if (touches(this->GetBrick(id)))
        {
          visit(id, this->GetBrick(id));
        }
      }
      return;
    }
    ForEachIndex(cubes,
      [&](const Index3& cube)
      {
        const auto found = this->Cubes.find(Key{ level, cube });
        if (found == this->Cubes.end())
        {
          return;
        }
        for (dsm::BlockId id = found->second.first; id < found->second.second; ++id)
        {
          if (touches(this->GetBrick(id)))
          {
            visit(id, this->GetBrick(id));
          }
        }
      });
  }

  std::uint32_t GetBlockBytes(dsm::BlockId id) const;
  /// Bricks are dealt one by one.
  dsm::BlockDirectory CreateDirectory(int ranks) const;

private:
  struct Key
  {
    int Level;
    Index3 Cube;
    bool operator==(const Key& other) const
    {
      return this->Level == other.Level && this->Cube == other.Cube;
    }
  };
  struct KeyHash
  {
    std::size_t operator()(const Key& key) const
    {
      const auto mix = [](std::uint64_t hash, std::int64_t number)
      { return (hash ^ static_cast<std::uint64_t>(number)) * 0x9e3779b97f4a7c15u; };
      std::uint64_t hash = mix(0, key.Level + 1);
      hash = mix(hash ^ hash >> 29, key.Cube.x);
      hash = mix(hash ^ hash >> 29, key.Cube.y);
      hash = mix(hash ^ hash >> 29, key.Cube.z);
      return static_cast<std::size_t>(hash ^ hash >> 32);
    }
  };

  /// Adds the bricks of a cube. `parts`: a box of its parts.
  void Cut(const LevelCube& cube, Box parts);

  LevelScales Scales;
  ScalarType Type = ScalarType::Float32;
  std::vector<LevelBrick> Bricks;
  std::vector<dsm::BlockId> Begins; ///< one for each level, and the end
  std::unordered_map<Key, std::pair<dsm::BlockId, dsm::BlockId>, KeyHash> Cubes;
  std::array<glm::dvec3, 2> Bounds{};
  std::uint64_t Leaves = 0;
};

/// Calls `function(T{})` with the C++ type of the lattice's samples.
template <class Function>
decltype(auto) DispatchSamples(const LevelLattice& lattice, Function&& function)
{
  return lattice.GetScalarType() == ScalarType::Float32 ? function(float{}) : function(double{});
}

} // namespace bricks

#endif
