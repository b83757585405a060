// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMJoinedImages_h
#define vtkDSMJoinedImages_h

#include "DSMBricks/build/LatticePlan.h"
#include "vtkDSMBlockLooks.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMPart.h"
#include "vtkDSMRankGroup.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

class vtkDataSet;

/// Images and rectilinear grids of all ranks, joined to lattices. Methods documented as collective need every rank.
/// Failures are dsm::Error, the same on every rank.
class vtkDSMJoinedImages
{
public:
  using Choice = vtkDSMImageArrays::Choice;
  struct Image
  {
    vtkSmartPointer<vtkDataSet> Data;
    int Leaf; ///< flat index in the rank's composite dataset; 0 without one
    vtkDSMBlockLook Look;
  };

  /// Collective. `images`: this rank's, which have points.
  vtkDSMJoinedImages(std::shared_ptr<vtkDSMRankGroup> group, std::vector<Image> images);

  /// Collective. Blocks that differ in the shown arrays at points that they have in common become lattices of their
  /// own. Returns whether any have points in common.
  bool SeparateBlocks(const vtkDSMImageArrays& arrays, const std::vector<Choice>& shown);
  /// Local. Returns a part for each lattice.
  std::vector<std::unique_ptr<vtkDSMPart>> CreateParts() const;

private:
  /// Distributes the coordinates of all rectilinear pieces, one piece and axis after the other.
  void SetCoordinates(const std::vector<double>& all);
  /// Local: a piece's image, if it is this rank's; else null.
  vtkDataSet* FindOwn(int piece) const;
  /// Local. Returns a hash of a piece's values at points of its lattice, in the shown arrays.
  std::uint64_t HashPoints(const bricks::LatticePlan::Member& member, const bricks::Box& points,
    const vtkDSMImageArrays& arrays, const std::vector<Choice>& shown) const;

  std::shared_ptr<vtkDSMRankGroup> Group;
  std::vector<Image> Images; ///< this rank's
  bricks::LatticePlan Plan;
  std::vector<bricks::PieceInfo> Pieces;                    ///< all ranks' pieces, in rank order
  std::vector<bricks::GridPlanes::Coordinates> Coordinates; ///< of the pieces that are rectilinear
  std::vector<vtkDSMBlockLook> Looks;                       ///< looks of the pieces, in their order
  int FirstOwnPiece = 0;
};

#endif
