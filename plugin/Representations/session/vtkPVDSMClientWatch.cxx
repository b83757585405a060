// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMClientWatch.h"

#include "vtkClientSocket.h"
#include "vtkCompositeMultiProcessController.h"
#include "vtkPVSession.h"
#include "vtkPVSessionServer.h"
#include "vtkProcessModule.h"
#include "vtkSocketCommunicator.h"

#include <poll.h>

namespace
{
vtkCompositeMultiProcessController* FindClients()
{
  auto* module = vtkProcessModule::GetProcessModule();
  auto* session = module ? vtkPVSessionServer::SafeDownCast(module->GetActiveSession()) : nullptr;
  return session
    ? vtkCompositeMultiProcessController::SafeDownCast(session->GetController(vtkPVSession::CLIENT))
    : nullptr;
}
} // namespace

vtkPVDSMClientWatch::vtkPVDSMClientWatch()
{
  auto* clients = FindClients();
  vtkMultiProcessController* client = clients ? clients->GetActiveController() : nullptr;
  auto* communicator =
    client ? vtkSocketCommunicator::SafeDownCast(client->GetCommunicator()) : nullptr;
  if (communicator && communicator->GetSocket())
  {
    this->Descriptor = communicator->GetSocket()->GetSocketDescriptor();
  }
}

bool vtkPVDSMClientWatch::HasSent() const
{
  pollfd connection{ this->Descriptor, POLLIN, 0 };
  return this->Descriptor >= 0 && poll(&connection, 1, 0) != 0;
}

int vtkPVDSMClientWatch::CountClients()
{
  auto* clients = FindClients();
  return clients ? clients->GetNumberOfControllers() : 0;
}
