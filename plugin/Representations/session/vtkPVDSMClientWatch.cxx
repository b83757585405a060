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

/// Returns the socket of a connection; negative if there is none.
int GetSocket(vtkMultiProcessController* client)
{
  auto* communicator =
    client ? vtkSocketCommunicator::SafeDownCast(client->GetCommunicator()) : nullptr;
  return communicator && communicator->GetSocket()
    ? communicator->GetSocket()->GetSocketDescriptor()
    : -1;
}
} // namespace

vtkPVDSMClientWatch::vtkPVDSMClientWatch()
{
  auto* clients = FindClients();
  this->Descriptor = GetSocket(clients ? clients->GetActiveController() : nullptr);
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

std::vector<int> vtkPVDSMClientWatch::ListConnections()
{
  std::vector<int> sockets;
  auto* clients = FindClients();
  for (int number = 0; number < CountClients(); ++number)
  {
    sockets.push_back(GetSocket(clients->GetController(number)));
  }
  return sockets;
}
