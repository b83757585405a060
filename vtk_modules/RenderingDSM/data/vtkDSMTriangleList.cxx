// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTriangleList.h"

#include "DSMBricks/layout/MeshAttributes.h"
#include "DSMCore/base/Error.h"
#include "vtkDSMCompatibility.h"
#include "vtkDSMTubesAndSpheres.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <string>

namespace
{

glm::dvec3 GetPoint(vtkPolyData* data, vtkIdType point)
{
  glm::dvec3 position;
  data->GetPoints()->GetPoint(point, &position.x);
  return position;
}

/// As VTK: bytes, one a point.
vtkUnsignedCharArray* FindPointFlags(vtkPolyData* data)
{
  auto* flags = vtkUnsignedCharArray::SafeDownCast(
    data->GetPointData()->GetAttribute(vtkDataSetAttributes::EDGEFLAG));
  return flags && flags->GetNumberOfComponents() == 1 &&
      flags->GetNumberOfTuples() == data->GetNumberOfPoints()
    ? flags
    : nullptr;
}

} // namespace

vtkDSMTriangleList::vtkDSMTriangleList(vtkPolyData* data)
  : Data(data)
  , FirstCell(data->GetNumberOfVerts() + data->GetNumberOfLines())
  , PointFlags(FindPointFlags(data))
{
  this->FindGhosts();
  if (!this->UseInPlace())
  {
    this->AddPolygons();
    this->AddStrips();
    this->Count = this->Cells.size();
  }
}

vtkDSMTriangleList::vtkDSMTriangleList(vtkPolyData* data, const vtkDSMTubesAndSpheres& solids)
  : Data(data)
  , SphereRadius(solids.PointRadius)
  , TubeRadius(solids.LineRadius)
  , RadiusFactors(solids.FindFactors(data))
{
  this->FindGhosts();
  if (solids.HasSpheres(data))
  {
    this->AddSpheres();
  }
  this->Spheres = this->Cells.size();
  if (solids.HasTubes(data))
  {
    this->AddTubes();
  }
  this->Count = this->Cells.size();
}

void vtkDSMTriangleList::FindGhosts()
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    this->Data->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  if (ghosts && ghosts->GetNumberOfTuples() == this->Data->GetNumberOfCells())
  {
    this->Ghosts = ghosts->GetPointer(0);
  }
}

std::uint64_t vtkDSMTriangleList::GetLargestCount(vtkPolyData* data)
{
  vtkIdType count = 0;
  for (vtkCellArray* cells : { data->GetPolys(), data->GetStrips() })
  {
    count += cells->GetNumberOfConnectivityIds() - 2 * cells->GetNumberOfCells();
  }
  return static_cast<std::uint64_t>(count > 0 ? count : 0);
}

bool vtkDSMTriangleList::UseInPlace()
{
  vtkCellArray* polygons = this->Data->GetPolys();
  if (this->Ghosts || this->Data->GetNumberOfStrips() > 0 || polygons->IsHomogeneous() != 3)
  {
    return false;
  }
  // The test is for the type of the array, not for the kind of storage: cells of a fixed size, as
  // in VTK since 9.6, have the same numbers, and any other array is possible there, too.
  vtkDataArray* corners = polygons->GetConnectivityArray();
  if (auto* wide = vtkAOSDataArrayTemplate<vtkTypeInt64>::FastDownCast(corners))
  {
    this->InPlace64 = wide->GetPointer(0);
  }
  else if (auto* narrow = vtkAOSDataArrayTemplate<vtkTypeInt32>::FastDownCast(corners))
  {
    this->InPlace32 = narrow->GetPointer(0);
  }
  else
  {
    return false;
  }
  this->Count = static_cast<std::uint64_t>(polygons->GetNumberOfCells());
  return true;
}

template <class Visit>
void vtkDSMTriangleList::VisitCells(
  vtkCellArray* cells, vtkIdType first, vtkIdType least, const Visit& visit)
{
  for (vtkIdType index = 0; index < cells->GetNumberOfCells(); ++index)
  {
    const vtkIdType cell = first + index;
    vtkIdType size = 0;
    const vtkIdType* points = nullptr;
    cells->GetCellAtId(index, size, points);
    if (size >= least && !this->IsGhost(cell))
    {
      this->CheckPoints(cell, size, points);
      visit(cell, size, points);
    }
  }
}

