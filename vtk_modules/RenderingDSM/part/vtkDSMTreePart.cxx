// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTreePart.h"

#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace
{

using bricks::Index3;

/// Calls `visit(index, root)` for the trees of a grid.
template <class Visit>
void ForEachTree(vtkHyperTreeGrid* grid, const Visit& visit)
{
  vtkHyperTreeGrid::vtkHyperTreeGridIterator trees;
  trees.Initialize(grid);
  vtkIdType index = 0;
  while (trees.GetNextTree(index))
  {
    unsigned int root[3];
    grid->GetLevelZeroCoordinatesFromIndex(index, root[0], root[1], root[2]);
    visit(index, Index3(root[0], root[1], root[2]));
  }
}

/// Calls `visit(level, cell, id)` for the leaves of a grid that are shown: cells of their level, and the number of
/// their values.
class LeafWalk
{
public:
  explicit LeafWalk(vtkHyperTreeGrid* grid)
    : Grid(grid)
    , Branching(grid->GetBranchFactor())
    , Ghosts(vtkUnsignedCharArray::SafeDownCast(
        grid->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName())))
  {
  }

  /// Without the trees that are in `repeated`.
  template <class Visit>
  void Run(const std::set<vtkIdType>& repeated, const Visit& visit)
  {
    ForEachTree(this->Grid,
      [&](vtkIdType index, const Index3& root)
      {
        if (repeated.count(index) == 0)
        {
          this->RunTree(index, root, visit);
        }
      });
  }
  template <class Visit>
  void RunTree(vtkIdType index, const Index3& root, const Visit& visit)
  {
    this->Grid->InitializeNonOrientedCursor(this->Cursor, index);
    this->Descend(0, root, visit);
  }

private:
  template <class Visit>
  void Descend(int level, const Index3& cell, const Visit& visit)
  {
    if (this->Cursor->IsMasked())
    {
      return;
    }
    const vtkIdType id = this->Cursor->GetGlobalNodeIndex();
    if (this->Cursor->IsLeaf())
    {
      constexpr unsigned char hidden =
        vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
      if (!this->Ghosts || (this->Ghosts->GetValue(id) & hidden) == 0)
      {
        visit(level, cell, id);
      }
      return;
    }
    unsigned char child = 0;
    bricks::ForEachIndex({ Index3(0), Index3(this->Branching) },
      [&](const Index3& part)
      {
        this->Cursor->ToChild(child++);
        this->Descend(level + 1, cell * Index3(this->Branching) + part, visit);
        this->Cursor->ToParent();
      });
  }

  vtkHyperTreeGrid* Grid;
  std::int64_t Branching;
  vtkUnsignedCharArray* Ghosts;
  vtkNew<vtkHyperTreeGridNonOrientedCursor> Cursor;
};

} // namespace

/// This rank's leaves, with the values of one array.
class vtkDSMTreePart::Source final : public vtkDSMLevelSource
{
public:
  Source(const vtkDSMTreePart& data, const Choice& choice)
    : Component(choice.Component)
    , IsMissing(choice.Valid)
  {
    for (std::size_t own = 0; own < data.Grids.size(); ++own)
    {
      vtkDSMImageArrays::Info info;
      vtkDataArray* const array = vtkDSMImageArrays::Find(data.Grids[own], choice, info);
      this->Arrays.emplace_back(array);
      if (!array)
      {
        continue;
      }
      LeafWalk(data.Grids[own])
        .Run(data.Repeated[own],
          [&](int level, const Index3& cell, vtkIdType id) {
            this->Add(level, cell + data.FirstRoots[own] * data.Scales.Get(level), { id, own, 0 });
          });
    }
  }

  const std::vector<bricks::LevelCube>& GetCubes() const override { return this->Cubes.GetAll(); }
  bool IsOfPoints() const override { return false; }

  void ReadCube(std::size_t number, double* values, std::uint8_t* isLeaf) const override
  {
    constexpr std::int64_t edge = bricks::LevelLattice::Edge;
    std::fill_n(isLeaf, edge * edge * edge, std::uint8_t{ 0 });
    for (const Leaf& leaf : this->Leaves[number])
    {
      isLeaf[leaf.Place] = 1;
      const double value = this->GetValue(leaf);
      values[leaf.Place] =
        this->IsMissing(value) ? std::numeric_limits<double>::quiet_NaN() : value;
    }
  }

