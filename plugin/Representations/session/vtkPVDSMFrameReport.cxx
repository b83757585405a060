// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMFrameReport.h"

#include "vtkDSMScene.h"
#include "vtkDSMStatistics.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkMath.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMFrameReport);

vtkPVDSMFrameReport::vtkPVDSMFrameReport() = default;
vtkPVDSMFrameReport::~vtkPVDSMFrameReport() = default;

void vtkPVDSMFrameReport::SetSource(vtkDSMScene* source)
{
  this->Source = source;
}

void vtkPVDSMFrameReport::SetVolume(vtkDSMVolumeMapper* volume)
{
  this->Volume = volume;
}

double vtkPVDSMFrameReport::GetSuggestedIsoValue()
{
  return this->Volume ? this->Volume->GetSuggestedIsoValue() : vtkMath::Nan();
}

double vtkPVDSMFrameReport::GetFrameTime()
{
  return this->Source ? this->Source->GetStatistics()->GetFrameSeconds() : 0.0;
}

const char* vtkPVDSMFrameReport::GetStatistics()
{
  this->Text = this->Source ? this->Source->GetStatistics()->GetJson() : "[]";
  return this->Text.c_str();
}

const char* vtkPVDSMFrameReport::GetSummary()
{
  this->Text = this->Source ? this->Source->GetStatistics()->GetSummary() : std::string();
  return this->Text.c_str();
}

int* vtkPVDSMFrameReport::GetSamples()
{
  this->Samples[0] = this->Source ? this->Source->GetNumberOfSamples() : 0;
  this->Samples[1] = this->Source ? this->Source->GetNumberOfSamplesWanted() : 0;
  return this->Samples;
}

void vtkPVDSMFrameReport::SetProgressive(bool progressive)
{
  this->Progressive = progressive;
}

bool vtkPVDSMFrameReport::GetProgressive()
{
  return this->Progressive;
}

void vtkPVDSMFrameReport::SetInteracting(bool interacting)
{
  this->Interacting = interacting;
}

bool vtkPVDSMFrameReport::GetInteracting()
{
  return this->Interacting;
}

void vtkPVDSMFrameReport::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SuggestedIsoValue: " << this->GetSuggestedIsoValue() << "\n";
  os << indent << "FrameTime: " << this->GetFrameTime() << "\n";
  os << indent << "Statistics: " << this->GetStatistics() << "\n";
}