void vtkDSMTriangleList::AddPolygons()
{
  vtkCellArray* polygons = this->Data->GetPolys();
  const auto most = static_cast<std::size_t>(GetLargestCount(this->Data));
  this->Corners.reserve(3 * most);
  this->Cells.reserve(most);
  this->Edges.reserve(most);
  this->VisitCells(polygons, this->FirstCell, 3,
    [this](vtkIdType cell, vtkIdType size, const vtkIdType* points)
    { this->AddPolygon(cell, size, points); });
}

void vtkDSMTriangleList::AddStrips()
{
  this->VisitCells(this->Data->GetStrips(), this->FirstCell + this->Data->GetNumberOfPolys(), 0,
    [this](vtkIdType cell, vtkIdType size, const vtkIdType* points)
    {
      for (vtkIdType corner = 2; corner < size; ++corner)
      {
        // Every other triangle is the other way round.
        const vtkIdType odd = corner & 1;
        const vtkIdType turned[3] = { points[corner - 2 + odd], points[corner - 1 - odd],
          points[corner] };
        this->AddTriangle(cell, 3, turned, 0, 1, 2);
      }
    });
}

void vtkDSMTriangleList::AddPolygon(vtkIdType cell, vtkIdType size, const vtkIdType* points)
{
  if (size > 3 && !this->IsFan(size, points))
  {
    vtkNew<vtkPolygon> polygon;
    polygon->GetPointIds()->SetNumberOfIds(size);
    polygon->GetPoints()->SetNumberOfPoints(size);
    for (vtkIdType corner = 0; corner < size; ++corner)
    {
      polygon->GetPointIds()->SetId(corner, corner);
      polygon->GetPoints()->SetPoint(corner, this->Data->GetPoint(points[corner]));
    }
    vtkNew<vtkIdList> triangles;
    if (vtkDSMCompatibility::Triangulate(polygon, triangles) && triangles->GetNumberOfIds() >= 3)
    {
      for (vtkIdType corner = 0; corner + 2 < triangles->GetNumberOfIds(); corner += 3)
      {
        this->AddTriangle(cell, size, points, triangles->GetId(corner),
          triangles->GetId(corner + 1), triangles->GetId(corner + 2));
      }
      return;
    }
  }
  for (vtkIdType corner = 2; corner < size; ++corner)
  {
    this->AddTriangle(cell, size, points, 0, corner - 1, corner);
  }
}

void vtkDSMTriangleList::AddTriangle(
  vtkIdType cell, vtkIdType size, const vtkIdType* points, vtkIdType a, vtkIdType b, vtkIdType c)
{
  this->AddCorners(cell, points[a], points[b], points[c]);
  const auto isEdge = [size](vtkIdType from, vtkIdType to)
  { return (from + 1) % size == to || (to + 1) % size == from ? 1u : 0u; };
  this->Edges.push_back(
    static_cast<std::uint8_t>(isEdge(a, b) | isEdge(b, c) << 1 | isEdge(c, a) << 2));
}

void vtkDSMTriangleList::AddCorners(vtkIdType cell, vtkIdType a, vtkIdType b, vtkIdType c)
{
  this->Corners.insert(this->Corners.end(), { a, b, c });
  this->Cells.push_back(cell);
}

void vtkDSMTriangleList::AddSpheres()
{
  vtkCellArray* vertices = this->Data->GetVerts();
  const auto count = static_cast<std::size_t>(vertices->GetNumberOfConnectivityIds());
  this->Corners.reserve(3 * count);
  this->Cells.reserve(count);
  this->VisitCells(vertices, 0, 0,
    [this](vtkIdType cell, vtkIdType size, const vtkIdType* points)
    {
      for (const vtkIdType* point = points; point != points + size; ++point)
      {
        this->AddCorners(cell, *point, *point, *point);
      }
    });
}

void vtkDSMTriangleList::AddTubes()
{
  vtkCellArray* lines = this->Data->GetLines();
  const std::size_t most =
    this->Cells.size() + static_cast<std::size_t>(lines->GetNumberOfConnectivityIds());
  this->Corners.reserve(3 * most);
  this->Cells.reserve(most);
  std::vector<vtkIdType> run;
  this->VisitCells(lines, this->Data->GetNumberOfVerts(), 0,
    [&](vtkIdType cell, vtkIdType size, const vtkIdType* points)
    {
      run.clear();
      for (const vtkIdType* point = points; point != points + size; ++point)
      {
        const glm::dvec3 place = GetPoint(this->Data, *point);
        if (!std::isfinite(place.x + place.y + place.z))
        {
          this->AddTube(cell, run);
          run.clear();
        }
        else if (run.empty() || GetPoint(this->Data, run.back()) != place)
        {
          run.push_back(*point);
        }
      }
      this->AddTube(cell, run);
    });
}

