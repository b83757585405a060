// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneMember.h"

#include "vtkAlgorithm.h"
#include "vtkObject.h"

#include <algorithm>

void vtkDSMSceneMember::ReportMessages()
{
  for (const std::string& message : this->Messages)
  {
    if (std::find(this->Reported.begin(), this->Reported.end(), message) == this->Reported.end())
    {
      vtkErrorWithObjectMacro(this->GetAlgorithm(), << message);
    }
  }
  this->Reported = this->Messages;
}
