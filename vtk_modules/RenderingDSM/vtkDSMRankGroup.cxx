// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMRankGroup.h"

#include "DSMCore/LoopbackTransport.h"
#include "DSMCore/MpiTransport.h"

#include "vtkMultiProcessController.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#endif

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <thread>

namespace
{

/// The MPI_Comm of a controller that spans several processes, else null.
const void* GetCommunicator(vtkMultiProcessController* controller)
{
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    auto* communicator = vtkMPICommunicator::SafeDownCast(controller->GetCommunicator());
    if (communicator && communicator->GetMPIComm())
    {
      return communicator->GetMPIComm()->GetHandle();
    }
  }
#else
  (void)controller;
#endif
  return nullptr;
}

/// Communicators are compared by their handle; 0 stands for a group of one.
std::uint64_t GetKey(const void* communicator)
{
  std::uint64_t key = 0;
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  if (communicator)
  {
    static_assert(sizeof(MPI_Comm) <= sizeof(key), "a communicator's handle fits the key");
    std::memcpy(&key, communicator, sizeof(MPI_Comm));
  }
#else
  (void)communicator;
#endif
  return key;
}

std::unique_ptr<dsm::Transport> CreateTransport(const void* communicator)
{
  if (!communicator)
  {
    return std::move(dsm::LoopbackTransport::CreateGroup(1).front());
  }
  auto transport = dsm::MpiTransport::Create(communicator);
  if (!transport)
  {
    throw dsm::Error("Several processes render, but DSM Ray Tracer was built without MPI. Build it "
                     "with MPI, or use one process.");
  }
  return transport;
}

} // namespace

std::shared_ptr<vtkDSMRankGroup> vtkDSMRankGroup::Get(vtkMultiProcessController* controller)
{
  static std::map<std::uint64_t, std::weak_ptr<vtkDSMRankGroup>> groups;
  const void* communicator = GetCommunicator(controller);
  if (!communicator && controller && controller->GetNumberOfProcesses() > 1)
  {
    throw dsm::Error("The " + std::to_string(controller->GetNumberOfProcesses()) +
      " processes do not communicate over MPI, which DSM Ray Tracer needs.");
  }
  auto& known = groups[GetKey(communicator)];
  auto group = known.lock();
  if (!group)
  {
    group = std::make_shared<vtkDSMRankGroup>(CreateTransport(communicator));
    known = group;
  }
  return group;
}

namespace
{

/// Bricks are owned round robin, and what a rank needs of the others' goes through its cache.
dsm::BlockStore::Settings GetFirstSettings()
{
  dsm::BlockStore::Settings settings;
  settings.Organization = dsm::MemoryOrganization::ObjectBased;
  settings.HostSharing = false;
  return settings;
}

} // namespace

vtkDSMRankGroup::vtkDSMRankGroup(std::unique_ptr<dsm::Transport> transport)
  : Messenger(std::move(transport))
  , Store(this->Messenger, GetFirstSettings())
  , FrameRenderer(this->Messenger)
{
  this->Messenger.GetHosts(); // collective the first time
}

void vtkDSMRankGroup::Configure(std::size_t cacheBytes, int threads)
{
  const int ranksOnHost = this->Messenger.GetRanksOnHost();
  dsm::BlockStore::Settings settings = this->Store.GetSettings();
  settings.CacheBytes = cacheBytes;
  if (threads < 1)
  {
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    threads = cores / std::max(1, ranksOnHost);
  }
  settings.Workers = std::max(1, threads);
  this->Store.SetSettings(settings);
}
