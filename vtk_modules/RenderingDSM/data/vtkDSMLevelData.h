// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMLevelData_h
#define vtkDSMLevelData_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/levels/LevelLattice.h"
#include "DSMBricks/levels/LevelSource.h"
#include "DSMBricks/levels/LevelVoxels.h"
#include "vtkDSMBlockLooks.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMRankGroup.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataObject;

/// The leaves that one rank has, and which cells of its parts they are.
class vtkDSMLevelSource : public bricks::LevelSource
{
public:
  /// A cell of a part.
  struct Cell
  {
    int Part = -1; ///< index into vtkDSMLevelData::GetParts; -1: not a leaf of this rank
    vtkIdType Id = -1;
  };
  /// Reads which cells of this rank's parts are the cells of cube `number` of GetCubes: Edge^3, x fastest.
  virtual std::vector<Cell> ReadCells(std::size_t number) const = 0;
};

/// Parts of a dataset whose cells are of several sizes that lie within one another, with one coarsest level in
/// common, distributed over the ranks in any way. Keeps the parts alive, without a copy. Methods documented as
/// collective need every rank. Failures are dsm::Error, the same on every rank.
class vtkDSMLevelData
{
public:
  using Choice = vtkDSMImageArrays::Choice;
  struct Part
  {
    vtkSmartPointer<vtkDataObject> Data; ///< a hyper tree grid with cells, or an image of AMR
    /// Flat index of what it is a piece of, in the rank's composite dataset; 0 without one. Pieces
    /// of one hyper tree grid have the same on all ranks, and a block of AMR has its own.
    std::int64_t Dataset = 0;
    vtkDSMBlockLook Look = {};
  };
  using Parts = std::vector<Part>;
  /// Appearance that was set for some cells, in indices of the coarsest level.
  struct Block
  {
    bricks::Box Cells;
    vtkDSMBlockLook Look;
  };

  /// Collective. `parts`: this rank's. AMR is one; hyper tree grids are one where their roots are on one lattice
  /// and do not overlap.
  static std::vector<std::unique_ptr<vtkDSMLevelData>> Create(
    const std::shared_ptr<vtkDSMRankGroup>& group, const Parts& parts);
  virtual ~vtkDSMLevelData();

  /// From the index space of the coarsest level.
  const glm::dmat4& GetIndexToWorld() const { return this->IndexToWorld; }
  /// Returns the bounds of all ranks' parts; uninitialized bounds (min > max) if there are none.
  void GetBounds(double bounds[6]) const;
  /// All ranks' blocks.
  const std::vector<Block>& GetBlocks() const { return this->BlockLooks; }
  /// Local: adds this rank's cells and their values.
  void AddContent(const Choice& choice, int threads, bricks::ByteHash& hash) const;

  /// Local: whether this rank's parts have an array.
  std::vector<vtkDSMImageArrays::Info> FindArrays(const Choice& choice) const;
  /// Local: this rank's leaves in the parts that have an array, with its values.
  std::unique_ptr<vtkDSMLevelSource> FindLeaves(const Choice& choice) const
  {
    return this->CreateSource(this->Find(choice));
  }
  /// Local: this rank's parts.
  const std::vector<vtkSmartPointer<vtkDataObject>>& GetParts() const { return this->Own; }
  /// Collective. Cuts an array into bricks: `infos` is FindArrays of all ranks. Null where no part has it. An array
  /// of points that the parts do not have is the array of cells of that name.
  std::shared_ptr<const bricks::LevelVoxels> Publish(const Choice& choice,
    const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos,
    const std::function<void(double)>& progress) const;

protected:
  /// Collective.
  vtkDSMLevelData(std::shared_ptr<vtkDSMRankGroup> group, const Parts& parts);
  /// Local: the same, of an array as the parts have it.
  virtual std::unique_ptr<vtkDSMLevelSource> CreateSource(const Choice& choice) const = 0;
  /// Local: adds where this rank's cells are.
  virtual void AddPlaces(bricks::ByteHash& hash) const = 0;
  /// Sets the place of the coarsest level. `origin`: of its point (0, 0, 0).
  void SetPlace(const glm::dvec3& origin, const glm::dmat3& direction, const glm::dvec3& spacing);

  std::shared_ptr<vtkDSMRankGroup> Group;
  bricks::LevelScales Scales;
  /// Bounds of all cells, in cells of the coarsest level; empty without any.
  glm::dvec3 Lower;
  glm::dvec3 Upper;
  std::vector<Block> BlockLooks;

private:
  /// The array as the parts have it.
  Choice Find(const Choice& choice) const;
  std::uint64_t HashPlaces() const;

  std::vector<vtkSmartPointer<vtkDataObject>> Own;
  vtkDSMImageArrays Arrays;
  glm::dmat4 IndexToWorld{ 1.0 };
  mutable std::optional<std::uint64_t> PlacesHash; ///< set when it is first asked for
};

#endif
