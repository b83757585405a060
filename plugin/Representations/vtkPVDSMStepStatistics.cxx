// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMStepStatistics.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkProcessModule.h"
#include "vtkSMInputProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
#include "vtkSmartPointer.h"
#include "vtkVersionMacros.h"

#include <cstring>

namespace
{

bool Is(vtkSMProxy* proxy, const char* name)
{
  return proxy->GetXMLName() != nullptr && std::strcmp(proxy->GetXMLName(), name) == 0;
}

/// Of all readers of volumes that a filter's input comes from.
void KeepInMemory(vtkSMProxy* filter)
{
  const auto properties =
    vtkSmartPointer<vtkSMPropertyIterator>::Take(filter->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    auto* const input = vtkSMInputProperty::SafeDownCast(properties->GetProperty());
    for (unsigned int number = 0; input && number < input->GetNumberOfProxies(); ++number)
    {
      vtkSMProxy* const source = input->GetProxy(number);
      if (source && Is(source, "DSMVolumeReader"))
      {
        vtkSMPropertyHelper(source, "ValuesInMemory").Set(1);
        source->UpdateProperty("ValuesInMemory");
      }
      else if (source)
      {
        KeepInMemory(source);
      }
    }
  }
}

void OnRegister(vtkObject*, unsigned long, void*, void* registered)
{
  const auto* what = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(registered);
  if (what->Proxy && Is(what->Proxy, "TemporalStatistics"))
  {
    KeepInMemory(what->Proxy);
  }
}

} // namespace

void vtkPVDSMStepStatistics::Load()
{
  constexpr bool isNeeded = VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION < 4;
  static bool isLoaded = !isNeeded;
  const auto type = vtkProcessModule::GetProcessType();
  const bool hasProxies =
    type == vtkProcessModule::PROCESS_CLIENT || type == vtkProcessModule::PROCESS_BATCH;
  if (hasProxies && !isLoaded)
  {
    isLoaded = true;
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(OnRegister);
    vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, command);
  }
}
