// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVolumePlaces.h"

#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMGridPlace.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkFloatArray.h"
#include "vtkGenericCell.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkStaticCellLocator.h"
#include "vtkStructuredData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"

#include <algorithm>
#include <cmath>

namespace
{

/// VTK's volume mapper selects what covers more.
constexpr int LeastAlpha = 3;

void Multiply(vtkMatrix4x4* matrix, const double point[3], double result[3])
{
  const double in[4] = { point[0], point[1], point[2], 1.0 };
  double out[4];
  matrix->MultiplyPoint(in, out);
  std::transform(out, out + 3, result, [&](double value) { return value / out[3]; });
}

} // namespace

/// Places that are in cells of one dataset.
class vtkPVDSMVolumePlaces::FoundPlaces
{
public:
  explicit FoundPlaces(vtkDataSet* data)
    : Ghosts(data->GetCellGhostArray())
  {
    this->PointIds->SetName("vtkOriginalPointIds");
    this->CellIds->SetName("vtkOriginalCellIds");
    this->Blocks->SetName("vtkCompositeIndex");
  }

  /// Leaves out places in ghost cells and hidden ones. `point`: the nearest one of the cell.
  void Add(const Place& place, vtkIdType cell, vtkIdType point)
  {
    constexpr int hidden =
      vtkDataSetAttributes::DUPLICATECELL | static_cast<int>(vtkDataSetAttributes::HIDDENCELL);
    if (this->Ghosts && (this->Ghosts->GetValue(cell) & hidden) != 0)
    {
      return;
    }
    const vtkIdType vertex = this->Points->InsertNextPoint(place.data());
    this->Vertices->InsertNextCell(1, &vertex);
    this->CellIds->InsertNextValue(cell);
    this->PointIds->InsertNextValue(point);
  }

  /// `block`: flat index of the dataset.
  vtkPolyData* Finish(unsigned block)
  {
    this->Blocks->SetNumberOfValues(this->CellIds->GetNumberOfValues());
    this->Blocks->FillValue(block);
    this->Found->SetPoints(this->Points);
    this->Found->SetVerts(this->Vertices);
    this->Found->GetPointData()->AddArray(this->PointIds);
    this->Found->GetCellData()->AddArray(this->CellIds);
    this->Found->GetCellData()->AddArray(this->Blocks);
    return this->Found;
  }

private:
  vtkUnsignedCharArray* Ghosts;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Vertices;
  vtkNew<vtkIdTypeArray> PointIds;
  vtkNew<vtkIdTypeArray> CellIds;
  vtkNew<vtkUnsignedIntArray> Blocks;
  vtkNew<vtkPolyData> Found;
};

void vtkPVDSMVolumePlaces::Forget()
{
  this->Places.clear();
  this->AreKnown = false;
}

void vtkPVDSMVolumePlaces::Find(vtkDSMScene* scene, vtkRenderer* renderer)
{
  if (this->AreKnown)
  {
    return;
  }
  this->AreKnown = true;
  const int* const size = renderer->GetSize();
  vtkNew<vtkImageData> picture;
  if (!scene->TraceImage(size[0], size[1], picture, true))
  {
    return;
  }
  auto* const colors =
    vtkUnsignedCharArray::SafeDownCast(picture->GetPointData()->GetArray("color"));
  auto* const depths = vtkFloatArray::SafeDownCast(picture->GetPointData()->GetArray("depth"));
  vtkNew<vtkMatrix4x4> toWorld;
  toWorld->DeepCopy(renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
    renderer->GetTiledAspectRatio(), -1.0, 1.0));
  toWorld->Invert();
  for (vtkIdType pixel = 0; pixel < picture->GetNumberOfPoints(); ++pixel)
  {
    if (depths->GetValue(pixel) < 1.0f && colors->GetValue(4 * pixel + 3) > LeastAlpha)
    {
      const double clip[3] = { 2.0 * (static_cast<double>(pixel % size[0]) + 0.5) / size[0] - 1.0,
        2.0 * (static_cast<double>(pixel / size[0]) + 0.5) / size[1] - 1.0,
        2.0 * static_cast<double>(depths->GetValue(pixel)) - 1.0 };
      Place place;
      Multiply(toWorld, clip, place.data());
      this->Places.push_back(place);
    }
  }
}

