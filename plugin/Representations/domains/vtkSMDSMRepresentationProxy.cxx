// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMRepresentationProxy.h"

#include "vtkPVDSMNoUndo.h"

#include "vtkObjectFactory.h"
#include "vtkSMDomain.h"
#include "vtkSMDomainIterator.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMVectorProperty.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace
{

constexpr const char* Box = "DSMCroppingBox";
constexpr const char* Movements[] = { "DSMCroppingPosition", "DSMCroppingRotation",
  "DSMCroppingScale" };
constexpr const char* Places[] = { "DSMClipOrigin", Box, "DSMSliceOrigin" };

/// The default that the data give; empty if they give none.
std::vector<double> FindDefault(vtkSMVectorProperty* property)
{
  const auto other = vtkSmartPointer<vtkSMVectorProperty>::Take(property->NewInstance());
  other->SetNumberOfElements(property->GetNumberOfElements());
  const auto domain = vtkSmartPointer<vtkSMDomainIterator>::Take(property->NewDomainIterator());
  for (domain->Begin(); !domain->IsAtEnd(); domain->Next())
  {
    if (domain->GetDomain()->SetDefaultValues(other, false))
    {
      return vtkSMPropertyHelper(other).GetDoubleArray();
    }
  }
  return {};
}

/// Returns whether a display that was made before its data has this: a box that is inverted or, since ParaView 6,
/// without extent.
bool IsOfNothing(const std::vector<double>& values)
{
  const auto isFlat = [&](std::size_t axis) { return !(values[2 * axis] < values[2 * axis + 1]); };
  return values.size() == 6 && isFlat(0) && isFlat(1) && isFlat(2);
}

} // namespace

vtkStandardNewMacro(vtkSMDSMRepresentationProxy);

vtkSMDSMRepresentationProxy::vtkSMDSMRepresentationProxy() = default;
vtkSMDSMRepresentationProxy::~vtkSMDSMRepresentationProxy() = default;

void vtkSMDSMRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  this->FollowData();
}

void vtkSMDSMRepresentationProxy::FollowData()
{
  const vtkPVDSMNoUndo noUndo;
  bool isAny = false;
  for (const char* name : Places)
  {
    isAny = this->Follow(name) || isAny;
  }
  if (isAny)
  {
    this->GetTrueParentProxy()->UpdateVTKObjects(); // with the other ways to show the data
  }
}

bool vtkSMDSMRepresentationProxy::Follow(const std::string& name)
{
  auto* const property = vtkSMVectorProperty::SafeDownCast(this->GetProperty(name.c_str()));
  std::vector<double> given = property ? FindDefault(property) : std::vector<double>();
  const bool isMoved = name == Box &&
    std::any_of(std::begin(Movements), std::end(Movements),
      [this](const char* movement) { return !this->GetProperty(movement)->IsValueDefault(); });
  if (given.empty() || isMoved)
  {
    return false;
  }
  const std::vector<double> values = vtkSMPropertyHelper(property).GetDoubleArray();
  const std::vector<double> before = std::exchange(this->Defaults[name], given);
  const bool isUntouched = before.empty() ? IsOfNothing(values) : values == before;
  return isUntouched && values != given && property->ResetToDomainDefaults();
}
