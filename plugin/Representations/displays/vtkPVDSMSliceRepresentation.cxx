// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSliceRepresentation.h"

#include "vtkDSMVolumeMapper.h"

#include "vtkObjectFactory.h"
#include "vtkPiecewiseFunction.h"

vtkStandardNewMacro(vtkPVDSMSliceRepresentation);

vtkPVDSMSliceRepresentation::vtkPVDSMSliceRepresentation()
{
  this->VolumeMapper->AutomaticIsoValueOff();
  this->VolumeMapper->SlicingOn();
  this->SelectByPlaces();
}

vtkPVDSMSliceRepresentation::~vtkPVDSMSliceRepresentation() = default;

void vtkPVDSMSliceRepresentation::SetScalarOpacity(vtkPiecewiseFunction* function)
{
  this->ScalarOpacity = function;
  this->ChooseOpacity();
}

void vtkPVDSMSliceRepresentation::SetOpacityFromMap(bool fromMap)
{
  this->OpacityFromMap = fromMap;
  this->ChooseOpacity();
}

void vtkPVDSMSliceRepresentation::ChooseOpacity()
{
  this->VolumeMapper->SetSliceOpacity(this->OpacityFromMap ? this->ScalarOpacity.Get() : nullptr);
}

std::string vtkPVDSMSliceRepresentation::GetExportObstacle() const
{
  return "DSM Slices are not exported. Export those of the filter Slice, or save a screenshot.";
}

bool vtkPVDSMSliceRepresentation::IsTranslucent()
{
  return this->Superclass::IsTranslucent() || this->VolumeMapper->GetSliceOpacity();
}
