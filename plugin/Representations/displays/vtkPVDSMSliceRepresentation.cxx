// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSliceRepresentation.h"

#include "vtkDSMVolumeMapper.h"

#include "vtkObjectFactory.h"
#include "vtkPiecewiseFunction.h"

vtkStandardNewMacro(vtkPVDSMSliceRepresentation);

vtkPVDSMSliceRepresentation::vtkPVDSMSliceRepresentation()
{
  this->Mapper->AutomaticIsoValueOff();
  this->Mapper->SlicingOn();
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
  this->Mapper->SetSliceOpacity(this->OpacityFromMap ? this->ScalarOpacity.Get() : nullptr);
}

void vtkPVDSMSliceRepresentation::SetSliceLighting(bool isLit)
{
  this->Mapper->SetSliceLighting(isLit);
}

void vtkPVDSMSliceRepresentation::SetInterpolateSlices(bool interpolate)
{
  this->Mapper->SetInterpolateSlices(interpolate);
}

bool vtkPVDSMSliceRepresentation::IsTranslucent() const
{
  return this->Superclass::IsTranslucent() || this->Mapper->GetSliceOpacity();
}
