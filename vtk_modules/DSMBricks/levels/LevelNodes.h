// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LevelNodes_h
#define bricks_LevelNodes_h

#include "DSMBricks/levels/LevelLattice.h"

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace bricks
{

/// A leaf whose level differs from a brick's, for messages between ranks. Plain.
struct ForeignLeaf
{
  std::int32_t Level;
  std::int32_t Cell[3]; ///< of its level
  /// Values at its corners, x in bit 0, y in bit 1, z in bit 2; where values are of cells, all are alike.
  double Values[8];
};

/// Numbers in the type of samples that is Float32 or Float64.
class LevelNumbers
{
public:
  explicit LevelNumbers(ScalarType type)
    : IsFloat(type == ScalarType::Float32)
  {
  }
  /// Sets all of them to 0.
  void Assign(std::size_t count)
  {
    this->Floats.assign(this->IsFloat ? count : 0, 0.0f);
    this->Doubles.assign(this->IsFloat ? 0 : count, 0.0);
  }
  /// Gives the memory back.
  void Free() { *this = LevelNumbers(this->IsFloat ? ScalarType::Float32 : ScalarType::Float64); }
  std::size_t GetCount() const { return this->Floats.size() + this->Doubles.size(); }
  double Get(std::size_t index) const
  {
    return this->IsFloat ? static_cast<double>(this->Floats[index]) : this->Doubles[index];
  }
  void Set(std::size_t index, double value)
  {
    if (this->IsFloat)
    {
      this->Floats[index] = static_cast<float>(value);
    }
    else
    {
      this->Doubles[index] = value;
    }
  }

private:
  bool IsFloat;
  std::vector<float> Floats;
  std::vector<double> Doubles;
};

/// The values at the points of a brick's leaves, from those of the leaves around them.
///
/// All leaves together carry one continuous function, which is trilinear in each of them: like the conforming
/// spaces of finite elements with hanging nodes (Gupta, A finite element for transition from a fine to a coarse
/// grid, 1978). A point that is a corner of all leaves that it touches has their mean: a leaf counts once for each
/// of the eight octants around the point that it fills, and the less the larger it is, so that a linear function
/// keeps its values across levels. Where values are of points, it has the one of the smallest leaf. A point that
/// lies within a face or an edge of a larger leaf hangs: it has the value that the largest such leaf has there. So
/// a leaf's value on a face is the same from both sides, whatever the levels, up to the rounding of hanging points
/// to the type of the samples.
///
/// Where nothing is beyond a point, the mean of the values of cells is one half a cell inside. The
/// function goes on to the border as it is from there to the next point inside, so that a linear
/// one keeps its values, but not beyond those of all cells.
///
/// Calls come in the order of declaration. The results do not depend on the order of the leaves.
class LevelNodes
{
public:
  /// Keeps a reference.
  LevelNodes(const LevelLattice& lattice, dsm::BlockId id, bool ofPoints);

  ///@{
  /// Leaves of the brick's own level, in it or beside it: of the cells of `box`, those of `isLeaf`. `values`: of
  /// the cells, or of their points.
  void AddLeaves(const Box& box, const double* values, const std::uint8_t* isLeaf);
  /// After all of the brick's level: a leaf that touches the brick; ignored where it touches none of its leaves.
  void AddLeaf(const ForeignLeaf& leaf);
  ///@}
  /// When all are there: finds the values of points that do not hang.
  void FindMeans();
  /// The values at the corners of a larger leaf that touches the brick, which are final.
  void AddCorners(const ForeignLeaf& leaf);
  /// When those of all larger leaves are there: finds the values of points that hang. Throws dsm::Error if one is
  /// missing.
  void FindHanging();
  /// Then finds the values of points at the border. `limits`: the smallest and the largest value of all cells.
  void ExtendToBorder(const std::array<double, 2>& limits);

  /// Calls `visit(ForeignLeaf)` for the brick's leaves that touch a box of cells of another level, with their
  /// corners' values.
  template <class Visit>
  void ForEachLeafTouching(int level, const Box& box, const Visit& visit) const
  {
    const Index3 from = this->Lattice.GetScales().Get(level);
    const Index3 to = this->Lattice.GetScales().Get(this->Brick.Level);
    const Box near{ DivideDown(box.Min * to - from, from), DivideUp(box.Max * to + from, from) };
    ForEachIndex(Intersect(near, this->Brick.Cells),
      [&](const Index3& cell)
      {
        const bool touches = glm::all(glm::lessThanEqual(cell * from, box.Max * to)) &&
          glm::all(glm::lessThanEqual(box.Min * to, (cell + Index3(1)) * from));
        if (touches && this->IsLeaf(cell))
        {
          visit(this->GetLeaf(cell));
        }
      });
  }

  const LevelBrick& GetBrick() const { return this->Brick; }
  bool IsLeaf(const Index3& cell) const
  {
    return this->Levels[this->GetAround(cell)] == this->Brick.Level;
  }
  /// When all leaves are there. See VoxelBrickHeader.
  std::uint8_t FindBorders() const;
  /// The values at the points of the brick, x fastest. Points that no leaf touches have 0.
  const LevelNumbers& GetValues() const { return this->Values; }

private:
  enum Special : std::int8_t
  {
    Nothing = -1,
    Smaller = 127 ///< smaller leaves
  };
  /// The smaller leaf at a corner of a cell.
  struct Corner
  {
    double Value = 0.0;
    int Level = Nothing;
  };
  /// A point with nothing beyond it.
  struct BorderPoint
  {
    Index3 Point;
    Index3 Next;  ///< the next one inside
    double Reach; ///< distance of the mean's place, where the one from there to Next is 1
  };
  /// Level, z, y, x.
  using Place = std::tuple<int, std::int64_t, std::int64_t, std::int64_t>;
  static Place GetPlace(int level, const Index3& cell) { return { level, cell.z, cell.y, cell.x }; }

  /// The index of a cell, which may be one beyond the brick.
  std::size_t GetAround(const Index3& cell) const
  {
    const Index3 at = cell - this->Around.Min;
    return static_cast<std::size_t>(at.x + this->AroundSize.x * (at.y + this->AroundSize.y * at.z));
  }
  std::size_t GetPoint(const Index3& point) const
  {
    const Index3 at = point - this->Brick.Cells.Min;
    const Index3 size = this->Brick.Cells.GetSize() + Index3(1);
    return static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z));
  }
  bool TouchesLeaf(const Index3& cell) const;
  /// For values of points: that of a leaf of the level at one of its corners.
  void OfferValue(const Index3& point, int level, double value);
  ForeignLeaf GetLeaf(const Index3& cell) const;
  /// Returns the leaf that fills an octant of a point.
  Corner GetOctant(const Index3& point, int octant) const;
  /// Its level, or Smaller.
  int GetOctantLevel(const Index3& point, int octant) const;
  std::size_t CountPoints() const;
  /// The value that a leaf of a coarser level has at the point; false if it is not known.
  bool Interpolate(const Index3& point, int level, const Index3& leaf, double& value) const;
  void FindMean(const Index3& point);

  const LevelLattice& Lattice;
  LevelBrick Brick;
  bool OfPoints;
  Box Around; ///< the brick's cells and one more on each side
  Index3 AroundSize;
  std::vector<std::int8_t> Levels; ///< of the leaf that has a cell of Around, or Special
  LevelNumbers
    CellValues; ///< of those that one leaf has, until FindMeans; none if values are of points
  std::map<std::size_t, std::array<Corner, 8>>
    Smalls;                                      ///< at the corners of cells of smaller leaves
  std::map<Place, std::array<double, 8>> Larger; ///< corners' values of larger leaves
  LevelNumbers Values;
  std::vector<std::int8_t>
    Known; ///< of points: level of the leaf whose value it is, for values of points
  std::vector<Index3> Hanging;
  std::vector<BorderPoint> Border;
};

} // namespace bricks

#endif
