// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMServerWatch.h"

#include "pqApplicationCore.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "vtkPVPluginsInformation.h"
#include "vtkSMPluginManager.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSession.h"

#include <cstring>
#include <string>

namespace
{

constexpr const char* Plugin = "DSMRayTracer";

bool IsLoaded(vtkPVPluginsInformation* plugins)
{
  for (unsigned int number = 0; plugins && number < plugins->GetNumberOfPlugins(); ++number)
  {
    if (std::strcmp(plugins->GetPluginName(number), Plugin) == 0)
    {
      return plugins->GetPluginLoaded(number);
    }
  }
  return false;
}

} // namespace

pqDSMServerWatch::pqDSMServerWatch(QObject* parent)
  : QObject(parent)
{
}

pqDSMServerWatch::~pqDSMServerWatch() = default;

void pqDSMServerWatch::OnStartup()
{
  // Before ParaView looks for what the server lacks, which it does when the server has been added.
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::serverReady, this, &pqDSMServerWatch::OnServerReady);
}

void pqDSMServerWatch::OnShutdown()
{
  QObject::disconnect(
    pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
}

void pqDSMServerWatch::OnServerReady(pqServer* server)
{
  vtkSMPluginManager* const plugins = vtkSMProxyManager::GetProxyManager()->GetPluginManager();
  vtkSMSession* const session = server && server->isRemote() ? server->session() : nullptr;
  if (!session || IsLoaded(plugins->GetRemoteInformation(session)))
  {
    return;
  }
  const std::string wish =
    std::string("<Plugins><Plugin name=\"") + Plugin + "\" auto_load=\"1\"/></Plugins>";
  plugins->LoadPluginConfigurationXMLFromString(wish.c_str(), session, true);
}