  std::vector<Cell> ReadCells(std::size_t number) const override
  {
    constexpr std::int64_t edge = bricks::LevelLattice::Edge;
    std::vector<Cell> found(edge * edge * edge);
    for (const Leaf& leaf : this->Leaves[number])
    {
      found[leaf.Place] = { static_cast<int>(leaf.Grid), leaf.Id };
    }
    return found;
  }

private:
  struct Leaf
  {
    vtkIdType Id;
    std::size_t Grid;
    std::uint16_t Place; ///< in the cube
  };

  double GetValue(const Leaf& leaf) const
  {
    vtkDataArray* const array = this->Arrays[leaf.Grid];
    return this->Component == vtkDSMImagePiece::Magnitude
      ? vtkDSMImagePiece::GetMagnitude(array, leaf.Id)
      : array->GetComponent(leaf.Id, this->Component);
  }

  void Add(int level, const Index3& cell, Leaf leaf)
  {
    constexpr std::int64_t edge = bricks::LevelLattice::Edge;
    const std::size_t number = this->Cubes.Find(level, cell);
    this->Leaves.resize(this->Cubes.GetAll().size());
    this->Cubes.Count(number, cell);
    const Index3 at = cell % Index3(edge);
    leaf.Place = static_cast<std::uint16_t>(at.x + edge * (at.y + edge * at.z));
    this->Leaves[number].push_back(leaf);
  }

  int Component;
  bricks::MissingTest<double> IsMissing;
  std::vector<vtkSmartPointer<vtkDataArray>> Arrays; ///< of the grids; some null
  bricks::LevelCubes Cubes;
  std::vector<std::vector<Leaf>> Leaves; ///< of the cubes
};

vtkDSMTreePart::vtkDSMTreePart(
  const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces)
  : vtkDSMLevelPart(group, pieces)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<Roots> mine;
  messenger.RunTogether("Reading the hyper trees",
    [&]
    {
      for (const Piece& piece : pieces)
      {
        this->Grids.emplace_back(vtkHyperTreeGrid::SafeDownCast(piece.Data));
        mine.push_back(Describe(piece));
      }
    });
  int first = 0;
  const std::vector<Roots> all = vtkDSMGather::Items(messenger, mine, first);
  messenger.RunTogether("Joining the hyper trees", [&] { this->Place(all, first); });
  this->FindRepeated(first);
}

vtkDSMTreePart::~vtkDSMTreePart() = default;

std::vector<vtkDSMLevelPart::OwnPieces> vtkDSMTreePart::Join(
  dsm::Messenger& messenger, const OwnPieces& pieces)
{
  std::vector<Roots> mine;
  messenger.RunTogether("Reading the hyper trees",
    [&]
    {
      for (const Piece& piece : pieces)
      {
        mine.push_back(Describe(piece));
      }
    });
  int firstOwn = 0;
  const std::vector<Roots> all = vtkDSMGather::Items(messenger, mine, firstOwn);
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return all[a].Dataset < all[b].Dataset; });

  struct Joined
  {
    std::vector<std::size_t> Grids;
    std::vector<bricks::Box> Trees; ///< of datasets, on the lattice of the first grid
    const Roots& GetFirst(const std::vector<Roots>& roots) const { return roots[this->Grids[0]]; }
  };
  std::vector<Joined> datasets;
  for (const std::size_t grid : order)
  {
    const auto same = std::find_if(datasets.begin(), datasets.end(),
      [&](const Joined& one)
      {
        return one.GetFirst(all).Dataset == all[grid].Dataset &&
          FindFirst(all[grid], one.GetFirst(all));
      });
    if (same == datasets.end())
    {
      datasets.push_back({ { grid }, { all[grid].Trees } });
      continue;
    }
    const Index3 first = *FindFirst(all[grid], same->GetFirst(all));
    bricks::Box& trees = same->Trees.front();
    trees.Min = glm::min(trees.Min, all[grid].Trees.Min + first);
    trees.Max = glm::max(trees.Max, all[grid].Trees.Max + first);
    same->Grids.push_back(grid);
  }
  std::vector<Joined> unions;
  for (const Joined& dataset : datasets)
  {
    bool isJoined = false;
    for (Joined& one : unions)
    {
      const auto first = FindFirst(dataset.GetFirst(all), one.GetFirst(all));
      const bricks::Box& own = dataset.Trees.front();
      const bricks::Box trees{ own.Min + first.value_or(Index3(0)),
        own.Max + first.value_or(Index3(0)) };
      isJoined = first &&
        std::all_of(one.Trees.begin(), one.Trees.end(),
          [&](const bricks::Box& other) { return bricks::Intersect(trees, other).IsEmpty(); });
      if (isJoined)
      {
        one.Trees.push_back(trees);
        one.Grids.insert(one.Grids.end(), dataset.Grids.begin(), dataset.Grids.end());
        break;
      }
    }
    if (!isJoined)
    {
      unions.push_back(dataset);
    }
  }
  std::vector<OwnPieces> joined;
  for (const Joined& one : unions)
  {
    OwnPieces& own = joined.emplace_back();
    for (const std::size_t grid : one.Grids)
    {
      const auto number = static_cast<std::int64_t>(grid) - firstOwn;
      if (number >= 0 && number < static_cast<std::int64_t>(pieces.size()))
      {
        own.push_back(pieces[static_cast<std::size_t>(number)]);
      }
    }
  }
  return joined;
}

