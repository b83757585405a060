// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVolumeRepresentation.h"

#include "vtkDSMLightOptions.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkColorTransferFunction.h"
#include "vtkContourValues.h"
#include "vtkDataObject.h"
#include "vtkObjectFactory.h"
#include "vtkPVTransferFunction2D.h"
#include "vtkPiecewiseFunction.h"
#include "vtkProperty.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

vtkStandardNewMacro(vtkPVDSMVolumeRepresentation);

vtkPVDSMVolumeRepresentation::vtkPVDSMVolumeRepresentation()
{
  this->SelectByPlaces();
  this->Volume->SetProperty(this->VolumeProperty);
  this->VolumeMapper->AutomaticIsoValueOff();
  this->VolumeMapper->SurfacesOnlyOff();
  this->VolumeProperty->SetInterpolationTypeToLinear();
}

vtkPVDSMVolumeRepresentation::~vtkPVDSMVolumeRepresentation() = default;

int vtkPVDSMVolumeRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  // As ParaView's Volume does: without an array there is nothing to see.
  this->Volume->SetVisibility(this->GetVisibility() && !this->VolumeMapper->GetIsoArray().empty());
  const bool areDependent = !this->UseSeparateOpacityArray &&
    (!this->VolumeMapper->GetMapScalars() || this->MultiComponentsMapping);
  this->VolumeProperty->SetIndependentComponents(!areDependent);
  if (areDependent)
  {
    this->VolumeMapper->SetIsoComponent(0);
  }
  else if (auto* const map = this->VolumeMapper->GetLookupTable())
  {
    const bool isOne = map->GetVectorMode() == vtkScalarsToColors::COMPONENT;
    this->VolumeMapper->SetIsoComponent(isOne ? map->GetVectorComponent() : -1);
    // As vtkSmartVolumeMapper does: the others are not asked for.
    for (int component = 0; component < VTK_MAX_VRCOMP; ++component)
    {
      this->VolumeProperty->SetComponentWeight(
        component, isOne && component != map->GetVectorComponent() ? 0.0 : 1.0);
    }
  }
  this->VolumeMapper->SetScattering(this->GetScatteredPart());
  this->VolumeProperty->SetAmbient(this->Ambient);
  this->VolumeProperty->SetDiffuse(this->Diffuse);
  this->VolumeProperty->SetSpecular(this->Specular);
  this->VolumeProperty->SetSpecularPower(this->Property->GetSpecularPower());
  return this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
}

void vtkPVDSMVolumeRepresentation::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  if (index == 0)
  {
    this->VolumeMapper->SetIsoArray(name ? name : "");
    this->VolumeMapper->SetIsoArrayOnCells(association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
  }
}

void vtkPVDSMVolumeRepresentation::SetLookupTable(vtkScalarsToColors* table)
{
  this->Superclass::SetLookupTable(table);
  if (auto* const function = vtkColorTransferFunction::SafeDownCast(table))
  {
    this->VolumeProperty->SetColor(function);
  }
}

void vtkPVDSMVolumeRepresentation::SetScalarOpacity(vtkPiecewiseFunction* function)
{
  this->VolumeProperty->SetScalarOpacity(function);
}

void vtkPVDSMVolumeRepresentation::SetScalarOpacityUnitDistance(double distance)
{
  this->VolumeProperty->SetScalarOpacityUnitDistance(distance);
}

void vtkPVDSMVolumeRepresentation::SetShade(bool shade)
{
  this->VolumeProperty->SetShade(shade);
}

void vtkPVDSMVolumeRepresentation::SetInterpolationType(int type)
{
  // Volume's Cubic is linear, too: it is what vtkVolumeProperty makes of it.
  this->VolumeProperty->SetInterpolationType(
    type == VTK_NEAREST_INTERPOLATION ? VTK_NEAREST_INTERPOLATION : VTK_LINEAR_INTERPOLATION);
}

void vtkPVDSMVolumeRepresentation::SetVolumeAnisotropy(double anisotropy)
{
  this->VolumeProperty->SetScatteringAnisotropy(static_cast<float>(anisotropy));
}

void vtkPVDSMVolumeRepresentation::SetScattering(double part)
{
  this->Scattering = part;
}

/// Without shadows and occlusion, the light is Volume's.
double vtkPVDSMVolumeRepresentation::GetScatteredPart() const
{
  vtkDSMScene* const scene = this->Display->GetScene();
  const vtkDSMLightOptions* const light = scene ? scene->GetLightOptions() : nullptr;
  const bool isObstructed =
    light && (light->GetShadows() || light->GetAmbientOcclusionSamples() > 0);
  return isObstructed && this->VolumeProperty->GetShade() != 0 ? this->Scattering : 0.0;
}

void vtkPVDSMVolumeRepresentation::SetBlendMode(int mode)
{
  this->VolumeMapper->SetBlendMode(mode);
}

void vtkPVDSMVolumeRepresentation::SetNumberOfIsosurfaces(int number)
{
  this->VolumeProperty->GetIsoSurfaceValues()->SetNumberOfContours(number);
}

void vtkPVDSMVolumeRepresentation::SetIsosurfaceValue(int index, double value)
{
  this->VolumeProperty->GetIsoSurfaceValues()->SetValue(index, value);
}

std::string vtkPVDSMVolumeRepresentation::GetExportObstacle() const
{
  return "A DSM Volume is not exported, because the file holds surfaces only. Export its "
         "isosurfaces (DSM Ray Traced, or the filter Contour), or save a screenshot.";
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
  int, int, int, int association, const char* name)
{
  this->OpacityArray = name ? name : "";
  this->VolumeMapper->SetOpacityArrayOnCells(association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
  this->UpdateOpacityArray();
}

void vtkPVDSMVolumeRepresentation::SelectOpacityArrayComponent(int component)
{
  this->VolumeMapper->SetOpacityComponent(component);
}

void vtkPVDSMVolumeRepresentation::UpdateOpacityArray()
{
  this->VolumeMapper->SetOpacityArray(this->UseSeparateOpacityArray ? this->OpacityArray : "");
}

void vtkPVDSMVolumeRepresentation::SetUseTransfer2D(bool use)
{
  this->VolumeProperty->SetTransferFunctionMode(
    use ? vtkVolumeProperty::TF_2D : vtkVolumeProperty::TF_1D);
}

/// The function has one image, which it fills again when its boxes change.
void vtkPVDSMVolumeRepresentation::SetTransferFunction2D(vtkPVTransferFunction2D* function)
{
  this->TransferFunction2D = function;
  this->VolumeProperty->SetTransferFunction2D(function ? function->GetFunction() : nullptr);
}

void vtkPVDSMVolumeRepresentation::SetUseGradientForTransfer2D(bool use)
{
  this->UseGradientForTransfer2D = use;
  this->UpdateSecondArray();
}

void vtkPVDSMVolumeRepresentation::SelectColorArray2(int, int, int, int, const char* name)
{
  this->SecondArray = name ? name : "";
  this->UpdateSecondArray();
}

void vtkPVDSMVolumeRepresentation::SelectColorArray2Component(int component)
{
  this->VolumeMapper->SetTransfer2DYAxisComponent(component);
}

void vtkPVDSMVolumeRepresentation::UpdateSecondArray()
{
  this->VolumeMapper->SetTransfer2DYAxisArray(
    this->UseGradientForTransfer2D ? nullptr : this->SecondArray.c_str());
}
