// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMCellTriangles.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkMergePoints.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedIntArray.h"
#include "vtkVoxel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>

vtkDSMCellTriangles::vtkDSMCellTriangles(
  const double bounds[6], vtkIdType points, bool isMirrored, bool hasBlocks)
  : Flip(isMirrored ? 1 : 0)
  , HasBlocks(hasBlocks)
{
  this->Values->SetNumberOfTuples(8);
  this->CellIds->SetName("vtkOriginalCellIds");
  this->PointIds->SetName("vtkOriginalPointIds");
  this->BlocksOfCells->SetName("vtkCompositeIndex");
  this->BlocksOfPoints->SetName("vtkCompositeIndex");
  vtkNew<vtkPoints> places;
  this->Locator->InitPointInsertion(places, bounds, points);
  this->Triangles->SetPoints(places);
  this->Triangles->AllocateEstimate(0, 0);
  // Lines and vertices are where vtkVoxel counts cells; there are none.
  this->Triangles->SetVerts(vtkNew<vtkCellArray>());
  this->Triangles->SetLines(vtkNew<vtkCellArray>());
  this->Triangles->SetPolys(vtkNew<vtkCellArray>());
}

vtkDSMCellTriangles::~vtkDSMCellTriangles() = default;

void vtkDSMCellTriangles::TakePointArray(vtkDataArray* array)
{
  this->Dataset->GetPointData()->AddArray(array);
  this->Triangles->GetPointData()->InterpolateAllocate(this->Dataset->GetPointData());
}

void vtkDSMCellTriangles::TakeCellArray(vtkDataArray* array)
{
  this->Dataset->GetCellData()->AddArray(array);
  this->Triangles->GetCellData()->CopyAllocate(this->Dataset->GetCellData());
}

vtkIdType vtkDSMCellTriangles::GetNumberOfTriangles() const
{
  return this->CellIds->GetNumberOfValues();
}

void vtkDSMCellTriangles::Add(
  const Cell& cell, unsigned int block, const std::vector<double>& isovalues)
{
  const auto [least, greatest] = std::minmax_element(cell.Values, cell.Values + 8);
  bool isFilled = false;
  for (const double isovalue : isovalues)
  {
    if (!(*least < isovalue && isovalue <= *greatest))
    {
      continue;
    }
    for (int corner = 0; corner < 8 && !isFilled; ++corner)
    {
      const int from = corner ^ this->Flip;
      this->Values->SetValue(corner, cell.Values[from]);
      this->Voxel->GetPoints()->SetPoint(corner, &cell.Places[from].x);
      this->Voxel->GetPointIds()->SetId(corner, cell.Points[from]);
    }
    isFilled = true;
    this->Contour(this->Voxel, this->Values, cell.Id, isovalue);
  }
  if (isFilled)
  {
    this->Finish(
      cell.Id, block, { cell.Places, cell.Places + 8 }, { cell.Points, cell.Points + 8 });
  }
}

void vtkDSMCellTriangles::Add(vtkCell* cell, vtkDataArray* values, vtkIdType id, unsigned int block,
  const std::vector<double>& isovalues)
{
  for (const double isovalue : isovalues)
  {
    this->Contour(cell, values, id, isovalue);
  }
  std::vector<glm::dvec3> places(static_cast<std::size_t>(cell->GetNumberOfPoints()));
  std::vector<vtkIdType> points;
  for (glm::dvec3& place : places)
  {
    const auto corner = static_cast<vtkIdType>(points.size());
    cell->GetPoints()->GetPoint(corner, &place.x);
    points.push_back(cell->GetPointId(corner));
  }
  this->Finish(id, block, places, points);
}

void vtkDSMCellTriangles::Contour(
  vtkCell* cell, vtkDataArray* values, vtkIdType id, double isovalue)
{
  cell->Contour(isovalue, values, this->Locator, this->Triangles->GetVerts(),
    this->Triangles->GetLines(), this->Triangles->GetPolys(), this->Dataset->GetPointData(),
    this->Triangles->GetPointData(), this->Dataset->GetCellData(), id,
    this->Triangles->GetCellData());
}

void vtkDSMCellTriangles::Finish(vtkIdType id, unsigned int block,
  const std::vector<glm::dvec3>& places, const std::vector<vtkIdType>& points)
{
  while (this->GetNumberOfTriangles() < this->Triangles->GetPolys()->GetNumberOfCells())
  {
    this->CellIds->InsertNextValue(id);
    this->BlocksOfCells->InsertNextValue(block);
  }
  constexpr double inward = 1e-3;
  const glm::dvec3 center = std::accumulate(places.begin(), places.end(), glm::dvec3(0.0)) /
    static_cast<double>(places.size());
  vtkPoints* const all = this->Triangles->GetPoints();
  while (this->PointIds->GetNumberOfValues() < all->GetNumberOfPoints())
  {
    glm::dvec3 place;
    all->GetPoint(this->PointIds->GetNumberOfValues(), &place.x);
    this->Within.push_back(glm::mix(place, center, inward));
    // It is on an edge, whose ends are nearer than all other corners.
    std::size_t nearest = 0;
    for (std::size_t corner = 1; corner < places.size(); ++corner)
    {
      nearest = glm::distance(place, places[corner]) <= glm::distance(place, places[nearest])
        ? corner
        : nearest;
    }
    this->PointIds->InsertNextValue(points[nearest]);
    this->BlocksOfPoints->InsertNextValue(block);
  }
}

vtkPolyData* vtkDSMCellTriangles::Finish()
{
  this->Triangles->GetCellData()->AddArray(this->CellIds);
  this->Triangles->GetPointData()->AddArray(this->PointIds);
  if (this->HasBlocks)
  {
    this->Triangles->GetCellData()->AddArray(this->BlocksOfCells);
    this->Triangles->GetPointData()->AddArray(this->BlocksOfPoints);
  }
  return this->Triangles;
}
