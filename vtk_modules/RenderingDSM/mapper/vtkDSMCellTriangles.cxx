// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMCellTriangles.h"

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
    this->Voxel->Contour(isovalue, this->Values, this->Locator, this->Triangles->GetVerts(),
      this->Triangles->GetLines(), this->Triangles->GetPolys(), this->Dataset->GetPointData(),
      this->Triangles->GetPointData(), this->Dataset->GetCellData(), cell.Id,
      this->Triangles->GetCellData());
  }
  while (this->GetNumberOfTriangles() < this->Triangles->GetPolys()->GetNumberOfCells())
  {
    this->CellIds->InsertNextValue(cell.Id);
    this->BlocksOfCells->InsertNextValue(block);
  }
  this->FinishPoints(cell, block);
}

/// The points that the cell has added.
void vtkDSMCellTriangles::FinishPoints(const Cell& cell, unsigned int block)
{
  constexpr double inward = 1e-3;
  const glm::dvec3 center = 0.5 * (cell.Places[0] + cell.Places[7]);
  vtkPoints* const points = this->Triangles->GetPoints();
  while (this->PointIds->GetNumberOfValues() < points->GetNumberOfPoints())
  {
    glm::dvec3 place;
    points->GetPoint(this->PointIds->GetNumberOfValues(), &place.x);
    this->Within.push_back(glm::mix(place, center, inward));
    // It is on an edge, whose ends are nearer than all other corners.
    const auto getDistance = [&](int corner) { return glm::distance(place, cell.Places[corner]); };
    int nearest = 0;
    for (int corner = 1; corner < 8; ++corner)
    {
      nearest = getDistance(corner) <= getDistance(nearest) ? corner : nearest;
    }
    this->PointIds->InsertNextValue(cell.Points[nearest]);
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
