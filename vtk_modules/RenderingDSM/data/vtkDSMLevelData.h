// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMLevelData_h
#define vtkDSMLevelData_h

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/levels/LevelLattice.h"
#include "DSMBricks/levels/LevelSource.h"
#include "DSMBricks/levels/LevelVoxels.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMRankGroup.h"

#include "vtkSmartPointer.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataObject;

/// The parts of a dataset whose cells are of several sizes that lie within one another, distributed over the ranks in any way.
/// Keeps the parts alive, without a copy. Methods documented as collective need every rank. Failures are dsm::Error, the same
/// on every rank.
class vtkDSMLevelData
{
public:
  using Choice = vtkDSMImageArrays::Choice;
  using Parts = std::vector<vtkSmartPointer<vtkDataObject>>;

  /// Local: whether a dataset is AMR or a hyper tree grid; it may have no cells on this rank.
  static bool IsOfLevels(vtkDataObject* data);
  /// Local: the parts of such a dataset, which have points or cells; none if the data are of another kind. Throws dsm::Error
  /// where parts of different kinds are together.
  static Parts GetParts(vtkDataObject* data);
  /// Collective. `parts`: this rank's. Returns null if no rank has any.
  static std::unique_ptr<vtkDSMLevelData> Create(
    const std::shared_ptr<vtkDSMRankGroup>& group, const Parts& parts);
  virtual ~vtkDSMLevelData();

  /// From the index space of the coarsest level.
  const glm::dmat4& GetIndexToWorld() const { return this->IndexToWorld; }
  /// Returns the bounds of all ranks' parts; uninitialized bounds (min > max) if there are none.
  void GetBounds(double bounds[6]) const;
  /// Local: a hash of where this rank's cells are.
  std::uint64_t HashPlaces() const;

  /// Collective. Cuts an array into bricks: `infos` tell of all ranks' parts. Null where no part has it.
  std::shared_ptr<const bricks::LevelVoxels> Publish(const Choice& choice,
    const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos,
    const std::function<void(double)>& progress) const;

protected:
  explicit vtkDSMLevelData(std::shared_ptr<vtkDSMRankGroup> group);
  /// Local: this rank's leaves, with the values of an array.
  virtual std::unique_ptr<bricks::LevelSource> CreateSource(const Choice& choice) const = 0;
  /// Local: adds where this rank's cells are.
  virtual void AddPlaces(bricks::ByteHash& hash) const = 0;
  /// Sets the place of the coarsest level. `origin`: of its point (0, 0, 0).
  void SetPlace(const glm::dvec3& origin, const glm::dmat3& direction, const glm::dvec3& spacing);

  std::shared_ptr<vtkDSMRankGroup> Group;
  bricks::LevelScales Scales;
  /// Bounds of all cells, in cells of the coarsest level; empty without any.
  glm::dvec3 Lower;
  glm::dvec3 Upper;

private:
  glm::dmat4 IndexToWorld{ 1.0 };
  mutable std::optional<std::uint64_t> PlacesHash; ///< set when it is first asked for
};

#endif
