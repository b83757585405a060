// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMWrittenProperties.h"

#include "vtkPVDSMHints.h"

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

void Mark(vtkSMProperty* property, bool isUnused)
{
  vtkPVXMLElement* const mark = FindMark(property->GetHints());
  if ((mark != nullptr) != isUnused)
  {
    vtkPVDSMHints::Change(property, isUnused ? MakeMark().Get() : nullptr, mark);
  }
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
