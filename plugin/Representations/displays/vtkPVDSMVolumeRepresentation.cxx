// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVolumeRepresentation.h"

#include "vtkDSMVolumeMapper.h"

#include "vtkColorTransferFunction.h"
#include "vtkObjectFactory.h"
#include "vtkPiecewiseFunction.h"
#include "vtkProperty.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

vtkStandardNewMacro(vtkPVDSMVolumeRepresentation);

vtkPVDSMVolumeRepresentation::vtkPVDSMVolumeRepresentation()
{
  this->SelectByPlaces();
  this->Volume->SetProperty(this->Property);
  this->Mapper->AutomaticIsoValueOff();
  this->Mapper->SurfacesOnlyOff();
}

vtkPVDSMVolumeRepresentation::~vtkPVDSMVolumeRepresentation() = default;

int vtkPVDSMVolumeRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  // As ParaView's Volume does.
  const bool areDependent = !this->UseSeparateOpacityArray &&
    (!this->Mapper->GetMapScalars() || this->MultiComponentsMapping);
  this->Property->SetIndependentComponents(!areDependent);
  if (areDependent)
  {
    this->Mapper->SetIsoComponent(0);
  }
  else if (auto* const map = this->Mapper->GetLookupTable())
  {
    const bool isOne = map->GetVectorMode() == vtkScalarsToColors::COMPONENT;
    this->Mapper->SetIsoComponent(isOne ? map->GetVectorComponent() : -1);
    // As vtkSmartVolumeMapper does: the others are not asked for.
    for (int component = 0; component < VTK_MAX_VRCOMP; ++component)
    {
      this->Property->SetComponentWeight(
        component, isOne && component != map->GetVectorComponent() ? 0.0 : 1.0);
    }
  }
  vtkProperty* const surface = this->Mapper->GetSurfaceProperty();
  this->Property->SetAmbient(surface->GetAmbient());
  this->Property->SetDiffuse(surface->GetDiffuse());
  this->Property->SetSpecular(surface->GetSpecular());
  this->Property->SetSpecularPower(surface->GetSpecularPower());
  return this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
}

void vtkPVDSMVolumeRepresentation::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  if (index == 0)
  {
    this->Mapper->SetIsoArray(name ? name : "");
  }
}

void vtkPVDSMVolumeRepresentation::SetLookupTable(vtkScalarsToColors* table)
{
  this->Superclass::SetLookupTable(table);
  if (auto* const function = vtkColorTransferFunction::SafeDownCast(table))
  {
    this->Property->SetColor(function);
  }
}

void vtkPVDSMVolumeRepresentation::SetScalarOpacity(vtkPiecewiseFunction* function)
{
  this->Property->SetScalarOpacity(function);
}

void vtkPVDSMVolumeRepresentation::SetScalarOpacityUnitDistance(double distance)
{
  this->Property->SetScalarOpacityUnitDistance(distance);
}

void vtkPVDSMVolumeRepresentation::SetShade(bool shade)
{
  this->Property->SetShade(shade);
}

void vtkPVDSMVolumeRepresentation::SetAnisotropy(double anisotropy)
{
  this->Property->SetScatteringAnisotropy(static_cast<float>(anisotropy));
}

void vtkPVDSMVolumeRepresentation::SetScattering(double part)
{
  this->Mapper->SetScattering(part);
}

void vtkPVDSMVolumeRepresentation::SetBlendMode(int mode)
{
  this->Mapper->SetBlendMode(mode);
}

void vtkPVDSMVolumeRepresentation::SetMultiComponentsMapping(bool maps)
{
  this->MultiComponentsMapping = maps;
}

void vtkPVDSMVolumeRepresentation::SetUseSeparateOpacityArray(bool use)
{
  this->UseSeparateOpacityArray = use;
  this->UpdateOpacityArray();
}

void vtkPVDSMVolumeRepresentation::SelectOpacityArray(
  int, int, int, int vtkNotUsed(association), const char* name)
{
  this->OpacityArray = name ? name : "";
  this->UpdateOpacityArray();
}

void vtkPVDSMVolumeRepresentation::SelectOpacityArrayComponent(int component)
{
  this->Mapper->SetOpacityComponent(component);
}

void vtkPVDSMVolumeRepresentation::UpdateOpacityArray()
{
  this->Mapper->SetOpacityArray(this->UseSeparateOpacityArray ? this->OpacityArray : "");
}
