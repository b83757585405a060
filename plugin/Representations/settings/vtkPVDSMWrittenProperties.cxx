// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMWrittenProperties.h"

#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSmartPointer.h"

#include <string>

namespace
{

constexpr const char* Link = "PropertyLink";
constexpr const char* Unused = "DSMUnused";

/// ParaView's Python leaves out what a hint links to settings. It reads the first such hint.
vtkSmartPointer<vtkPVXMLElement> MakeMark()
{
  auto mark = vtkSmartPointer<vtkPVXMLElement>::New();
  mark->SetName(Link);
  mark->AddAttribute("group", "settings");
  mark->AddAttribute("proxy", Unused);
  return mark;
}

/// Null without one.
vtkPVXMLElement* FindMark(vtkPVXMLElement* hints)
{
  vtkPVXMLElement* const link = hints ? hints->FindNestedElementByName(Link) : nullptr;
  return link && link->GetAttributeOrEmpty("proxy") == std::string(Unused) ? link : nullptr;
}

/// Hints are no values, but ParaView takes a property with other hints for one with another value.
struct Quiet final : vtkSMProperty
{
  static void SetHints(vtkSMProperty& property, vtkPVXMLElement* hints)
  {
    (property.*(&Quiet::SetBlockModifiedEvents))(true);
    property.SetHints(hints);
    (property.*(&Quiet::SetBlockModifiedEvents))(false);
  }
};

/// The hints in a definition are those of all displays, so a display gets hints of its own.
void Mark(vtkSMProperty* property, bool isUnused)
{
  vtkPVXMLElement* const before = property->GetHints();
  vtkPVXMLElement* const mark = FindMark(before);
  if ((mark != nullptr) == isUnused)
  {
    return;
  }
  const auto hints = vtkSmartPointer<vtkPVXMLElement>::New();
  hints->SetName("Hints");
  if (isUnused)
  {
    hints->AddNestedElement(MakeMark());
  }
  for (unsigned int number = 0; before && number < before->GetNumberOfNestedElements(); ++number)
  {
    if (before->GetNestedElement(number) != mark)
    {
      hints->AddNestedElement(before->GetNestedElement(number), 0);
    }
  }
  Quiet::SetHints(*property, hints);
}

} // namespace

void vtkPVDSMWrittenProperties::Choose(vtkSMProxy* display)
{
  vtkSMProperty* const shown = display->GetProperty("Representation");
  if (!shown)
  {
    return;
  }
  const auto isOurs = [](const std::string& name) { return name.rfind("DSM", 0) == 0; };
  const bool isTraced = isOurs(vtkSMPropertyHelper(shown).GetAsString());
  vtkSmartPointer<vtkSMPropertyIterator> property;
  property.TakeReference(display->NewPropertyIterator());
  for (property->Begin(); !property->IsAtEnd(); property->Next())
  {
    if (isOurs(property->GetProperty()->GetParent()->GetXMLName()))
    {
      Mark(property->GetProperty(), !isTraced);
    }
  }
}