vtkDSMTreePart::Roots vtkDSMTreePart::Describe(const Piece& piece)
{
  auto* const grid = vtkHyperTreeGrid::SafeDownCast(piece.Data);
  if (grid->GetDimension() != 3)
  {
    throw dsm::Error("A hyper tree grid of " + std::to_string(grid->GetDimension()) +
      " dimensions has no isosurfaces. Show its surface.");
  }
  Roots roots{};
  vtkDataArray* const axes[3] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
    grid->GetZCoordinates() };
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkIdType last = axes[axis]->GetNumberOfTuples() - 1;
    roots.Cells[axis] = last;
    roots.Origin[axis] = axes[axis]->GetComponent(0, 0);
    const double length = axes[axis]->GetComponent(last, 0) - roots.Origin[axis];
    roots.Spacing[axis] = length / static_cast<double>(last);
    for (vtkIdType point = 0; point <= last; ++point)
    {
      const double even = roots.Origin[axis] + static_cast<double>(point) * roots.Spacing[axis];
      if (!(std::abs(axes[axis]->GetComponent(point, 0) - even) <= 1e-3 * roots.Spacing[axis]))
      {
        throw dsm::Error("The roots of the hyper tree grid are not equally spaced, which ray "
                         "tracing requires. Apply "
                         "Resample To Image first.");
      }
    }
  }
  roots.Branching = grid->GetBranchFactor();
  roots.Levels = static_cast<std::int64_t>(grid->GetNumberOfLevels());
  roots.Trees = { Index3(std::numeric_limits<std::int64_t>::max()), Index3(0) };
  ForEachTree(grid,
    [&](vtkIdType, const Index3& root)
    {
      roots.Trees.Min = glm::min(roots.Trees.Min, root);
      roots.Trees.Max = glm::max(roots.Trees.Max, root + Index3(1));
    });
  roots.Dataset = piece.Dataset;
  roots.Look = piece.Look;
  return roots;
}

std::optional<Index3> vtkDSMTreePart::FindFirst(const Roots& roots, const Roots& other)
{
  Index3 first;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double spacing = other.Spacing[axis];
    const double exact = (roots.Origin[axis] - other.Origin[axis]) / spacing;
    first[axis] = std::llround(exact);
    if (!(std::abs(exact - static_cast<double>(first[axis])) < 0.05) ||
      !(std::abs(roots.Spacing[axis] - spacing) < 1e-3 * spacing) ||
      roots.Branching != other.Branching)
    {
      return std::nullopt;
    }
  }
  return first;
}

