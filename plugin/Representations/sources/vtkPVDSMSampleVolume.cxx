// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSampleVolume.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMSampleVolume);

vtkPVDSMSampleVolume::vtkPVDSMSampleVolume() = default;
vtkPVDSMSampleVolume::~vtkPVDSMSampleVolume() = default;

void vtkPVDSMSampleVolume::SetKind(int kind)
{
  this->Superclass::SetKind(kind);
}

void vtkPVDSMSampleVolume::SetDimensions(int i, int j, int k)
{
  this->Superclass::SetDimensions(i, j, k);
}

void vtkPVDSMSampleVolume::SetDimensions(const int dimensions[3])
{
  this->Superclass::SetDimensions(dimensions);
}

void vtkPVDSMSampleVolume::SetScalarType(int type)
{
  this->Superclass::SetScalarType(type);
}
