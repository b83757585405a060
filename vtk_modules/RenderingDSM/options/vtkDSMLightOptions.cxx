// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMLightOptions.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDSMLightOptions);

vtkDSMLightOptions::vtkDSMLightOptions() = default;
vtkDSMLightOptions::~vtkDSMLightOptions() = default;

void vtkDSMLightOptions::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Shadows: " << this->Shadows << "\n";
  os << indent << "LightRadius: " << this->LightRadius << "\n";
  os << indent << "AmbientOcclusionSamples: " << this->AmbientOcclusionSamples << "\n";
  os << indent << "AmbientOcclusionDistance: " << this->AmbientOcclusionDistance << "\n";
  os << indent << "Look: " << this->Look << "\n";
  os << indent << "EnvironmentLight: " << this->EnvironmentLight << "\n";
  os << indent << "Reflectivity: " << this->Reflectivity << "\n";
  os << indent << "MaxBounces: " << this->MaxBounces << "\n";
  os << indent << "SamplesPerPixel: " << this->SamplesPerPixel << "\n";
  os << indent << "DebugView: " << this->DebugView << "\n";
  os << indent << "ShowLegend: " << this->ShowLegend << "\n";
  os << indent << "ShowStatistics: " << this->ShowStatistics << "\n";
}
