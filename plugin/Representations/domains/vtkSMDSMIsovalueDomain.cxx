// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMIsovalueDomain.h"

#include "vtkSMDSMImageRepresentationProxy.h"

#include "vtkObjectFactory.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <cmath>

namespace
{
/// Initial position of a single isovalue, as a fraction of the range: a user could enter an even
/// fraction.
constexpr double Beginning = 0.5 + 0.01 / 3.14159265358979;
}

vtkStandardNewMacro(vtkSMDSMIsovalueDomain);

vtkSMDSMIsovalueDomain::vtkSMDSMIsovalueDomain() = default;
vtkSMDSMIsovalueDomain::~vtkSMDSMIsovalueDomain() = default;

int vtkSMDSMIsovalueDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  if (!useUncheckedValues && !property->GetRepeatable())
  {
    return this->SetSingle(property);
  }
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

int vtkSMDSMIsovalueDomain::SetSingle(vtkSMProperty* property)
{
  int isKnown[2] = { 0, 0 };
  const double least = this->GetMinimum(0, isKnown[0]);
  const double most = this->GetMaximum(0, isKnown[1]);
  const double value = (1.0 - Beginning) * least + Beginning * most;
  if (!isKnown[0] || !isKnown[1] || least > most || !std::isfinite(value))
  {
    return 0;
  }
  vtkSMDSMImageRepresentationProxy::SetAutomatic(
    property, [&] { vtkSMPropertyHelper(property).Set(least < most ? value : least); });
  return 1;
}
