// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMHints.h"

#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSmartPointer.h"

namespace
{

/// ParaView takes a property with other hints for one with another value.
struct Quiet final : vtkSMProperty
{
  static void SetHints(vtkSMProperty& property, vtkPVXMLElement* hints)
  {
    (property.*(&Quiet::SetBlockModifiedEvents))(true);
    property.SetHints(hints);
    (property.*(&Quiet::SetBlockModifiedEvents))(false);
  }
};

} // namespace

void vtkPVDSMHints::Change(
  vtkSMProperty* property, vtkPVXMLElement* added, vtkPVXMLElement* removed)
{
  const auto hints = vtkSmartPointer<vtkPVXMLElement>::New();
  hints->SetName("Hints");
  if (added)
  {
    hints->AddNestedElement(added);
  }
  vtkPVXMLElement* const before = property->GetHints();
  for (unsigned int number = 0; before && number < before->GetNumberOfNestedElements(); ++number)
  {
    if (before->GetNestedElement(number) != removed)
    {
      hints->AddNestedElement(before->GetNestedElement(number), 0);
    }
  }
  Quiet::SetHints(*property, hints);
}
