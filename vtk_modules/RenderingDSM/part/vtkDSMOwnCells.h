// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMOwnCells_h
#define vtkDSMOwnCells_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMCore/base/Block.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/scene/FieldReader.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <memory>
#include <vector>

class vtkDataObject;
class vtkDataSet;

/// Cells of this rank's datasets that isosurfaces meet, in their order, with values from published bricks of
/// voxels. One thread.
class vtkDSMOwnCells
{
public:
  /// A cell. Corners: x in bit 0, y in bit 1, z in bit 2.
  struct Cell
  {
    double Values[8];     ///< finite
    glm::dvec3 Places[8]; ///< affine, in the space of the data
    vtkIdType Points[8];  ///< numbers of the corners in their dataset; -1 where it has no points
    vtkIdType Id;         ///< number of the cell in its dataset
    std::size_t Dataset;  ///< index into GetDatasets
  };
  using Datasets = std::vector<vtkSmartPointer<vtkDataObject>>;

  virtual ~vtkDSMOwnCells();

  /// The datasets that have the cells: images, rectilinear grids, hyper tree grids.
  const Datasets& GetDatasets() const { return this->Sets; }
  /// The dataset whose points and cells have the values that color the picture; null where only bricks have these.
  virtual vtkDataSet* GetColored() const { return nullptr; }
  /// Bounds of the cells, in the space of the data.
  const double* GetBounds() const { return this->Bounds; }

  /// Local. Finds the bricks that may have a surface, for ForEach. Returns how many cells they have, about.
  vtkIdType FindBricks(const std::vector<double>& isovalues);
  /// Reads these bricks. Calls `visit` for each cell of this rank that is shown and that an isosurface meets.
  void ForEach(rt::FieldReader& reader, dsm::FunctionRef<void(const Cell&)> visit);

protected:
  explicit vtkDSMOwnCells(Datasets datasets);
  /// Adds to Ids the bricks that this rank's cells are in.
  virtual void AddBricks(const rt::IsovaluePredicate& mayHold) = 0;
  /// The next cells are of brick Ids[number], which has so many on each axis.
  virtual void Begin(std::size_t number, const bricks::Index3& cells) = 0;
  /// Completes a cell, except for its values. `in`: its index in the brick. Returns false for a cell that is not
  /// shown, or is another rank's.
  virtual bool Complete(const bricks::Index3& in, Cell& cell) const = 0;

  /// Calls `visit(corner, offset)`.
  template <class Visit>
  static void ForEachCorner(const Visit& visit)
  {
    for (int corner = 0; corner < 8; ++corner)
    {
      visit(corner, bricks::Index3(corner & 1, corner >> 1 & 1, corner >> 2));
    }
  }

  Datasets Sets;
  double Bounds[6];
  std::shared_ptr<const dsm::BlockSegment> Segment;
  bricks::ScalarType Type = bricks::ScalarType::Float32;
  bricks::Index3 Edge{ 0 };      ///< cells on each axis of a whole brick
  std::vector<dsm::BlockId> Ids; ///< may have one several times

private:
  std::vector<double> Isovalues;
};

#endif
