// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMMixedRepresentation.h"

#include "vtkDSMErrorGuard.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkBoundingBox.h"
#include "vtkCommand.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataObjectTree.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkPVLODActor.h"
#include "vtkPolyData.h"

namespace
{

/// Returns a copy of a dataset's structure with those of its blocks that are volumes, or with the others.
vtkSmartPointer<vtkDataObject> CopyBlocks(vtkDataObject* data, bool areVolumes)
{
  auto copy = vtkSmartPointer<vtkDataObject>::Take(data->NewInstance());
  auto* const tree = vtkDataObjectTree::SafeDownCast(copy);
  if (!tree)
  {
    if (vtkDSMVolumeMapper::IsVolume(data) == areVolumes)
    {
      copy->ShallowCopy(data);
    }
    return copy;
  }
  tree->ShallowCopy(data);
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(tree->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    if (vtkDSMVolumeMapper::IsVolume(leaf->GetCurrentDataObject()) != areVolumes)
    {
      tree->SetDataSet(leaf, nullptr);
    }
  }
  return copy;
}

} // namespace

vtkStandardNewMacro(vtkPVDSMMixedRepresentation);

vtkPVDSMMixedRepresentation::vtkPVDSMMixedRepresentation()
{
  this->vtkPVDSMMixedRepresentation::ShowVolume();
  for (vtkObject* mapper :
    { static_cast<vtkObject*>(this->VolumeMapper), static_cast<vtkObject*>(this->Mapper) })
  {
    mapper->AddObserver(vtkCommand::WarningEvent, this, &vtkPVDSMMixedRepresentation::OnWarning);
  }
}

void vtkPVDSMMixedRepresentation::OnWarning(vtkObject*, unsigned long, void* text)
{
  if (this->ShowsSurface())
  {
    vtkOutputWindow::GetInstance()->DisplayWarningText(static_cast<const char*>(text));
  }
}

vtkPVDSMMixedRepresentation::~vtkPVDSMMixedRepresentation() = default;

void vtkPVDSMMixedRepresentation::ShowVolume()
{
  this->Superclass::ShowVolume();
  this->Display->ShowBeside(this->Actor, this->GetMapper());
}

void vtkPVDSMMixedRepresentation::SetVisibility(bool visible)
{
  this->Superclass::SetVisibility(visible);
  this->Actor->SetVisibility(visible);
}

int vtkPVDSMMixedRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->RequestGhostCellsIfNeeded = this->NeedsGhostCells || this->ShowsSurface();
  return this->vtkPVDSMGeometryRepresentation::RequestUpdateExtent(request, input, output);
}

int vtkPVDSMMixedRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  if (this->ShowsSurface())
  {
    this->AllShown = nullptr;
    return this->Superclass::RequestData(request, input, output);
  }
  return vtkDSMErrorGuard::Run(this, "updating", this->GetLogName().c_str(),
    [&]
    {
      vtkDataObject* const data = vtkDataObject::GetData(input[0], 0);
      this->TakeInput(data);
      this->RestoreSurfaceInput(data ? CopyBlocks(data, false).Get() : nullptr);
      return this->vtkPVDSMGeometryRepresentation::RequestData(request, input, output);
    });
}

vtkSmartPointer<vtkDataObject> vtkPVDSMMixedRepresentation::ChooseVolumes(vtkDataObject* shown)
{
  this->AllShown = shown;
  return shown ? CopyBlocks(shown, true) : nullptr;
}

vtkDataObject* vtkPVDSMMixedRepresentation::GetRenderedDataObject(int port)
{
  return this->ShowsSurface() ? this->Superclass::GetRenderedDataObject(port)
                              : this->AllShown.Get();
}

vtkBoundingBox vtkPVDSMMixedRepresentation::GetShownBounds()
{
  vtkBoundingBox bounds = this->Superclass::GetShownBounds();
  bounds.AddBox(this->vtkPVDSMGeometryRepresentation::GetShownBounds());
  return bounds;
}

void vtkPVDSMMixedRepresentation::PrepareRender(vtkInformation* inInfo)
{
  if (!this->ShowsSurface())
  {
    this->PrepareSurface();
  }
  this->Superclass::PrepareRender(inInfo);
}

bool vtkPVDSMMixedRepresentation::IsTranslucent()
{
  return this->Superclass::IsTranslucent() || this->vtkPVDSMGeometryRepresentation::IsTranslucent();
}

vtkSmartPointer<vtkDataObject> vtkPVDSMMixedRepresentation::MakeSelectable()
{
  vtkSmartPointer<vtkDataObject> volumes = this->Superclass::MakeSelectable();
  auto* const surfaces = vtkCompositeDataSet::SafeDownCast(this->GetSurface());
  if (this->ShowsSurface() || !surfaces)
  {
    return volumes;
  }
  vtkSmartPointer<vtkMultiBlockDataSet> all = vtkMultiBlockDataSet::SafeDownCast(volumes);
  if (!all)
  {
    all = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  }
  const auto* const attributes = this->GetMapper()->GetCompositeDataDisplayAttributes();
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(surfaces->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    vtkDataObject* const block = leaf->GetCurrentDataObject();
    if (!attributes->HasBlockVisibility(block) || attributes->GetBlockVisibility(block))
    {
      all->SetBlock(all->GetNumberOfBlocks(), block);
    }
  }
  return all;
}

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMMixedRepresentation::GetTriangles()
{
  auto triangles = this->Superclass::GetTriangles();
  if (!this->ShowsSurface() && !this->Display->IsDrawnHere())
  {
    for (const auto& surface : this->vtkPVDSMGeometryRepresentation::GetTriangles())
    {
      triangles.push_back(surface);
    }
  }
  return triangles;
}
