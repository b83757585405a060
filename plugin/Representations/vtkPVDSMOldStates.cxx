// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMOldStates.h"

#include "vtkDSMLightOptions.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyLocator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSmartPointer.h"

#include <optional>
#include <string>

namespace
{

/// Null where the state of a proxy does not have it.
vtkPVXMLElement* FindProperty(vtkPVXMLElement* proxy, const std::string& name)
{
  for (unsigned int number = 0; number < proxy->GetNumberOfNestedElements(); ++number)
  {
    vtkPVXMLElement* property = proxy->GetNestedElement(number);
    if (property->GetAttributeOrEmpty("name") == name)
    {
      return property;
    }
  }
  return nullptr;
}

/// The value of a property that has one number; nothing where the state of a proxy does not have it.
std::optional<double> FindNumber(vtkPVXMLElement* proxy, const std::string& name)
{
  vtkPVXMLElement* const property = FindProperty(proxy, name);
  vtkPVXMLElement* const element =
    property ? property->FindNestedElementByName("Element") : nullptr;
  double number = 0.0;
  return element && element->GetScalarAttribute("value", &number) ? std::optional(number)
                                                                  : std::nullopt;
}

/// Before there was a property for it, an isovalue was automatic as long as it had the number of a hidden one.
bool HasOldAutomaticIsovalue(vtkPVXMLElement* proxy)
{
  const std::optional<double> isovalue = FindNumber(proxy, "DSMIsoValue");
  return isovalue && isovalue == FindNumber(proxy, "DSMUnchosenIsoValue");
}

void Complete(vtkPVXMLElement* element, vtkSMProxyLocator* locator)
{
  int id = 0;
  const bool isDisplay =
    FindProperty(element, "DSMShadows") && element->GetScalarAttribute("id", &id);
  if (vtkSMProxy* const proxy = isDisplay ? locator->LocateProxy(id) : nullptr)
  {
    if (!FindProperty(element, "DSMLook"))
    {
      vtkSMPropertyHelper(proxy, "DSMLook").Set(vtkDSMLightOptions::PlainLook);
    }
    if (HasOldAutomaticIsovalue(element))
    {
      vtkSMPropertyHelper(proxy, "DSMIsoValueAutomatic").Set(1);
    }
    proxy->UpdateVTKObjects();
  }
  for (unsigned int number = 0; number < element->GetNumberOfNestedElements(); ++number)
  {
    Complete(element->GetNestedElement(number), locator);
  }
}

/// One for all managers, so that each can tell whether it has it.
vtkCommand* GetObserver()
{
  static const auto observer = []
  {
    vtkNew<vtkCallbackCommand> made;
    made->SetCallback(
      [](vtkObject*, unsigned long, void*, void* loaded)
      {
        const auto* state = static_cast<vtkSMProxyManager::LoadStateInformation*>(loaded);
        if (state && state->RootElement && state->ProxyLocator)
        {
          Complete(state->RootElement, state->ProxyLocator);
        }
      });
    return vtkSmartPointer<vtkCommand>(made);
  }();
  return observer;
}

} // namespace

void vtkPVDSMOldStates::Watch(vtkSMSessionProxyManager* manager)
{
  if (!manager->HasObserver(vtkCommand::LoadStateEvent, GetObserver()))
  {
    manager->AddObserver(vtkCommand::LoadStateEvent, GetObserver());
  }
}
