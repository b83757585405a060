// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMSliceIndexDomain.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

vtkStandardNewMacro(vtkSMDSMSliceIndexDomain);

vtkSMDSMSliceIndexDomain::vtkSMDSMSliceIndexDomain() = default;
vtkSMDSMSliceIndexDomain::~vtkSMDSMSliceIndexDomain() = default;

int vtkSMDSMSliceIndexDomain::ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element)
{
  return this->Superclass::ReadXMLAttributes(property, element) &&
    element->GetScalarAttribute("axis", &this->Axis) && this->Axis >= 0 && this->Axis < 3;
}

void vtkSMDSMSliceIndexDomain::Update(vtkSMProperty*)
{
  vtkPVDataInformation* const data = this->GetInputDataInformation("Input");
  const bool isImage = data && !data->IsCompositeDataSet() &&
    !data->GetArrayInformation(
      vtkDataSetAttributes::GhostArrayName(), vtkDataObject::FIELD_ASSOCIATION_CELLS);
  const int* const extent = isImage ? data->GetExtent() : nullptr;
  std::vector<vtkEntry> entries;
  if (extent && extent[2 * this->Axis] <= extent[2 * this->Axis + 1])
  {
    entries.push_back(vtkEntry(0, extent[2 * this->Axis + 1] - extent[2 * this->Axis]));
  }
  this->SetEntries(entries);
}

int vtkSMDSMSliceIndexDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  if (!this->GetMaximumExists(0) || property->GetRepeatable())
  {
    return 0;
  }
  vtkSMPropertyHelper helper(property);
  helper.SetUseUnchecked(useUncheckedValues);
  helper.Set(this->GetMaximum(0) / 2);
  this->Default = useUncheckedValues ? this->Default : this->GetMaximum(0) / 2;
  return 1;
}

void vtkSMDSMSliceIndexDomain::SetNumberOfSamples(int count)
{
  this->SetEntries({ vtkEntry(0, count - 1) });
}

bool vtkSMDSMSliceIndexDomain::IsAutomatic()
{
  const int index = vtkSMPropertyHelper(this->GetProperty()).GetAsInt();
  return index < 0 || index == this->Default;
}
