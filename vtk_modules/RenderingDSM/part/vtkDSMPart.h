// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMPart_h
#define vtkDSMPart_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ByteHash.h"
#include "vtkDSMBlockLooks.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMOwnCells.h"
#include "vtkDSMOwnGrid.h"
#include "vtkDSMPartValues.h"
#include "vtkDSMRankGroup.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkAbstractArray;
class vtkBoundingBox;

/// A piece of a dataset that is shown as one field: a lattice, levels that lie within one another, or cells of any
/// shape. Its data may be on any ranks; every rank has the same parts in the same order. Keeps this rank's data alive,
/// without a copy. Methods documented as collective need every rank. Failures are dsm::Error, the same on every rank.
class vtkDSMPart
{
public:
  using Choice = vtkDSMImageArrays::Choice;
  using Info = vtkDSMImageArrays::Info;
  using OwnCells = std::vector<std::unique_ptr<vtkDSMOwnCells>>;
  using OwnGrids = std::vector<vtkDSMOwnGrid>;

  /// Appearance that was set for some cells, in indices of the part (of levels: of the coarsest).
  struct Block
  {
    bricks::Box Cells;
    vtkDSMBlockLook Look;
  };

  /// An array that is to be published.
  struct Request
  {
    Choice Array;
    std::string Purpose; ///< names the array in messages ("isosurface array")
    std::function<void(double)> Progress;

    std::string GetName() const { return "the " + this->Purpose + " '" + this->Array.Name + "'"; }
  };

  virtual ~vtkDSMPart();
  vtkDSMPart(const vtkDSMPart&) = delete;
  vtkDSMPart& operator=(const vtkDSMPart&) = delete;

  /// Adds the bounds of all ranks' pieces.
  void AddBounds(vtkBoundingBox& bounds) const;
  /// All ranks' blocks.
  const std::vector<Block>& GetBlocks() const { return this->BlockLooks; }
  /// Local, reads the data. Adds all that this rank's part of Publish depends on.
  virtual void AddContent(const Choice& choice, bricks::ByteHash& hash) const = 0;
  /// Local: what each of this rank's datasets has of an array.
  virtual std::vector<Info> FindArrays(const Choice& choice) const = 0;

  /// Collective. Cuts an array into bricks and sends them to their owners; null where no piece has it. `infos`:
  /// FindArrays of all ranks, in rank order. `old`: values for which MayTakeOver is true on all ranks, or null.
  /// Takes these over or releases them before memory is needed for the new ones.
  virtual std::shared_ptr<vtkDSMPartValues> Publish(const Request& request,
    const std::vector<Info>& infos, std::shared_ptr<vtkDSMPartValues> old) const = 0;
  /// Local: whether the memory of values may be used for others of the same array. Only one publication may have
  /// them.
  virtual bool MayTakeOver(const vtkDSMPartValues& old) const;
  /// Collective. Values of a coarser level of detail, the first of which is 1; null, on all ranks, where there is none.
  /// `finest`: the result of Publish for the same array.
  virtual std::shared_ptr<vtkDSMPartValues> PublishCoarser(
    const vtkDSMPartValues& finest, int level, const Request& request) const;

  /// Collective. Values of each level's box, the finest first, of levels that have one. `finest`: the result of
  /// Publish for the same array. `old`: the result of an earlier call, whose bricks are taken over where they are the
  /// same.
  using Boxed = std::vector<std::shared_ptr<vtkDSMPartValues>>;
  virtual Boxed PublishBoxes(const vtkDSMPartValues& finest, const vtkDSMNestedLevels::Boxes& boxes,
    const Request& request, const Boxed& old) const;

  /// Local. This rank's cells, with their datasets: for isosurfaces as triangles. `values`: of the array.
  virtual OwnCells FindOwnCells(const vtkDSMPartValues& values, const Choice& choice) const;
  /// Local. The same of cells of other shapes, in grids.
  virtual OwnGrids FindOwnGrids(const Choice& choice) const;

protected:
  explicit vtkDSMPart(std::shared_ptr<vtkDSMRankGroup> group);
  /// Adds the values of an array, which may be null.
  void AddArray(vtkAbstractArray* array, bricks::ByteHash& hash) const;

  std::shared_ptr<vtkDSMRankGroup> Group;
  /// From the part's index space, or the grid space of its planes.
  glm::dmat4 IndexToData{ 1.0 };
  ///@{
  /// Bounds of all cells, in index space; empty without any.
  glm::dvec3 Lower;
  glm::dvec3 Upper;
  ///@}
  std::vector<Block> BlockLooks;
};

#endif
