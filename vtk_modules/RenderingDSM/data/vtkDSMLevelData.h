// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMLevelData_h
#define vtkDSMLevelData_h

#include "DSMBricks/build/LatticePlan.h"
#include "DSMBricks/levels/LevelLattice.h"
#include "DSMBricks/levels/LevelVoxels.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMRankGroup.h"

#include "vtkSmartPointer.h"

#include <glm/mat4x4.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkImageData;

/// A dataset of images of several sizes of cells that lie within one another, such as AMR, distributed over the ranks in any
/// way: its levels are found by the spacing of its blocks. Cells that a finer block covers are not shown, nor are ghost and
/// blanked cells; where no finer block is there, a cell that is marked as refined is shown. Keeps the images alive, without a
/// copy. Methods documented as collective need every rank. Failures are dsm::Error, the same on every rank.
class vtkDSMLevelData
{
public:
  using Choice = vtkDSMImageArrays::Choice;

  /// Local: whether a dataset is of this kind.
  static bool IsOfLevels(vtkDataObject* data);
  /// Local: its blocks that have points.
  static std::vector<vtkSmartPointer<vtkImageData>> GetBlocks(vtkDataObject* data);

  /// Collective. `blocks`: this rank's.
  vtkDSMLevelData(const std::shared_ptr<vtkDSMRankGroup>& group,
    std::vector<vtkSmartPointer<vtkImageData>> blocks);
  ~vtkDSMLevelData();

  /// From the index space of the coarsest level.
  const glm::dmat4& GetIndexToWorld() const { return this->IndexToWorld; }
  /// Returns the bounds of all ranks' blocks; uninitialized bounds (min > max) if there are none.
  void GetBounds(double bounds[6]) const;
  /// Returns all ranks' blocks, whose order says which of those that overlap counts.
  const std::vector<bricks::PieceInfo>& GetPieces() const { return this->Pieces; }

  /// Collective. Cuts an array into bricks: `infos` tell of all ranks' blocks. Null where no block has it.
  std::shared_ptr<const bricks::LevelVoxels> Publish(const Choice& choice,
    const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos,
    const std::function<void(double)>& progress) const;

private:
  class Source;
  /// A block of any rank.
  struct Place
  {
    int Level;
    bricks::Box Cells; ///< of the level, without ghosts
  };

  void FindLevels();
  void FindPlaces();
  /// Local: for each cell of an own block whether it is a leaf.
  std::vector<std::uint8_t> FindLeaves(std::size_t own) const;

  std::shared_ptr<vtkDSMRankGroup> Group;
  std::vector<vtkSmartPointer<vtkImageData>> Blocks;
  std::vector<bricks::PieceInfo> Pieces; ///< all ranks' blocks, in rank order
  std::vector<Place> Places;             ///< likewise
  int FirstOwn = 0;
  bricks::LevelScales Scales;
  std::vector<std::array<double, 3>> Spacings; ///< of the levels
  glm::dmat4 IndexToWorld{ 1.0 };
};

#endif
