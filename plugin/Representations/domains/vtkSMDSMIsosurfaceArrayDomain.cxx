// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMIsosurfaceArrayDomain.h"

#include "vtkSMDSMImageRepresentationProxy.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMVectorProperty.h"

#include <string>

namespace
{
/// Index of the association in the selection of an array; the array's name follows.
constexpr unsigned int Association = 3;
}

vtkStandardNewMacro(vtkSMDSMIsosurfaceArrayDomain);

vtkSMDSMIsosurfaceArrayDomain::vtkSMDSMIsosurfaceArrayDomain() = default;
vtkSMDSMIsosurfaceArrayDomain::~vtkSMDSMIsosurfaceArrayDomain() = default;

int vtkSMDSMIsosurfaceArrayDomain::SetDefaultValues(
  vtkSMProperty* property, bool useUncheckedValues)
{
  if (useUncheckedValues)
  {
    return this->SetDefault(property, true);
  }
  int isSet = 0;
  vtkSMDSMImageRepresentationProxy::SetAutomatic(property,
    [&]
    {
      isSet = this->SetDefault(property, false);
      // ParaView does not tell when a property is set to what it is, but a script may choose this array, with its
      // association or by its name alone. It does tell after a change of the number of elements.
      auto* const elements = vtkSMVectorProperty::SafeDownCast(property);
      const unsigned int count = elements->GetNumberOfElements();
      elements->SetNumberOfElements(count + 1);
      elements->SetNumberOfElements(count);
    });
  return isSet;
}

bool vtkSMDSMIsosurfaceArrayDomain::IsFilteredArray(
  vtkPVDataInformation* data, int association, const char* arrayName)
{
  return association == vtkDataObject::FIELD ||
    this->Superclass::IsFilteredArray(data, association, arrayName);
}

int vtkSMDSMIsosurfaceArrayDomain::SetDefault(vtkSMProperty* property, bool useUncheckedValues)
{
  const int isSet = this->Superclass::SetDefaultValues(property, useUncheckedValues);
  vtkPVDataInformation* const data = this->GetInputDataInformation("Input");
  vtkSMPropertyHelper chosen(property);
  chosen.SetUseUnchecked(useUncheckedValues);
  if (!data || chosen.GetNumberOfElements() <= Association + 1)
  {
    return isSet;
  }
  const auto isFlagOrId = [this, data](unsigned int number)
  {
    const std::string name = this->GetString(number);
    vtkPVDataSetAttributesInformation* const attributes =
      data->GetAttributeInformation(this->GetFieldAssociation(number));
    const auto is = [&](int kind)
    {
      vtkPVArrayInformation* const array =
        attributes ? attributes->GetAttributeInformation(kind) : nullptr;
      return array && array->GetName() && name == array->GetName();
    };
    return name == vtkDataSetAttributes::GhostArrayName() || is(vtkDataSetAttributes::GLOBALIDS) ||
      is(vtkDataSetAttributes::PEDIGREEIDS);
  };
  unsigned int first = 0;
  while (first < this->GetNumberOfStrings() && isFlagOrId(first))
  {
    ++first;
  }
  if (first == this->GetNumberOfStrings())
  {
    return isSet;
  }
  // Arrays of points come first.
  const int association = this->GetFieldAssociation(first);
  const std::string name = chosen.GetAsString(Association + 1);
  vtkPVDataSetAttributesInformation* const attributes = data->GetAttributeInformation(association);
  vtkPVArrayInformation* const scalars =
    attributes ? attributes->GetAttributeInformation(vtkDataSetAttributes::SCALARS) : nullptr;
  if (scalars && scalars->GetName() && name == scalars->GetName() &&
    chosen.GetAsInt(Association) == association)
  {
    return isSet;
  }
  for (unsigned int number = first;
       number < this->GetNumberOfStrings() && this->GetFieldAssociation(number) == association;
       ++number)
  {
    vtkPVArrayInformation* const array =
      data->GetArrayInformation(this->GetString(number), association);
    if (array && array->GetNumberOfComponents() == 1 && !isFlagOrId(number))
    {
      chosen.Set(Association, association);
      chosen.Set(Association + 1, this->GetString(number));
      return 1;
    }
  }
  chosen.Set(Association, association);
  chosen.Set(Association + 1, this->GetString(first));
  return 1;
}
