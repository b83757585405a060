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
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSmartPointer.h"
#include "vtkVersionMacros.h"

#include <cstring>
#include <set>

namespace
{

bool Is(vtkSMProxy* proxy, const char* name)
{
  return proxy && proxy->GetXMLName() && std::strcmp(proxy->GetXMLName(), name) == 0;
}

/// Adds all readers of volumes that a filter's input comes from.
void FindReaders(vtkSMProxy* filter, std::set<vtkSMProxy*>& found)
{
  const auto properties =
    vtkSmartPointer<vtkSMPropertyIterator>::Take(filter->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    auto* const input = vtkSMInputProperty::SafeDownCast(properties->GetProperty());
    for (unsigned int number = 0; input && number < input->GetNumberOfProxies(); ++number)
    {
      vtkSMProxy* const source = input->GetProxy(number);
      if (Is(source, "DSMVolumeReader"))
      {
        found.insert(source);
      }
      else if (source)
      {
        FindReaders(source, found);
      }
    }
  }
}

bool IsStatistics(vtkSMProxy* proxy)
{
  return Is(proxy, "TemporalStatistics");
}

/// Those that come before any of the session's filters.
std::set<vtkSMProxy*> FindReadersOfAll(vtkSMProxy* filter)
{
  std::set<vtkSMProxy*> found;
  vtkNew<vtkSMProxyIterator> proxies;
  proxies->SetSessionProxyManager(filter->GetSessionProxyManager());
  for (proxies->Begin("sources"); !proxies->IsAtEnd(); proxies->Next())
  {
    if (IsStatistics(proxies->GetProxy()))
    {
      FindReaders(proxies->GetProxy(), found);
    }
  }
  return found;
}

/// A filter has come or gone.
void OnChange(vtkObject*, unsigned long, void*, void* registered)
{
  vtkSMProxy* const filter =
    static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(registered)->Proxy;
  if (!IsStatistics(filter))
  {
    return;
  }
  const std::set<vtkSMProxy*> wanted = FindReadersOfAll(filter);
  std::set<vtkSMProxy*> readers;
  FindReaders(filter, readers);
  for (vtkSMProxy* reader : readers)
  {
    vtkSMPropertyHelper(reader, "ValuesInMemory").Set(static_cast<int>(wanted.count(reader)));
    reader->UpdateProperty("ValuesInMemory");
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
    command->SetCallback(OnChange);
    for (const auto event : { vtkCommand::RegisterEvent, vtkCommand::UnRegisterEvent })
    {
      vtkSMProxyManager::GetProxyManager()->AddObserver(event, command);
    }
  }
}
