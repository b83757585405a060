// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMTreeData_h
#define vtkDSMTreeData_h

#include "vtkDSMLevelData.h"

#include <memory>
#include <vector>

class vtkHyperTreeGrid;

/// Hyper tree grids in three dimensions, whose roots are equally spaced. Masked and ghost cells are not shown.
class vtkDSMTreeData final : public vtkDSMLevelData
{
public:
  /// Collective. `parts`: this rank's hyper tree grids.
  vtkDSMTreeData(const std::shared_ptr<vtkDSMRankGroup>& group, const Parts& parts);
  ~vtkDSMTreeData() override;

private:
  class Source;
  /// Where a grid's roots are; plain, for messages between ranks.
  struct Roots
  {
    double Origin[3];
    double Spacing[3];
    std::int64_t Cells[3];
    std::int64_t Branching;
    std::int64_t Levels;
  };
  static Roots Describe(vtkHyperTreeGrid* grid);
  void Place(const std::vector<Roots>& all, int firstOwn);

  void AddPlaces(bricks::ByteHash& hash) const override;
  std::unique_ptr<bricks::LevelSource> CreateSource(const Choice& choice) const override;

  std::vector<vtkSmartPointer<vtkHyperTreeGrid>> Grids;
  std::vector<bricks::Index3> FirstRoots; ///< of this rank's grids, among those of all
};

#endif
