// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMImageRepresentationProxy.h"

#include "vtkPVDSMNoUndo.h"

#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMArrayListDomain.h"
#include "vtkSMDoubleRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace
{
constexpr const char* Array = "DSMIsoArray";
constexpr const char* ArrayAutomatic = "DSMIsoArrayAutomatic";
constexpr const char* Isovalue = "DSMIsoValue";
constexpr const char* IsovalueAutomatic = "DSMIsoValueAutomatic";
constexpr const char* Isovalues = "DSMIsoValues";
constexpr const char* Component = "DSMIsoComponent";
constexpr const char* Range = "DSMValueRange";
constexpr const char* Show = "DSMShow";
constexpr int Isosurfaces = 0; // of DSMShow

/// Components of the array that a property selects; 0 where the data do not have it.
int CountComponents(vtkSMProperty* property)
{
  auto* const arrays = property->FindDomain<vtkSMArrayListDomain>();
  vtkPVDataInformation* const data = arrays ? arrays->GetInputDataInformation("Input") : nullptr;
  const vtkSMPropertyHelper chosen(property);
  const char* const name = chosen.GetInputArrayNameToProcess();
  vtkPVArrayInformation* const array =
    data && name ? data->GetArrayInformation(name, chosen.GetInputArrayAssociation()) : nullptr;
  return array ? array->GetNumberOfComponents() : 0;
}

/// Returns whether the data have the array that a property selects.
bool HasArray(vtkSMProperty* property)
{
  auto* const arrays = property->FindDomain<vtkSMArrayListDomain>();
  const vtkSMPropertyHelper chosen(property);
  const char* const name = chosen.GetInputArrayNameToProcess();
  for (unsigned int index = 0; name && index < arrays->GetNumberOfStrings(); ++index)
  {
    if (std::string(name) == arrays->GetString(index) &&
      arrays->GetFieldAssociation(index) == chosen.GetInputArrayAssociation())
    {
      return true;
    }
  }
  return false;
}

/// Returns whether samples lie in a plane, or on a line. Without an extent, it is inverted.
bool IsFlat(const int extent[6])
{
  return extent[0] == extent[1] || extent[2] == extent[3] || extent[4] == extent[5];
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
    if (property == self->GetProperty(Show))
    {
      self->IsShownAutomatic = true;
      return;
    }
    const bool isArray = property == self->GetProperty(Array);
    vtkSMPropertyHelper(self, isArray ? ArrayAutomatic : IsovalueAutomatic).Set(1);
    if (isArray)
    {
      self->ChooseComponent();
    }
  }
}

bool vtkSMDSMImageRepresentationProxy::CanHaveIsosurfaces()
{
  auto* const arrays = this->GetProperty(Array)->FindDomain<vtkSMArrayListDomain>();
  vtkPVDataInformation* const data = arrays ? arrays->GetInputDataInformation("Input") : nullptr;
  return data && arrays->GetNumberOfStrings() > 0 && !IsFlat(data->GetExtent());
}

bool vtkSMDSMImageRepresentationProxy::ShowsIsosurfaces()
{
  return vtkSMPropertyHelper(this, Show).GetAsInt() == Isosurfaces;
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
  const Flag loading(this->IsLoading);
  this->Superclass::LoadState(message, locator);
  this->Components = CountComponents(this->GetProperty(Array));
}

/// Their definitions have no default, so that Python states have them in any case. The default of what is shown
/// comes from the data; a state file without it shows what it did before there was a choice.
int vtkSMDSMImageRepresentationProxy::ReadXMLAttributes(
  vtkSMSessionProxyManager* manager, vtkPVXMLElement* element)
{
  const Flag loading(this->IsLoading);
  const int isRead = this->Superclass::ReadXMLAttributes(manager, element);
  for (const char* name : { ArrayAutomatic, IsovalueAutomatic })
  {
    vtkSMPropertyHelper(this, name).Set(1);
  }
  int shown = Isosurfaces;
  element->GetScalarAttribute("shown_by_old_states", &shown);
  vtkSMPropertyHelper(this, Show).Set(shown);
  return isRead;
}

