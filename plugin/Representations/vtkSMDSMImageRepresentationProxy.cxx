// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMImageRepresentationProxy.h"

#include "vtkPVDSMNoUndo.h"

#include "vtkObjectFactory.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMStringListDomain.h"

#include <string>

namespace
{
constexpr const char* Array = "DSMIsoArray";
constexpr const char* ArrayAutomatic = "DSMIsoArrayAutomatic";
constexpr const char* Isovalue = "DSMIsoValue";
constexpr const char* IsovalueAutomatic = "DSMIsoValueAutomatic";
constexpr const char* Box = "DSMCroppingBox";

/// Whether a box is as large as data that are not there: upside down, or, since ParaView 6, of no extent.
bool IsOfNothing(const vtkSMPropertyHelper& bounds)
{
  const auto isFlat = [&](unsigned int axis)
  { return !(bounds.GetAsDouble(2 * axis) < bounds.GetAsDouble(2 * axis + 1)); };
  return isFlat(0) && isFlat(1) && isFlat(2);
}

/// While it lives, a value is true.
class Flag
{
public:
  explicit Flag(bool& value)
    : Value(value)
    , Before(value)
  {
    value = true;
  }
  ~Flag() { this->Value = this->Before; }
  Flag(const Flag&) = delete;
  Flag& operator=(const Flag&) = delete;

private:
  bool& Value;
  bool Before;
};

} // namespace

vtkStandardNewMacro(vtkSMDSMImageRepresentationProxy);

vtkSMDSMImageRepresentationProxy::vtkSMDSMImageRepresentationProxy() = default;
vtkSMDSMImageRepresentationProxy::~vtkSMDSMImageRepresentationProxy() = default;

void vtkSMDSMImageRepresentationProxy::SetAutomatic(
  vtkSMProperty* property, const std::function<void()>& choose)
{
  if (auto* self = vtkSMDSMImageRepresentationProxy::SafeDownCast(property->GetParent()))
  {
    const Flag choosing(self->IsChoosing);
    choose();
    const bool isArray = property == self->GetProperty(Array);
    vtkSMPropertyHelper(self, isArray ? ArrayAutomatic : IsovalueAutomatic).Set(1);
  }
}

bool vtkSMDSMImageRepresentationProxy::IsIsovalueAutomatic()
{
  return vtkSMPropertyHelper(this, IsovalueAutomatic).GetAsInt() != 0;
}

void vtkSMDSMImageRepresentationProxy::SetIsovalueAutomatic()
{
  this->GetProperty(Isovalue)->ResetToDomainDefaults();
  vtkSMPropertyHelper(this, IsovalueAutomatic).Set(1);
}

void vtkSMDSMImageRepresentationProxy::SetAutomaticIsovalue(double value)
{
  const vtkPVDSMNoUndo noUndo;
  const Flag choosing(this->IsChoosing);
  vtkSMPropertyHelper(this, Isovalue).Set(value);
  this->UpdateVTKObjects();
}

void vtkSMDSMImageRepresentationProxy::LoadState(
  const vtkSMMessage* message, vtkSMProxyLocator* locator)
{
  const Flag choosing(this->IsChoosing);
  this->Superclass::LoadState(message, locator);
}

/// Their definitions have no default, so that Python states have them in any case.
int vtkSMDSMImageRepresentationProxy::ReadXMLAttributes(
  vtkSMSessionProxyManager* manager, vtkPVXMLElement* element)
{
  const Flag choosing(this->IsChoosing);
  const int isRead = this->Superclass::ReadXMLAttributes(manager, element);
  for (const char* name : { ArrayAutomatic, IsovalueAutomatic })
  {
    vtkSMPropertyHelper(this, name).Set(1);
  }
  return isRead;
}

void vtkSMDSMImageRepresentationProxy::SetPropertyModifiedFlag(const char* name, int flag)
{
  this->Superclass::SetPropertyModifiedFlag(name, flag);
  if (this->IsChoosing)
  {
    return;
  }
  if (std::string(name) == Array)
  {
    vtkSMPropertyHelper(this, ArrayAutomatic).Set(0);
  }
  else if (std::string(name) == Isovalue)
  {
    this->IsNew = true;
    vtkSMPropertyHelper(this, IsovalueAutomatic).Set(0);
  }
}

/// The data have been updated, and with them the domains; then the view renders. Data that come after their display left
/// it without an array and without a box to crop to.
void vtkSMDSMImageRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  vtkSMProperty* const array = this->GetProperty(Array);
  const char* const name = vtkSMPropertyHelper(array).GetInputArrayNameToProcess();
  auto* const arrays = array->FindDomain<vtkSMStringListDomain>();
  unsigned int index = 0;
  const bool isMissing = !name || !*name ||
    (vtkSMPropertyHelper(this, ArrayAutomatic).GetAsInt() && !arrays->IsInDomain(name, index));
  bool isAny = isMissing && array->ResetToDomainDefaults();
  vtkSMProperty* const box = this->GetProperty(Box);
  isAny = (IsOfNothing(vtkSMPropertyHelper(box)) && box->ResetToDomainDefaults()) || isAny;
  if (isAny)
  {
    const vtkPVDSMNoUndo noUndo;
    this->UpdateVTKObjects();
  }
}
