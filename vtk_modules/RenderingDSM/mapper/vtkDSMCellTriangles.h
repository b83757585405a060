// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMCellTriangles_h
#define vtkDSMCellTriangles_h

#include "vtkDSMOwnCells.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <glm/vec3.hpp>

#include <vector>

class vtkCell;
class vtkDataArray;
class vtkDoubleArray;
class vtkIdTypeArray;
class vtkMergePoints;
class vtkPolyData;
class vtkUnsignedIntArray;
class vtkVoxel;

/// Collects the triangles of isosurfaces in cells, by VTK's marching cubes. Each triangle knows its cell
/// (vtkOriginalCellIds), each point the nearest corner of one (vtkOriginalPointIds), and both the block of a
/// composite dataset that has these (vtkCompositeIndex). Cells share the points on their common edges. One thread.
class vtkDSMCellTriangles
{
public:
  using Cell = vtkDSMOwnCells::Cell;

  /// `bounds`: of the cells. `points`: about how many points there will be. `isMirrored`: x, y and z of the cells are
  /// left-handed in space. `hasBlocks`: the dataset is a composite one.
  vtkDSMCellTriangles(const double bounds[6], vtkIdType points, bool isMirrored, bool hasBlocks);
  ~vtkDSMCellTriangles();

  ///@{
  /// Before any cell, for cells of one dataset: values of its points are interpolated, those of its cells given to
  /// their triangles.
  void TakePointArray(vtkDataArray* array);
  void TakeCellArray(vtkDataArray* array);
  ///@}

  /// Adds the triangles of surfaces in a cell. `block`: flat index of its dataset.
  void Add(const Cell& cell, unsigned int block, const std::vector<double>& isovalues);

  /// The same of a cell of any shape, by VTK's class of it. `values`: of its points, in their order; finite. `id`: its
  /// number in its dataset.
  void Add(vtkCell* cell, vtkDataArray* values, vtkIdType id, unsigned int block,
    const std::vector<double>& isovalues);

  vtkIdType GetNumberOfTriangles() const;
  /// One for each point: a place near it, within a cell that has it.
  const std::vector<glm::dvec3>& GetPlacesWithin() const { return this->Within; }
  /// The triangles, after the last cell; further arrays may be added to them.
  vtkPolyData* Finish();

private:
  /// Adds the triangles of one surface. `id`: of the cell in its dataset.
  void Contour(vtkCell* cell, vtkDataArray* values, vtkIdType id, double isovalue);
  /// Completes the triangles that a cell has added. `places` and `points`: of its corners.
  void Finish(vtkIdType id, unsigned int block, const std::vector<glm::dvec3>& places,
    const std::vector<vtkIdType>& points);

  int Flip; ///< corners of a cell are corners of the voxel where these bits differ
  vtkNew<vtkPolyData> Triangles;
  vtkNew<vtkPolyData> Dataset; ///< its arrays
  vtkNew<vtkMergePoints> Locator;
  vtkNew<vtkVoxel> Voxel;
  vtkNew<vtkDoubleArray> Values;
  vtkNew<vtkIdTypeArray> CellIds;
  vtkNew<vtkIdTypeArray> PointIds;
  bool HasBlocks;
  vtkNew<vtkUnsignedIntArray> BlocksOfCells;
  vtkNew<vtkUnsignedIntArray> BlocksOfPoints;
  std::vector<glm::dvec3> Within;
};

#endif