void vtkSMDSMImageRepresentationProxy::SetPropertyModifiedFlag(const char* name, int flag)
{
  this->Superclass::SetPropertyModifiedFlag(name, flag);
  if (this->IsLoading)
  {
    return;
  }
  if (std::string(name) == Array && !this->IsChoosing)
  {
    vtkSMPropertyHelper(this, ArrayAutomatic).Set(0);
    this->ChooseComponent();
  }
  else if (std::string(name) == Isovalue && !this->IsChoosing)
  {
    this->IsNew = true;
    vtkSMPropertyHelper(this, IsovalueAutomatic).Set(0);
  }
  else if (std::string(name) == Show && !this->IsChoosing)
  {
    this->IsShownAutomatic = false;
  }
}

bool vtkSMDSMImageRepresentationProxy::ChooseShown()
{
  const bool isOther =
    this->IsShownAutomatic && !this->ShowsIsosurfaces() && this->CanHaveIsosurfaces();
  return isOther && this->GetProperty(Show)->ResetToDomainDefaults();
}

bool vtkSMDSMImageRepresentationProxy::ChooseComponent()
{
  const int components = CountComponents(this->GetProperty(Array));
  const bool isOther = components > 0 && components != this->Components;
  if (isOther)
  {
    this->Components = components;
    vtkSMPropertyHelper(this, Component).Set(components > 1 ? components : 0);
  }
  return isOther;
}

/// The data have been updated, and with them the domains; then the view renders. Data that come after their display
/// left it without an array.
void vtkSMDSMImageRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  vtkSMProperty* const array = this->GetProperty(Array);
  const char* const name = vtkSMPropertyHelper(array).GetInputArrayNameToProcess();
  const bool isMissing =
    !name || !*name || (vtkSMPropertyHelper(this, ArrayAutomatic).GetAsInt() && !HasArray(array));
  bool isAny = isMissing && array->ResetToDomainDefaults();
  if (isAny && this->IsIsovalueAutomatic())
  {
    this->SetIsovalueAutomatic(); // within the other range, also where nothing is traced yet
  }
  if (this->Components == 0)
  {
    this->Components = CountComponents(array); // from a state file, whose component stays
  }
  isAny = this->ChooseComponent() || isAny;
  isAny = this->ChooseShown() || isAny;
  if (isAny)
  {
    const vtkPVDSMNoUndo noUndo;
    this->UpdateVTKObjects();
  }
  this->TellRange();
}

void vtkSMDSMImageRepresentationProxy::TellRange()
{
  vtkSMProperty* const single = this->GetProperty(Isovalue);
  auto* const range = single->FindDomain<vtkSMDoubleRangeDomain>();
  int isKnown[2] = { 0, 0 };
  const double least = range->GetMinimum(0, isKnown[0]);
  const double most = range->GetMaximum(0, isKnown[1]);
  std::ostringstream text;
  if (isKnown[0] && isKnown[1])
  {
    std::vector<double> values = vtkSMPropertyHelper(this, Isovalues).GetDoubleArray();
    if (values.empty() && !this->IsIsovalueAutomatic())
    {
      values.push_back(vtkSMPropertyHelper(single).GetAsDouble());
    }
    const auto isOutside = [=](double value) { return value < least || value > most; };
    const auto outside = std::count_if(values.begin(), values.end(), isOutside);
    text << least << " to " << most;
    // A narrow panel shows the end.
    if (outside > 0 && values.size() == 1)
    {
      text << ": isovalue outside";
    }
    else if (outside > 0)
    {
      text << ": " << outside << " of " << values.size() << " isovalues outside";
    }
  }
  vtkSMPropertyHelper(this, Range).Set(text.str().c_str());
}
