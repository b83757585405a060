// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMTriangleList_h
#define vtkDSMTriangleList_h

#include "vtkDataSetAttributes.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <vector>

class vtkCellArray;
class vtkDataArray;
class vtkPolyData;
class vtkUnsignedCharArray;
struct vtkDSMTubesAndSpheres;

/// The triangles of a vtkPolyData's polygons and strips, ghost cells left out. Polygons are cut as
/// VTK's OpenGL mapper cuts them, into a fan, if they are convex, so that both shade alike; concave
/// ones by VTK's ear cutting, where a fan would cover too much. Cells that are triangles already are
/// read where they lie. Or the tubes and spheres of its lines and vertices, as the triangles that
/// bricks::TriangleSource takes for them.
class vtkDSMTriangleList
{
public:
  /// Local; keeps the data. Throws dsm::Error for a cell with a point that does not exist.
  explicit vtkDSMTriangleList(vtkPolyData* data);
  /// The tubes and spheres of the data. Points at the same place as the one before, and those that are not finite,
  /// belong to no tube; the latter end it. Throws dsm::Error also for a radius array that cannot be used.
  vtkDSMTriangleList(vtkPolyData* data, const vtkDSMTubesAndSpheres& solids);

  std::uint64_t GetCount() const { return this->Count; }
  /// May be called by several threads at a time, as all below.
  void GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const;
  /// The number of the cell, as VTK counts: verts, lines, polygons, strips.
  vtkIdType GetCell(std::uint64_t triangle) const;
  /// Which sides of a triangle are edges of its polygon (bricks::AllEdges), and not hidden by the edge flags that
  /// points may have (vtkDataSetAttributes::EDGEFLAG: of the edge that begins at the point). All sides of strips
  /// are, as VTK draws them.
  unsigned GetEdgeFlags(std::uint64_t triangle) const;
  /// Returns the radius of a tube or sphere at a corner; 0 where it would be negative or not a number.
  double GetRadius(std::uint64_t triangle, int corner) const;

  /// Returns whether the data may have triangles with sides that are not edges.
  static bool NeedsEdgeFlags(vtkPolyData* data);

  /// At most so many triangles, found without reading the cells.
  static std::uint64_t GetLargestCount(vtkPolyData* data);

private:
  static constexpr int HiddenCells =
    vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;

  void FindGhosts();
  bool UseInPlace();
  /// Calls `visit(cell, size, points)` for those of the cells, counted from `first`, that have at least so many points
  /// and are no ghosts.
  template <class Visit>
  void VisitCells(vtkCellArray* cells, vtkIdType first, vtkIdType least, const Visit& visit);
  void AddSpheres();
  void AddTubes();
  /// Adds the tube along points at different places.
  void AddTube(vtkIdType cell, const std::vector<vtkIdType>& points);
  void AddCorners(vtkIdType cell, vtkIdType a, vtkIdType b, vtkIdType c);
  void AddPolygons();
  void AddStrips();
  void AddPolygon(vtkIdType cell, vtkIdType size, const vtkIdType* points);
  /// Adds the triangle between three corners of the polygon, given by number.
  void AddTriangle(
    vtkIdType cell, vtkIdType size, const vtkIdType* points, vtkIdType a, vtkIdType b, vtkIdType c);
  void CheckPoints(vtkIdType cell, vtkIdType size, const vtkIdType* points) const;
  /// Returns whether the triangles of a fan around the first point do not overlap.
  bool IsFan(vtkIdType size, const vtkIdType* points) const;
  bool IsGhost(vtkIdType cell) const
  {
    return this->Ghosts && (this->Ghosts[cell] & HiddenCells) != 0;
  }

  vtkSmartPointer<vtkPolyData> Data;
  const std::uint8_t* Ghosts = nullptr; ///< flags of the cells
  std::uint64_t Count = 0;
  vtkIdType FirstCell = 0;
  /// Three point numbers for each triangle. They are in one of these two, or in Corners.
  const vtkTypeInt32* InPlace32 = nullptr;
  const vtkTypeInt64* InPlace64 = nullptr;
  std::vector<vtkIdType> Corners;
  std::vector<vtkIdType> Cells;
  std::vector<std::uint8_t> Edges;            ///< for each triangle; empty: all sides are edges
  vtkUnsignedCharArray* PointFlags = nullptr; ///< the data's edge flags, or null
  std::uint64_t Spheres = 0;                  ///< the first ones are spheres, the others are tubes
  double SphereRadius = 0.0;
  double TubeRadius = 0.0;
  vtkDataArray* RadiusFactors = nullptr; ///< of the points; may be null
};

#endif
