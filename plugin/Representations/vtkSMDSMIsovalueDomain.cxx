// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMIsovalueDomain.h"

#include "vtkObjectFactory.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <cmath>

vtkStandardNewMacro(vtkSMDSMIsovalueDomain);

vtkSMDSMIsovalueDomain::vtkSMDSMIsovalueDomain() = default;
vtkSMDSMIsovalueDomain::~vtkSMDSMIsovalueDomain() = default;

int vtkSMDSMIsovalueDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  vtkSMProxy* const representation = property->GetParent();
  vtkSMProperty* const suggestion =
    representation ? representation->GetProperty("DSMSuggestedIsoValue") : nullptr;
  if (suggestion)
  {
    suggestion->GetParent()->UpdatePropertyInformation(suggestion);
    const double value = vtkSMPropertyHelper(suggestion).GetAsDouble();
    // It may still be that of an array that was shown before.
    int isKnown[2] = { 0, 0 };
    const bool isInside = value >= this->GetMinimum(0, isKnown[0]) &&
      value <= this->GetMaximum(0, isKnown[1]) && isKnown[0] && isKnown[1];
    if (std::isfinite(value) && isInside)
    {
      vtkSMPropertyHelper helper(property);
      helper.SetUseUnchecked(useUncheckedValues);
      helper.Set(&value, 1);
      return 1;
    }
  }
  return this->Superclass::SetDefaultValues(property, useUncheckedValues);
}
