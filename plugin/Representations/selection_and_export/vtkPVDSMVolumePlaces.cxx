// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVolumePlaces.h"

#include "vtkDSMScene.h"
#include "vtkPVDSMGridPlace.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
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

void vtkPVDSMVolumePlaces::AddImage(vtkDataSet* image, unsigned block,
  const std::vector<Place>& places, vtkMultiBlockDataSet* geometry)
{
  if (!image)
  {
    return;
  }
  constexpr double slack = 1e-3; // relative to a cell
  constexpr int hidden =
    vtkDataSetAttributes::DUPLICATECELL | static_cast<int>(vtkDataSetAttributes::HIDDENCELL);
  vtkUnsignedCharArray* const ghosts = image->GetCellGhostArray();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkIdTypeArray> pointIds;
  pointIds->SetName("vtkOriginalPointIds");
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("vtkOriginalCellIds");
  vtkNew<vtkUnsignedIntArray> blocks;
  blocks->SetName("vtkCompositeIndex");
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
    if (!isInside)
    {
      continue;
    }
    const vtkIdType cellId = vtkStructuredData::ComputeCellIdForExtent(extent, cell);
    if (ghosts && (ghosts->GetValue(cellId) & hidden) != 0)
    {
      continue;
    }
    const vtkIdType vertex = points->InsertNextPoint(place.data());
    vertices->InsertNextCell(1, &vertex);
    cellIds->InsertNextValue(cellId);
    pointIds->InsertNextValue(vtkStructuredData::ComputePointIdForExtent(extent, point));
    blocks->InsertNextValue(block);
  }
  vtkNew<vtkPolyData> found;
  found->SetPoints(points);
  found->SetVerts(vertices);
  found->GetPointData()->AddArray(pointIds);
  found->GetCellData()->AddArray(cellIds);
  found->GetCellData()->AddArray(blocks);
  geometry->SetBlock(geometry->GetNumberOfBlocks(), found);
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
    AddImage(vtkPVDSMGridPlace::FindImage(data), 0, places, geometry);
    return geometry;
  }
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(composite->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    AddImage(vtkPVDSMGridPlace::FindImage(leaf->GetCurrentDataObject()),
      leaf->GetCurrentFlatIndex(), places, geometry);
  }
  return geometry;
}