void vtkDSMTreePart::Place(const std::vector<Roots>& all, int firstOwn)
{
  const Roots& one = all.front();
  const glm::dvec3 spacing(one.Spacing[0], one.Spacing[1], one.Spacing[2]);
  const glm::dvec3 anchor(one.Origin[0], one.Origin[1], one.Origin[2]);
  std::vector<Index3> firsts;
  Index3 least(0);
  std::int64_t levels = 1;
  for (const Roots& roots : all)
  {
    const Index3 first = *FindFirst(roots, one);
    firsts.push_back(first);
    least = glm::min(least, first);
    levels = std::max(levels, roots.Levels);
  }
  std::vector<Index3> scales{ Index3(1) };
  while (static_cast<std::int64_t>(scales.size()) < levels)
  {
    scales.push_back(scales.back() * Index3(one.Branching));
  }
  this->Scales = bricks::LevelScales(std::move(scales));
  for (std::size_t number = 0; number < all.size(); ++number)
  {
    const Index3 first = firsts[number] - least;
    const Index3 end =
      first + Index3(all[number].Cells[0], all[number].Cells[1], all[number].Cells[2]);
    this->BlockLooks.push_back(
      { { all[number].Trees.Min + first, all[number].Trees.Max + first }, all[number].Look });
    this->Lower = glm::min(this->Lower, glm::dvec3(first));
    this->Upper = glm::max(this->Upper, glm::dvec3(end));
    const std::size_t begin = static_cast<std::size_t>(firstOwn);
    if (number >= begin && number < begin + this->Grids.size())
    {
      this->FirstRoots.push_back(first);
    }
  }
  this->SetPlace(anchor + glm::dvec3(least) * spacing, glm::dmat3(1.0), spacing);
}

void vtkDSMTreePart::FindRepeated(int firstOwn)
{
  struct Tree
  {
    Index3 Root;
    std::int64_t Grid; ///< among those of all ranks
    std::uint64_t Leaves;
    std::int64_t Index;
  };
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<Tree> mine;
  messenger.RunTogether("Comparing the hyper trees",
    [&]
    {
      for (std::size_t own = 0; own < this->Grids.size(); ++own)
      {
        const std::size_t number = static_cast<std::size_t>(firstOwn) + own;
        ForEachTree(this->Grids[own],
          [&](vtkIdType index, const Index3& inGrid)
          {
            const Index3 root = inGrid + this->FirstRoots[own];
            const bricks::Box box{ root, root + Index3(1) };
            bool isBeside = false;
            for (std::size_t other = 0; other < this->BlockLooks.size() && !isBeside; ++other)
            {
              isBeside =
                other != number && !bricks::Intersect(this->BlockLooks[other].Cells, box).IsEmpty();
            }
            if (!isBeside)
            {
              return;
            }
            bricks::ByteHash hash;
            bool isAny = false;
            LeafWalk(this->Grids[own])
              .RunTree(index, root,
                [&](int level, const Index3& cell, vtkIdType)
                {
                  const std::int64_t leaf[] = { level, cell.x, cell.y, cell.z };
                  hash.Add(leaf, sizeof(leaf));
                  isAny = true;
                });
            if (isAny)
            {
              mine.push_back({ root, static_cast<std::int64_t>(number), hash.Get(), index });
            }
          });
      }
    });
  this->Repeated.resize(this->Grids.size());
  std::set<std::array<std::int64_t, 4>> known;
  for (const Tree& tree : vtkDSMGather::Items(messenger, mine))
  {
    const bool isFirst =
      known
        .insert({ tree.Root.x, tree.Root.y, tree.Root.z, static_cast<std::int64_t>(tree.Leaves) })
        .second;
    const std::int64_t own = tree.Grid - firstOwn;
    if (!isFirst && own >= 0 && own < static_cast<std::int64_t>(this->Grids.size()))
    {
      this->Repeated[static_cast<std::size_t>(own)].insert(tree.Index);
    }
  }
}

void vtkDSMTreePart::AddPlaces(bricks::ByteHash& hash) const
{
  const int levels = this->Scales.GetCount();
  const Index3 finest = this->Scales.Get(levels - 1);
  hash.Add(&levels, sizeof(levels));
  hash.Add(&finest, sizeof(finest));
  for (std::size_t own = 0; own < this->Grids.size(); ++own)
  {
    const Index3& first = this->FirstRoots[own];
    hash.Add(&first, sizeof(first));
    LeafWalk(this->Grids[own])
      .Run(this->Repeated[own],
        [&](int level, const Index3& cell, vtkIdType id)
        {
          const std::int64_t leaf[] = { level, cell.x, cell.y, cell.z, id };
          hash.Add(leaf, sizeof(leaf));
        });
  }
}

std::unique_ptr<vtkDSMLevelSource> vtkDSMTreePart::CreateSource(const Choice& choice) const
{
  return std::make_unique<Source>(*this, choice);
}
