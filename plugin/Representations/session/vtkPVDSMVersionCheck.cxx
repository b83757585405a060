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
  vtkGenericWarningMacro("The DSM Ray Tracer of this client has version "
    << client << ", that of the server " << server
    << ". Properties that only one of them knows have no effect. Load the same version on both "
       "sides: "
       "'Tools > Manage Plugins' shows which file each has loaded.");
}
