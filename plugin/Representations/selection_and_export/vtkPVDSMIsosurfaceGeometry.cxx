// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMIsosurfaceGeometry.h"

#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMExportLook.h"
#include "vtkPVDSMGridPlace.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkScalarsToColors.h"
#include "vtkStructuredData.h"
#include "vtkUniformGridAMR.h"

#include <algorithm>
#include <array>

namespace
{

/// Numbers of an image's cells, or points, become those that the same places have in `counted`.
void Count(vtkDataArray* array, vtkDataSet* image, vtkDataSet* counted, bool ofCells)
{
  auto* const ids = vtkIdTypeArray::SafeDownCast(array);
  int from[6];
  int to[6];
  std::copy_n(vtkPVDSMGridPlace::GetExtent(image), 6, from);
  std::copy_n(vtkPVDSMGridPlace::GetExtent(counted), 6, to);
  for (vtkIdType number = 0; number < ids->GetNumberOfValues(); ++number)
  {
    int place[3];
    if (ofCells)
    {
      vtkStructuredData::ComputeCellStructuredCoordsForExtent(ids->GetValue(number), from, place);
      ids->SetValue(number, vtkStructuredData::ComputeCellIdForExtent(to, place));
    }
    else
    {
      vtkStructuredData::ComputePointStructuredCoordsForExtent(ids->GetValue(number), from, place);
      ids->SetValue(number, vtkStructuredData::ComputePointIdForExtent(to, place));
    }
  }
}

/// Returns the block that triangles are of; 0 where there are no blocks, or no triangles.
unsigned int GetBlock(vtkPolyData* triangles)
{
  vtkDataArray* const blocks = triangles->GetCellData()->GetArray("vtkCompositeIndex");
  return blocks && blocks->GetNumberOfTuples() > 0 ? static_cast<unsigned int>(blocks->GetTuple1(0))
                                                   : 0;
}

/// Calls `visit(dataset, block)` for the data, or the blocks of composite data with their flat indices.
template <class Visit>
void ForEachBlock(vtkDataObject* data, const Visit& visit)
{
  auto* const all = vtkCompositeDataSet::SafeDownCast(data);
  if (!all)
  {
    visit(data, 0u);
    return;
  }
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(all->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    visit(leaf->GetCurrentDataObject(), leaf->GetCurrentFlatIndex());
  }
}

bool HasTrees(vtkDataObject* data)
{
  bool has = false;
  ForEachBlock(data,
    [&](vtkDataObject* dataset, unsigned int)
    { has = has || vtkHyperTreeGrid::SafeDownCast(dataset); });
  return has;
}

/// Returns the image with a flat index, or the data, which are one; null if there is none.
vtkDataSet* FindImage(vtkDataObject* data, unsigned int block)
{
  vtkDataSet* image = nullptr;
  ForEachBlock(data,
    [&](vtkDataObject* dataset, unsigned int index)
    {
      if (dataset == data || index == block)
      {
        image = vtkPVDSMGridPlace::FindImage(dataset);
      }
    });
  return image;
}

vtkPVDSMExportLook FindLook(vtkDSMVolumeMapper* mapper, unsigned block)
{
  vtkPVDSMExportLook found;
  const auto known = mapper->GetBlockLooks().find(block);
  if (known == mapper->GetBlockLooks().end())
  {
    return found;
  }
  const vtkDSMBlockLook& look = known->second;
  found.Color = look.Color;
  found.Opacity = look.Opacity;
  if (!look.Color && look.Value && mapper->GetBlockScalarVisibility() && mapper->GetLookupTable())
  {
    std::array<double, 3> color{};
    mapper->GetLookupTable()->GetColor(*look.Value, color.data());
    found.Color = color;
  }
  return found;
}

} // namespace

vtkSmartPointer<vtkMultiBlockDataSet> vtkPVDSMIsosurfaceGeometry::Make(
  vtkDSMScene* scene, vtkDSMVolumeMapper* mapper, vtkDataObject* source)
{
  vtkDataObject* const data = mapper->GetDataObjectInput();
  if (HasTrees(data))
  {
    vtkWarningWithObjectMacro(scene,
      "Isosurfaces of hyper tree grids cannot be selected, because ParaView does not extract their "
      "cells. Apply HyperTreeGrid To UnstructuredGrid and Contour, and select on the result.");
  }
  auto surfaces = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  if (!scene->ExtractIsosurfaces(mapper, true, surfaces))
  {
    surfaces->Initialize();
  }
  // Triangles of AMR are of several blocks; the numbers in these do not change.
  for (unsigned int part = 0;
       !vtkUniformGridAMR::SafeDownCast(data) && part < surfaces->GetNumberOfBlocks(); ++part)
  {
    auto* const triangles = vtkPolyData::SafeDownCast(surfaces->GetBlock(part));
    vtkDataSet* const image = FindImage(data, GetBlock(triangles));
    vtkDataSet* const counted = FindImage(source, GetBlock(triangles));
    if (image && counted && vtkPVDSMGridPlace::HaveOneLattice(image, counted))
    {
      Count(triangles->GetCellData()->GetArray("vtkOriginalCellIds"), image, counted, true);
      Count(triangles->GetPointData()->GetArray("vtkOriginalPointIds"), image, counted, false);
    }
  }
  return surfaces;
}

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMIsosurfaceGeometry::MakeColored(
  vtkDSMScene* scene, vtkDSMVolumeMapper* mapper)
{
  vtkNew<vtkMultiBlockDataSet> surfaces;
  vtkPVDSMExportParts parts;
  if (!scene->ExtractIsosurfaces(mapper, false, surfaces))
  {
    return {};
  }
  for (unsigned int part = 0; part < surfaces->GetNumberOfBlocks(); ++part)
  {
    auto* const triangles = vtkPolyData::SafeDownCast(surfaces->GetBlock(part));
    parts.Add(triangles, FindLook(mapper, GetBlock(triangles)));
  }
  return parts.Finish();
}
