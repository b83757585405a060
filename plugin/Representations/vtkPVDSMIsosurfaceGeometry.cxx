// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMIsosurfaceGeometry.h"

#include "vtkDSMVolumeMapper.h"

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStructuredData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"

#include <algorithm>
#include <cmath>

namespace
{

/// One component, or the magnitude, as double: differences of unsigned integers would wrap around.
vtkSmartPointer<vtkDoubleArray> GetValues(vtkDataArray* array, int component)
{
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetName("values");
  values->SetNumberOfTuples(array->GetNumberOfTuples());
  const int components = array->GetNumberOfComponents();
  for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
  {
    double value = 0.0;
    if (component >= 0 && component < components)
    {
      value = array->GetComponent(tuple, component);
    }
    else
    {
      for (int part = 0; part < components; ++part)
      {
        value = std::hypot(value, array->GetComponent(tuple, part));
      }
    }
    values->SetValue(tuple, value);
  }
  return values;
}

/// The array of points or cells that colours the surface; null without any.
vtkDataArray* FindColors(vtkDSMVolumeMapper* mapper, vtkImageData* image, bool onCells)
{
  if (!mapper->GetScalarVisibility() || mapper->GetColorArrayOnCells() != onCells)
  {
    return nullptr;
  }
  vtkDataSetAttributes* attributes = image->GetAttributes(
    onCells ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS);
  return attributes->GetArray(mapper->GetColorArray().c_str());
}

vtkSmartPointer<vtkPolyData> Extract(
  vtkDSMVolumeMapper* mapper, vtkImageData* image, vtkDataArray* array, bool colored)
{
  vtkNew<vtkImageData> plain;
  plain->CopyStructure(image);
  plain->GetPointData()->SetScalars(GetValues(array, mapper->GetIsoComponent()));
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(plain);
  edges->SetComputeNormals(colored);
  edges->ComputeScalarsOff();
  if (vtkDataArray* colors = colored ? FindColors(mapper, image, false) : nullptr)
  {
    plain->GetPointData()->AddArray(colors);
    edges->InterpolateAttributesOn();
  }
  for (int index = 0; index < mapper->GetNumberOfIsoValues(); ++index)
  {
    edges->SetValue(index, mapper->GetIsoValue(index));
  }
  if (mapper->GetNumberOfIsoValues() == 0)
  {
    edges->SetValue(0, mapper->GetSuggestedIsoValue());
  }
  edges->Update();
  return edges->GetOutput();
}

/// The place of a point among the image's samples, from its first one on.
void GetPlace(vtkImageData* image, const double point[3], double place[3])
{
  image->TransformPhysicalPointToContinuousIndex(point, place);
  for (int axis = 0; axis < 3; ++axis)
  {
    place[axis] -= image->GetExtent()[2 * axis];
  }
}

vtkIdType FindCell(vtkImageData* image, const double point[3])
{
  double place[3];
  GetPlace(image, point, place);
  int cell[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const int last = std::max(image->GetDimensions()[axis] - 2, 0);
    cell[axis] = std::clamp(static_cast<int>(std::floor(place[axis])), 0, last);
  }
  return vtkStructuredData::ComputeCellId(image->GetDimensions(), cell);
}

vtkIdType FindPoint(vtkImageData* image, const double point[3])
{
  double place[3];
  GetPlace(image, point, place);
  int sample[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    sample[axis] =
      std::clamp(static_cast<int>(std::lround(place[axis])), 0, image->GetDimensions()[axis] - 1);
  }
  return vtkStructuredData::ComputePointId(image->GetDimensions(), sample);
}

/// Whether both are parts of one lattice.
bool HaveOneLattice(vtkImageData* a, vtkImageData* b)
{
  const double* const directions[2] = { a->GetDirectionMatrix()->GetData(),
    b->GetDirectionMatrix()->GetData() };
  return std::equal(a->GetOrigin(), a->GetOrigin() + 3, b->GetOrigin()) &&
    std::equal(a->GetSpacing(), a->GetSpacing() + 3, b->GetSpacing()) &&
    std::equal(directions[0], directions[0] + 9, directions[1]);
}

/// Says of each triangle which cell of `counted` it is in, and of each point which sample is nearest.
vtkSmartPointer<vtkPolyData> AttachIds(
  vtkImageData* image, vtkImageData* counted, vtkPolyData* triangles, unsigned block)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(triangles->GetPoints());
  result->GetPointData()->ShallowCopy(triangles->GetPointData());
  vtkNew<vtkIdTypeArray> cells;
  vtkNew<vtkUnsignedIntArray> blocks;
  cells->SetName("vtkOriginalCellIds");
  blocks->SetName("vtkCompositeIndex");
  vtkUnsignedCharArray* ghosts = image->GetCellGhostArray();
  vtkNew<vtkCellArray> kept;
  vtkCellArray* all = triangles->GetPolys();
  vtkIdType size;
  const vtkIdType* corners;
  for (all->InitTraversal(); all->GetNextCell(size, corners) != 0;)
  {
    double center[3] = { 0.0, 0.0, 0.0 };
    for (vtkIdType corner = 0; corner < size; ++corner)
    {
      double point[3];
      triangles->GetPoint(corners[corner], point);
      for (int axis = 0; axis < 3; ++axis)
      {
        center[axis] += point[axis] / static_cast<double>(size);
      }
    }
    const vtkIdType cell = FindCell(image, center);
    constexpr int hidden = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    if (!ghosts || (ghosts->GetValue(cell) & hidden) == 0)
    {
      kept->InsertNextCell(size, corners);
      cells->InsertNextValue(FindCell(counted, center));
      blocks->InsertNextValue(block);
    }
  }
  result->SetPolys(kept);
  result->GetCellData()->AddArray(cells);
  vtkNew<vtkIdTypeArray> points;
  points->SetName("vtkOriginalPointIds");
  vtkNew<vtkUnsignedIntArray> pointBlocks;
  pointBlocks->SetName("vtkCompositeIndex");
  for (vtkIdType number = 0; number < triangles->GetNumberOfPoints(); ++number)
  {
    points->InsertNextValue(FindPoint(counted, triangles->GetPoint(number)));
    pointBlocks->InsertNextValue(block);
  }
  result->GetPointData()->AddArray(points);
  if (block > 0)
  {
    result->GetCellData()->AddArray(blocks);
    result->GetPointData()->AddArray(pointBlocks);
  }
  return result;
}

