// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMFrameReport.h"

#include "vtkDSMStatistics.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMFrameReport);

vtkPVDSMFrameReport::vtkPVDSMFrameReport() = default;
vtkPVDSMFrameReport::~vtkPVDSMFrameReport() = default;

void vtkPVDSMFrameReport::SetSource(vtkDSMStatistics* source)
{
  this->Source = source;
}

double vtkPVDSMFrameReport::GetFrameTime()
{
  return this->Source ? this->Source->GetFrameSeconds() : 0.0;
}

const char* vtkPVDSMFrameReport::GetStatistics()
{
  this->Text = this->Source ? this->Source->GetJson() : "[]";
  return this->Text.c_str();
}

const char* vtkPVDSMFrameReport::GetSummary()
{
  this->Text = this->Source ? this->Source->GetSummary() : std::string();
  return this->Text.c_str();
}

void vtkPVDSMFrameReport::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FrameTime: " << this->GetFrameTime() << "\n";
  os << indent << "Statistics: " << this->GetStatistics() << "\n";
}