void vtkDSMTriangleList::AddTube(vtkIdType cell, const std::vector<vtkIdType>& points)
{
  const std::size_t size = points.size();
  if (size == 2)
  {
    this->AddCorners(cell, points[0], points[1], points[0]);
  }
  if (size <= 2)
  {
    return;
  }
  // The first point of a closed line comes again behind the last one.
  const bool isClosed = size > 3 && points.front() == points.back();
  const std::size_t last = isClosed ? size - 2 : size - 1;
  for (std::size_t point = 0; point <= last; ++point)
  {
    const std::size_t before = point > 0 ? point - 1 : isClosed ? last : 0;
    const std::size_t behind = point < last || isClosed ? point + 1 : last;
    this->AddCorners(cell, points[before], points[point], points[behind]);
  }
}

void vtkDSMTriangleList::CheckPoints(vtkIdType cell, vtkIdType size, const vtkIdType* points) const
{
  for (vtkIdType corner = 0; corner < size; ++corner)
  {
    if (points[corner] < 0 || points[corner] >= this->Data->GetNumberOfPoints())
    {
      throw dsm::Error("Cell " + std::to_string(cell) + " of the surface refers to point " +
        std::to_string(points[corner]) + ", but the surface has only " +
        std::to_string(this->Data->GetNumberOfPoints()) + " points. Check the dataset's cells.");
    }
  }
}

bool vtkDSMTriangleList::IsFan(vtkIdType size, const vtkIdType* points) const
{
  const glm::dvec3 first = GetPoint(this->Data, points[0]);
  glm::dvec3 normal(0.0);
  for (int pass = 0; pass < 2; ++pass)
  {
    glm::dvec3 last = GetPoint(this->Data, points[1]) - first;
    for (vtkIdType corner = 2; corner < size; ++corner)
    {
      const glm::dvec3 next = GetPoint(this->Data, points[corner]) - first;
      const glm::dvec3 area = glm::cross(last, next);
      if (pass == 0)
      {
        normal += area;
      }
      else if (glm::dot(area, normal) < 0.0)
      {
        return false;
      }
      last = next;
    }
  }
  return true;
}

void vtkDSMTriangleList::GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const
{
  for (int corner = 0; corner < 3; ++corner)
  {
    const std::uint64_t index = 3 * triangle + static_cast<std::uint64_t>(corner);
    points[corner] = this->InPlace64 ? static_cast<std::uint64_t>(this->InPlace64[index])
      : this->InPlace32              ? static_cast<std::uint64_t>(this->InPlace32[index])
                                     : static_cast<std::uint64_t>(this->Corners[index]);
  }
}

vtkIdType vtkDSMTriangleList::GetCell(std::uint64_t triangle) const
{
  return this->Cells.empty() ? this->FirstCell + static_cast<vtkIdType>(triangle)
                             : this->Cells[triangle];
}

unsigned vtkDSMTriangleList::GetEdgeFlags(std::uint64_t triangle) const
{
  unsigned flags = this->Edges.empty() ? bricks::AllEdges : this->Edges[triangle];
  if (this->PointFlags)
  {
    std::uint64_t points[3];
    this->GetTriangle(triangle, points);
    for (int side = 0; side < 3; ++side)
    {
      const auto point = static_cast<vtkIdType>(points[side]);
      flags &= this->PointFlags->GetValue(point) != 0 ? bricks::AllEdges : ~(1u << side);
    }
  }
  return flags;
}

double vtkDSMTriangleList::GetRadius(std::uint64_t triangle, int corner) const
{
  const double radius = triangle < this->Spheres ? this->SphereRadius : this->TubeRadius;
  if (!this->RadiusFactors)
  {
    return radius;
  }
  const vtkIdType point = this->Corners[3 * triangle + static_cast<std::uint64_t>(corner)];
  const double product = radius * this->RadiusFactors->GetComponent(point, 0);
  return product > 0.0 ? product : 0.0;
}

bool vtkDSMTriangleList::NeedsEdgeFlags(vtkPolyData* data)
{
  const vtkIdType polygons = data->GetNumberOfPolys();
  return (polygons > 0 && data->GetPolys()->IsHomogeneous() != 3) || FindPointFlags(data);
}
