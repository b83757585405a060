// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMCutCells_h
#define vtkDSMCutCells_h

#include "vtkType.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

class vtkCell;
class vtkGenericCell;
class vtkIdList;
class vtkUnstructuredGrid;

/// The cells of one unstructured grid that bricks of cells cannot have as they are, cut into linear ones:
/// - Polyhedra, and prisms of five and six sides, into pyramids and tetrahedra around the mean of their points. Faces
///   of more than four points are cut into triangles around the mean of the face's points, so that both sides of a
///   face cut it alike. Faces of four points stay faces, as they are beside hexahedra.
/// - Quadratic, Lagrange and Bezier cells at their own nodes, and where a regular lattice of nodes has gaps, at points
///   of the cell's own interpolation.
/// - Convex point sets as VTK cuts them.
/// Points that the grid does not have are means of its points, with weights. They are numbered behind the grid's
/// points; those of a face are the same for both of its cells. Keeps nothing of the grid.
class vtkDSMCutCells
{
public:
  /// Returns whether cells of a VTK type have to be cut.
  static bool IsCut(int type);

  vtkDSMCutCells() = default;
  vtkDSMCutCells(const vtkDSMCutCells&) = delete;
  vtkDSMCutCells& operator=(const vtkDSMCutCells&) = delete;
  /// Local. Throws dsm::Error for a cell with a point that does not exist.
  explicit vtkDSMCutCells(vtkUnstructuredGrid* grid);

  /// Linear cells: first the tetrahedra, then the hexahedra, as bricks::CellSource has them.
  std::size_t GetCount() const { return this->Owners[0].size() + this->Owners[1].size(); }
  bool HasOnlyTetrahedra() const { return this->Owners[1].empty(); }
  /// The points of a linear cell, and their number: 4 or 8. Any thread, as all below.
  const std::uint32_t* GetCorners(std::size_t cell, int& count) const;
  /// The cell of the grid that a linear cell is cut from.
  vtkIdType GetOwner(std::size_t cell) const;

  /// Points that the grid does not have.
  std::size_t GetPointCount() const { return this->Begins.size(); }
  /// Calls `add(point, weight)` for the points of the grid whose mean this is: in the same order for all cells that
  /// have it, so that sums are the same to the last bit.
  template <class Add>
  void ForEachWeighted(std::size_t point, const Add& add) const
  {
    const std::vector<double>& weights = *this->Weights[point];
    for (std::size_t index = 0; index < weights.size(); ++index)
    {
      add(this->Ids[this->Begins[point] + index], weights[index]);
    }
  }
  /// The grid's cells that were cut, in ascending order.
  const std::vector<vtkIdType>& GetCells() const { return this->Cells; }

private:
  /// A point as a mean of others.
  struct Weighted
  {
    std::uint32_t Point;
    double Weight;
  };
  using Blend = std::vector<Weighted>;
  /// Where the nodes of a kind of cell are, by the numbers of its points, and the linear cells between these nodes.
  struct Pattern
  {
    std::vector<Blend> Nodes;
    std::vector<std::vector<std::uint32_t>> Cells; ///< of four or eight nodes
  };
  using PatternKey = std::vector<int>;

  void Cut(vtkIdType cell, int type, vtkIdList* list, vtkGenericCell* generic);
  void CutPolyhedron(vtkIdType cell, const std::vector<std::vector<std::uint32_t>>& faces);
  void CutNonlinear(vtkIdType cell, int type, vtkCell* nodes);
  void CutByVtk(vtkIdType cell, vtkCell* nodes);
  const Pattern& FindPattern(int type, vtkCell* nodes);
  static Pattern MakePattern(int type, vtkCell* nodes);
  ///@{
  /// The linear cells only; `places` receives where the nodes are, in the cell's parameters.
  using Places = std::vector<std::array<double, 3>>;
  static Pattern MakeHexahedron(const int orders[3], Places& places);
  static Pattern MakeWedge(int order, int layers, Places& places);
  static Pattern MakeTetrahedron(int order, Places& places);
  ///@}
  static Pattern MakePyramid(vtkIdType nodes);
  /// Four or eight corners.
  void AddCell(vtkIdType cell, const std::vector<std::uint32_t>& corners);
  /// The number of the point that is a mean of others; points that cells have in common are found again.
  std::uint32_t AddPoint(Blend blend, bool isShared);
  std::uint32_t AddMean(const std::vector<std::uint32_t>& points, bool isShared);
  std::uint32_t CheckPoint(vtkIdType cell, vtkIdType point) const;

  vtkUnstructuredGrid* Grid = nullptr; ///< while its cells are cut
  std::uint64_t GridPoints = 0;
  std::vector<vtkIdType> Cells;
  std::vector<std::uint32_t> Corners[2]; ///< of tetrahedra, and of hexahedra
  std::vector<vtkIdType> Owners[2];      ///< likewise
  std::vector<std::size_t> Begins;       ///< of each further point's points, in Ids
  std::vector<std::uint32_t> Ids;
  /// For each further point, the weights of its points. Each list is kept once.
  std::vector<const std::vector<double>*> Weights;
  std::set<std::vector<double>> AllWeights;
  std::unordered_multimap<std::uint64_t, std::uint32_t> Known; ///< further points by a hash
  std::map<PatternKey, Pattern> Patterns;
};

#endif
