// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVersionCheck.h"

#include "vtkPVDSMVersionInformation.h"

#include "vtkNew.h"
#include "vtkPVSession.h"
#include "vtkSMSession.h"
#include "vtkSMSessionClient.h"

#include <set>
#include <string>
#include <utility>

void vtkPVDSMVersionCheck::Run(vtkSMSession* session)
{
  if (!vtkSMSessionClient::SafeDownCast(session))
  {
    return;
  }
  vtkNew<vtkPVDSMVersionInformation> information;
  information->CopyFromObject(nullptr);
  const std::string client = information->GetVersion();
  session->GatherInformation(vtkPVSession::DATA_SERVER_ROOT, information, 0);
  const std::string& server = information->GetVersion();
  static std::set<std::pair<std::string, std::string>> told;
  if (client.empty() || server.empty() || client == server ||
    !told.insert({ client, server }).second)
  {
    return;
  }
  vtkGenericWarningMacro("DSM Ray Tracer has version "
    << client << " on this client and version " << server
    << " on the server. Properties that exist on one side only have no effect. Load the same "
       "version on both sides: 'Tools > Manage Plugins' shows the loaded files.");
}
