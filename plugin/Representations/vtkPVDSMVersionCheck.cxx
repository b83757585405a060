// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVersionCheck.h"

#include "vtkPVPluginsInformation.h"
#include "vtkSMPluginManager.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSession.h"
#include "vtkSMSessionClient.h"

#include <set>
#include <string>
#include <utility>

namespace
{

/// Empty where it is not loaded.
std::string FindVersion(vtkPVPluginsInformation* plugins)
{
  for (unsigned int index = 0; plugins && index < plugins->GetNumberOfPlugins(); ++index)
  {
    if (plugins->GetPluginLoaded(index) &&
      std::string(plugins->GetPluginName(index)) == "DSMRayTracer")
    {
      return plugins->GetPluginVersion(index);
    }
  }
  return {};
}

} // namespace

void vtkPVDSMVersionCheck::Run(vtkSMSession* session)
{
  if (!vtkSMSessionClient::SafeDownCast(session))
  {
    return;
  }
  vtkSMPluginManager* plugins = vtkSMProxyManager::GetProxyManager()->GetPluginManager();
  const std::string client = FindVersion(plugins->GetLocalInformation());
  const std::string server = FindVersion(plugins->GetRemoteInformation(session));
  static std::set<std::pair<std::string, std::string>> told;
  if (client.empty() || server.empty() || client == server ||
    !told.insert({ client, server }).second)
  {
    return;
  }
  vtkGenericWarningMacro("The DSM Ray Tracer of this client has version "
    << client << ", that of the server " << server
    << ". Properties that only one of them knows have no effect. Load the same version on both "
       "sides: "
       "'Tools > Manage Plugins' shows which file each has loaded.");
}