/// Gives each triangle the value of its cell.
void AttachColors(vtkDataArray* colors, vtkPolyData* triangles)
{
  auto* cells =
    vtkIdTypeArray::SafeDownCast(triangles->GetCellData()->GetArray("vtkOriginalCellIds"));
  vtkSmartPointer<vtkDataArray> values;
  values.TakeReference(colors->NewInstance());
  values->SetName(colors->GetName());
  values->SetNumberOfComponents(colors->GetNumberOfComponents());
  values->SetNumberOfTuples(cells->GetNumberOfTuples());
  for (vtkIdType number = 0; number < cells->GetNumberOfTuples(); ++number)
  {
    values->SetTuple(number, cells->GetValue(number), colors);
  }
  triangles->GetCellData()->AddArray(values);
}

void AddImage(vtkDSMVolumeMapper* mapper, vtkImageData* image, vtkDataObject* source,
  unsigned block, bool colored, vtkMultiBlockDataSet* geometry)
{
  if (!image || image->GetNumberOfCells() == 0)
  {
    return;
  }
  const std::string name = mapper->GetIsoArray();
  vtkPointData* data = image->GetPointData();
  vtkDataArray* array = name.empty() ? data->GetScalars() : data->GetArray(name.c_str());
  if (!array)
  {
    return;
  }
  if (image->GetNumberOfCells() > vtkPVDSMIsosurfaceGeometry::MostCells)
  {
    vtkErrorWithObjectMacro(mapper,
      "Nothing can be selected in or exported of a block of "
        << image->GetNumberOfCells() << " cells on one rank; at most "
        << vtkPVDSMIsosurfaceGeometry::MostCells << " can. Take more ranks, or extract a part.");
    return;
  }
  auto* counted = vtkImageData::SafeDownCast(source);
  if (!counted || counted->GetNumberOfCells() == 0 || !HaveOneLattice(image, counted))
  {
    counted = image;
  }
  const vtkSmartPointer<vtkPolyData> triangles =
    AttachIds(image, counted, Extract(mapper, image, array, colored), block);
  if (vtkDataArray* colors = colored ? FindColors(mapper, image, true) : nullptr)
  {
    AttachColors(colors, triangles);
  }
  geometry->SetBlock(geometry->GetNumberOfBlocks(), triangles);
}

vtkSmartPointer<vtkMultiBlockDataSet> MakeBlocks(
  vtkDSMVolumeMapper* mapper, vtkDataObject* source, bool colored)
{
  auto geometry = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  vtkDataObject* data = mapper->GetDataObjectInput();
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> leaf;
    leaf.TakeReference(composite->NewIterator());
    auto* sources = vtkCompositeDataSet::SafeDownCast(source);
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      AddImage(mapper, vtkImageData::SafeDownCast(leaf->GetCurrentDataObject()),
        sources ? sources->GetDataSet(leaf) : nullptr, leaf->GetCurrentFlatIndex(), colored,
        geometry);
    }
  }
  else
  {
    AddImage(mapper, vtkImageData::SafeDownCast(data), source, 0, colored, geometry);
  }
  return geometry;
}

} // namespace

vtkSmartPointer<vtkMultiBlockDataSet> vtkPVDSMIsosurfaceGeometry::Make(
  vtkDSMVolumeMapper* mapper, vtkDataObject* source)
{
  return MakeBlocks(mapper, source, false);
}

vtkSmartPointer<vtkPolyData> vtkPVDSMIsosurfaceGeometry::MakeColored(vtkDSMVolumeMapper* mapper)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> blocks = MakeBlocks(mapper, nullptr, true);
  vtkNew<vtkAppendPolyData> append;
  for (unsigned block = 0; block < blocks->GetNumberOfBlocks(); ++block)
  {
    append->AddInputData(vtkPolyData::SafeDownCast(blocks->GetBlock(block)));
  }
  if (blocks->GetNumberOfBlocks() > 0)
  {
    append->Update();
  }
  return append->GetOutput();
}