void vtkPVDSMVolumePlaces::AddImage(
  vtkDataSet* image, const std::vector<Place>& places, FoundPlaces& found)
{
  constexpr double slack = 1e-3; // relative to a cell
  const int* const extent = vtkPVDSMGridPlace::GetExtent(image);
  for (const Place& place : places)
  {
    double index[3];
    vtkPVDSMGridPlace::Find(image, place.data(), index);
    int cell[3];
    int point[3];
    bool isInside = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int first = extent[2 * axis];
      const int last = extent[2 * axis + 1];
      index[axis] += first;
      isInside = isInside && index[axis] >= first - slack && index[axis] <= last + slack;
      cell[axis] =
        std::clamp(static_cast<int>(std::floor(index[axis])), first, std::max(first, last - 1));
      point[axis] = std::clamp(static_cast<int>(std::lround(index[axis])), first, last);
    }
    if (isInside)
    {
      found.Add(place, vtkStructuredData::ComputeCellIdForExtent(extent, cell),
        vtkStructuredData::ComputePointIdForExtent(extent, point));
    }
  }
}

void vtkPVDSMVolumePlaces::AddGrid(
  vtkPointSet* grid, const std::vector<Place>& places, FoundPlaces& found)
{
  constexpr double slack = 1e-12; // squared, relative to the dataset
  const double tolerance = slack * grid->GetLength() * grid->GetLength();
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(grid);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  std::vector<double> weights(static_cast<std::size_t>(grid->GetMaxCellSize()));
  for (Place place : places)
  {
    double parameters[3];
    const vtkIdType id =
      locator->FindCell(place.data(), tolerance, cell, parameters, weights.data());
    if (id < 0 || cell->GetCellDimension() < 3)
    {
      continue;
    }
    const auto getDistance = [&](vtkIdType corner)
    { return vtkMath::Distance2BetweenPoints(place.data(), cell->GetPoints()->GetPoint(corner)); };
    vtkIdType nearest = 0;
    for (vtkIdType corner = 1; corner < cell->GetNumberOfPoints(); ++corner)
    {
      nearest = getDistance(corner) < getDistance(nearest) ? corner : nearest;
    }
    found.Add(place, id, cell->GetPointId(nearest));
  }
}

void vtkPVDSMVolumePlaces::AddData(vtkDataObject* data, unsigned block,
  const std::vector<Place>& places, vtkMultiBlockDataSet* geometry)
{
  vtkDataSet* const image = vtkPVDSMGridPlace::FindImage(data);
  auto* const grid = vtkPointSet::SafeDownCast(data);
  const bool isGrid = grid && vtkDSMVolumeMapper::IsVolume(grid);
  if (!image && !isGrid)
  {
    return;
  }
  FoundPlaces found(image ? image : grid);
  if (image)
  {
    AddImage(image, places, found);
  }
  else
  {
    AddGrid(grid, places, found);
  }
  geometry->SetBlock(geometry->GetNumberOfBlocks(), found.Finish(block));
}

vtkSmartPointer<vtkMultiBlockDataSet> vtkPVDSMVolumePlaces::MakePoints(
  vtkDataObject* data, vtkMatrix4x4* dataToWorld) const
{
  vtkNew<vtkMatrix4x4> toData;
  vtkMatrix4x4::Invert(dataToWorld, toData);
  std::vector<Place> places = this->Places;
  for (Place& place : places)
  {
    Multiply(toData, Place(place).data(), place.data());
  }
  auto geometry = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  auto* const composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    AddData(data, 0, places, geometry);
    return geometry;
  }
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(composite->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    AddData(leaf->GetCurrentDataObject(), leaf->GetCurrentFlatIndex(), places, geometry);
  }
  return geometry;
}
