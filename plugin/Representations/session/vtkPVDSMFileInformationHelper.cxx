// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMFileInformationHelper.h"

#include "vtkDSMVolumeReader.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMFileInformationHelper);

bool vtkPVDSMFileInformationHelper::GetActiveFileIsReadable()
{
  return vtkDSMVolumeReader::IsAddress(this->GetPath()) ||
    this->Superclass::GetActiveFileIsReadable();
}
