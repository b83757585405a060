// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMAmrPart_h
#define vtkDSMAmrPart_h

#include "DSMBricks/build/LatticePlan.h"
#include "vtkDSMLevelPart.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

class vtkImageData;

/// Adaptively refined blocks. Levels are found by the blocks' spacing. Cells that a finer block covers are not
/// shown, nor are ghost and blanked cells. If there is no finer block, a cell that is marked as refined is shown.
/// If blocks of a level overlap, the one of the lowest flat index counts, on whatever rank it is.
class vtkDSMAmrPart final : public vtkDSMLevelPart
{
public:
  /// Collective. `pieces`: this rank's images.
  vtkDSMAmrPart(const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces);
  ~vtkDSMAmrPart() override;

  std::unique_ptr<vtkDSMLevelSource> CreateSource(const Choice& choice) const override;

private:
  class Source;
  /// A block of any rank.
  struct Place
  {
    int Level;
    bricks::Box Cells; ///< of the level, without ghosts
  };

  void AddPlaces(bricks::ByteHash& hash) const override;
  void FindLevels();
  void FindPlaces();
  /// Local: for each cell of an own block whether it is a leaf.
  std::vector<std::uint8_t> FindLeaves(std::size_t own) const;

  std::vector<vtkSmartPointer<vtkImageData>> Blocks;
  std::vector<bricks::PieceInfo> Pieces; ///< all ranks' blocks, in rank order
  std::vector<Place> Places;             ///< likewise
  std::vector<std::size_t> Order;        ///< their indices, by the blocks' flat indices
  int FirstOwn = 0;
  std::vector<std::array<double, 3>> Spacings; ///< of the levels
};

#endif
