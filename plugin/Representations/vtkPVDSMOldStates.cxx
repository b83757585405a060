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

#include <string>

namespace
{

bool HasProperty(vtkPVXMLElement* proxy, const std::string& name)
{
  for (unsigned int number = 0; number < proxy->GetNumberOfNestedElements(); ++number)
  {
    vtkPVXMLElement* property = proxy->GetNestedElement(number);
    if (property->GetAttributeOrEmpty("name") == name)
    {
      return true;
    }
  }
  return false;
}

void SetPlainLook(vtkPVXMLElement* element, vtkSMProxyLocator* locator)
{
  int id = 0;
  if (HasProperty(element, "DSMShadows") && !HasProperty(element, "DSMLook") &&
    element->GetScalarAttribute("id", &id))
  {
    if (vtkSMProxy* proxy = locator->LocateProxy(id))
    {
      vtkSMPropertyHelper(proxy, "DSMLook").Set(vtkDSMLightOptions::PlainLook);
      proxy->UpdateVTKObjects();
    }
  }
  for (unsigned int number = 0; number < element->GetNumberOfNestedElements(); ++number)
  {
    SetPlainLook(element->GetNestedElement(number), locator);
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
          SetPlainLook(state->RootElement, state->ProxyLocator);
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
