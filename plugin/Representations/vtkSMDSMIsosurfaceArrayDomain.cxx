// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMIsosurfaceArrayDomain.h"

#include "vtkDataSetAttributes.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <string>

vtkStandardNewMacro(vtkSMDSMIsosurfaceArrayDomain);

vtkSMDSMIsosurfaceArrayDomain::vtkSMDSMIsosurfaceArrayDomain() = default;
vtkSMDSMIsosurfaceArrayDomain::~vtkSMDSMIsosurfaceArrayDomain() = default;

int vtkSMDSMIsosurfaceArrayDomain::SetDefaultValues(
  vtkSMProperty* property, bool useUncheckedValues)
{
  // Where the selection of an array has it, and its name behind it.
  constexpr unsigned int association = 3;
  const int isSet = this->Superclass::SetDefaultValues(property, useUncheckedValues);
  vtkPVDataInformation* const data = this->GetInputDataInformation("Input");
  vtkSMPropertyHelper chosen(property);
  chosen.SetUseUnchecked(useUncheckedValues);
  if (!data || chosen.GetNumberOfElements() <= association + 1)
  {
    return isSet;
  }
  const std::string name = chosen.GetAsString(association + 1);
  vtkPVDataSetAttributesInformation* const points =
    data->GetAttributeInformation(vtkDataObject::POINT);
  vtkPVArrayInformation* const scalars =
    points ? points->GetAttributeInformation(vtkDataSetAttributes::SCALARS) : nullptr;
  if (scalars && scalars->GetName() && name == scalars->GetName())
  {
    return isSet;
  }
  for (unsigned int number = 0; number < this->GetNumberOfStrings(); ++number)
  {
    vtkPVArrayInformation* const array =
      data->GetArrayInformation(this->GetString(number), this->GetFieldAssociation(number));
    if (array && array->GetNumberOfComponents() == 1)
    {
      chosen.Set(association, this->GetFieldAssociation(number));
      chosen.Set(association + 1, this->GetString(number));
      return 1;
    }
  }
  return isSet;
}
