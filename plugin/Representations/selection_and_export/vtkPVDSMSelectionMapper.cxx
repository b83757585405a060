// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSelectionMapper.h"

#include "vtkDataObject.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <utility>

vtkStandardNewMacro(vtkPVDSMSelectionMapper);

vtkPVDSMSelectionMapper::vtkPVDSMSelectionMapper()
{
  vtkMath::UninitializeBounds(this->ShownBounds);
  this->ScalarVisibilityOff();
  this->SetProcessIdArrayName("vtkProcessId");
  this->SetCompositeIdArrayName("vtkCompositeIndex");
  this->SetPointIdArrayName("vtkOriginalPointIds");
  this->SetCellIdArrayName("vtkOriginalCellIds");
}

vtkPVDSMSelectionMapper::~vtkPVDSMSelectionMapper() = default;

void vtkPVDSMSelectionMapper::SetSource(std::function<vtkSmartPointer<vtkDataObject>()> source)
{
  this->Source = std::move(source);
}

void vtkPVDSMSelectionMapper::SetSelecting(bool selecting)
{
  this->Selecting = selecting;
}

void vtkPVDSMSelectionMapper::Render(vtkRenderer* renderer, vtkActor* actor)
{
  if (!this->Selecting)
  {
    if (this->Filled)
    {
      this->Filled = false;
      this->SetInputDataObject(0, nullptr);
      this->ReleaseGraphicsResources(renderer->GetRenderWindow());
    }
    return;
  }
  if (!this->Filled)
  {
    vtkSmartPointer<vtkDataObject> geometry = this->Source ? this->Source() : nullptr;
    if (!geometry)
    {
      geometry = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    }
    this->SetInputDataObject(0, geometry);
    this->Filled = true;
  }
  this->Superclass::Render(renderer, actor);
}

void vtkPVDSMSelectionMapper::SetShownBounds(const double* bounds)
{
  if (bounds)
  {
    std::copy_n(bounds, 6, this->ShownBounds);
  }
  else
  {
    vtkMath::UninitializeBounds(this->ShownBounds);
  }
}

double* vtkPVDSMSelectionMapper::GetBounds()
{
  std::copy_n(this->ShownBounds, 6, this->Bounds);
  return this->Bounds;
}

void vtkPVDSMSelectionMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Selecting: " << this->Selecting << "\n";
  os << indent << "Filled: " << this->Filled << "\n";
}
