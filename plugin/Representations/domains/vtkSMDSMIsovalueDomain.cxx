// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMIsovalueDomain.h"

#include "vtkSMDSMImageRepresentationProxy.h"

#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPVVersion.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <cmath>

namespace
{
/// Initial position of a single isovalue, as a fraction of the range: a user could enter an even
/// fraction.
constexpr double Beginning = 0.5 + 0.01 / 3.14159265358979;

#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(6, 0, 0)
/// A slider of ParaView 6 divides by the distance from a new least value to 1 before it knows the largest one. Where Qt
/// checks that the quotient is an integer, as Debian's does, the application ends. Such arrays are common: the lengths
/// of normals are 1.
constexpr double SafeDistance = 1e-3;
#endif
}

vtkStandardNewMacro(vtkSMDSMIsovalueDomain);

vtkSMDSMIsovalueDomain::vtkSMDSMIsovalueDomain()
  : Suggested{ vtkMath::Nan(), vtkMath::Nan() }
{
}

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

void vtkSMDSMIsovalueDomain::Update(vtkSMProperty* property)
{
  this->Superclass::Update(property);
  if (property && property == this->GetRequiredProperty("ArraySelection"))
  {
    // The next render suggests a range of the other array.
    this->Suggested[0] = this->Suggested[1] = vtkMath::Nan();
  }
  int isKnown[2] = { 0, 0 };
  const double least = this->GetMinimum(0, isKnown[0]);
  const double most = this->GetMaximum(0, isKnown[1]);
  if (isKnown[0] && isKnown[1] && this->Suggested[0] >= least && this->Suggested[1] <= most)
  {
    this->SetEntries({ vtkEntry(this->Suggested[0], this->Suggested[1]) });
  }
#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(6, 0, 0)
  const double first = this->GetMinimum(0, isKnown[0]);
  const double last = this->GetMaximum(0, isKnown[1]);
  if (isKnown[0] && isKnown[1] && std::abs(first - 1.0) < SafeDistance)
  {
    this->SetEntries({ vtkEntry(1.0 - SafeDistance, last) });
  }
#endif
}

void vtkSMDSMIsovalueDomain::TakeSuggestedRange()
{
  vtkSMProxy* const representation = this->GetProperty()->GetParent();
  vtkSMProperty* const suggestion =
    representation ? representation->GetProperty("DSMSuggestedRange") : nullptr;
  if (!suggestion)
  {
    return;
  }
  suggestion->GetParent()->UpdatePropertyInformation(suggestion);
  const vtkSMPropertyHelper range(suggestion);
  const auto isOther = [](double one, double other)
  { return one != other && !(std::isnan(one) && std::isnan(other)); };
  if (isOther(range.GetAsDouble(0), this->Suggested[0]) ||
    isOther(range.GetAsDouble(1), this->Suggested[1]))
  {
    this->Suggested[0] = range.GetAsDouble(0);
    this->Suggested[1] = range.GetAsDouble(1);
    this->Update(nullptr);
  }
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
