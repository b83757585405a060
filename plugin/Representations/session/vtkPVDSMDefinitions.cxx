// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMDefinitions.h"

#include "vtkPVDSMDefinitionsText.h"
#include "vtkPVDSMNoUndo.h"
#include "vtkPVDSMPanelLoader.h"
#include "vtkPVDSMStepStatistics.h"
#include "vtkPVDSMVersionInformation.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkPVSessionBase.h"
#include "vtkProcessModule.h"
#include "vtkSIProxyDefinitionManager.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMProxyDefinitionManager.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSessionIterator.h"
#include "vtkSmartPointer.h"

namespace
{

/// After ParaView's own observers of a new session have done what makes it one.
constexpr float Late = -100.0f;

bool IsServer()
{
  const auto type = vtkProcessModule::GetProcessType();
  return type == vtkProcessModule::PROCESS_SERVER ||
    type == vtkProcessModule::PROCESS_DATA_SERVER ||
    type == vtkProcessModule::PROCESS_RENDER_SERVER;
}

bool HaveDefinitions(vtkPVSessionBase* session)
{
  return session->GetProxyDefinitionManager()->HasDefinition("settings", "DSMRayTracerSettings");
}

/// Its other definitions come with the plugin.
bool HasPlugin(vtkPVSessionBase* session)
{
  return session->GetProxyDefinitionManager()->HasDefinition(
    "representations", "DSMImageRepresentation");
}

/// ParaView keeps definitions with what they derive from, and does not make these anew for what is added but by a
/// plugin's own list.
struct Kept final : vtkSIProxyDefinitionManager
{
  static void Forget(vtkSIProxyDefinitionManager& definitions)
  {
    (definitions.*(&Kept::InvalidateCollapsedDefinition))();
  }
};

/// To a session whose definitions are this process's own.
void Add(vtkPVSessionBase* session)
{
  if (!HaveDefinitions(session))
  {
    vtkSIProxyDefinitionManager* const definitions = session->GetProxyDefinitionManager();
    Kept::Forget(*definitions);
    vtkPVDSMStepStatistics::Replace(definitions);
    definitions->LoadConfigurationXMLFromString(vtkPVDSMDefinitionsText);
  }
}

/// To a session with a server, and to the server.
void AskFor(vtkSMSessionClient* session)
{
  if (HaveDefinitions(session) || !HasPlugin(session))
  {
    return;
  }
  vtkNew<vtkPVDSMVersionInformation> information;
  for (const vtkTypeUInt32 processes : { vtkPVSession::DATA_SERVER, vtkPVSession::RENDER_SERVER })
  {
    session->GatherInformation(processes, information, 0);
  }
  if (vtkSMSessionProxyManager* const proxies =
        vtkSMProxyManager::GetProxyManager()->GetSessionProxyManager(session))
  {
    proxies->GetProxyDefinitionManager()->SynchronizeDefinitions();
  }
}

/// ParaView makes the proxy of a new settings page when the plugin was loaded, as a change that can be undone. Here
/// it is made before, as one that cannot. Only the application has changes to undo.
void MakeSettings(vtkSMSession* session)
{
  vtkSMSessionProxyManager* const proxies = session->GetSessionProxyManager();
  // A session that is being made gets all of its settings later.
  if (!vtkSMProxyManager::GetProxyManager()->GetUndoStackBuilder() || !proxies ||
    !HaveDefinitions(session) || !proxies->GetProxy("settings", "GeneralSettings"))
  {
    return;
  }
  const vtkPVDSMNoUndo noUndo;
  vtkNew<vtkSMParaViewPipelineController>()->UpdateSettingsProxies(session);
}

void Update();

/// Calls Update.
vtkCommand* GetUpdate()
{
  static const auto command = []
  {
    auto made = vtkSmartPointer<vtkCallbackCommand>::New();
    made->SetCallback([](vtkObject*, unsigned long, void*, void*) { Update(); });
    return made;
  }();
  return command;
}

/// A server's definitions come to its client when a session begins, and when the server has loaded a plugin, which in
/// some versions is later than the client's.
void Watch(vtkSMSessionClient* session)
{
  vtkSIProxyDefinitionManager* const definitions = session->GetProxyDefinitionManager();
  const unsigned long event = vtkSIProxyDefinitionManager::ProxyDefinitionsUpdated;
  if (!definitions->HasObserver(event, GetUpdate()))
  {
    definitions->AddObserver(event, GetUpdate());
  }
}

void Update()
{
  const auto iterator = vtkSmartPointer<vtkSessionIterator>::Take(
    vtkProcessModule::GetProcessModule()->NewSessionIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    vtkSession* const session = iterator->GetCurrentSession();
    if (auto* client = vtkSMSessionClient::SafeDownCast(session))
    {
      Watch(client);
      AskFor(client);
    }
    else if (auto* own = vtkPVSessionBase::SafeDownCast(session))
    {
      Add(own);
    }
    if (auto* application = vtkSMSession::SafeDownCast(session))
    {
      MakeSettings(application);
      vtkPVDSMPanelLoader::Load();
    }
  }
}

} // namespace

void vtkPVDSMDefinitions::Load()
{
  static bool isLoaded = false;
  if (IsServer() || isLoaded)
  {
    return;
  }
  isLoaded = true;
  vtkProcessModule::GetProcessModule()->AddObserver(
    vtkCommand::ConnectionCreatedEvent, GetUpdate(), Late);
  Update();
}

void vtkPVDSMDefinitions::Allow()
{
  if (IsServer())
  {
    Update();
  }
}
