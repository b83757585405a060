// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMLightOptions.h"

#include "vtkMath.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMLightOptions);

vtkPVDSMLightOptions::vtkPVDSMLightOptions() = default;
vtkPVDSMLightOptions::~vtkPVDSMLightOptions() = default;

void vtkPVDSMLightOptions::SetShadows(bool shadows)
{
  this->Superclass::SetShadows(shadows);
}

void vtkPVDSMLightOptions::SetLightRadius(double radius)
{
  this->Superclass::SetLightRadius(radius);
}

void vtkPVDSMLightOptions::SetAmbientOcclusionSamples(int samples)
{
  this->Superclass::SetAmbientOcclusionSamples(samples);
}

void vtkPVDSMLightOptions::SetAmbientOcclusionDistance(double distance)
{
  this->Superclass::SetAmbientOcclusionDistance(distance);
}

void vtkPVDSMLightOptions::SetLook(int look)
{
  this->Superclass::SetLook(look == AutomaticLook ? PlainLook : look);
}

void vtkPVDSMLightOptions::SetEnvironmentLight(double strength)
{
  this->Superclass::SetEnvironmentLight(strength);
}

void vtkPVDSMLightOptions::SetReflectivity(double part)
{
  this->Superclass::SetReflectivity(part);
}

void vtkPVDSMLightOptions::SetMaxBounces(int bounces)
{
  this->Superclass::SetMaxBounces(bounces);
}

void vtkPVDSMLightOptions::SetSamples(double samples)
{
  this->SetSamplesPerPixel(vtkMath::Round(samples));
}

void vtkPVDSMLightOptions::SetShowLegend(bool show)
{
  this->Superclass::SetShowLegend(show);
}

void vtkPVDSMLightOptions::SetShowStatistics(bool show)
{
  this->Superclass::SetShowStatistics(show);
}

void vtkPVDSMLightOptions::SetDebugView(int view)
{
  this->Superclass::SetDebugView(view);
}
