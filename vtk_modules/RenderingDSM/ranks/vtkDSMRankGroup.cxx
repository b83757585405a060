// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMRankGroup.h"

#include "DSMCore/memory/FreedMemory.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/MpiTransport.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include "vtkLogger.h"
#include "vtkMultiProcessController.h"
#include "vtkOutputWindow.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#endif

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>

namespace
{

/// So much of files is read before freed memory goes back to the system anew: it takes milliseconds.
constexpr std::uint64_t LeastBytesOfFiles = std::uint64_t(64) << 20;

/// The memory that a rank may take is divided by it for chunks of files.
constexpr std::uint64_t ChunksDivisor = 8;

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
      " processes do not communicate over MPI, which DSM Ray Tracer requires.");
  }
  auto& known = groups[GetKey(communicator)];
  auto group = known.lock();
  if (!group)
  {
    group = std::shared_ptr<vtkDSMRankGroup>(new vtkDSMRankGroup(CreateTransport(communicator)),
      [](vtkDSMRankGroup* old)
      {
        delete old;
        dsm::FreedMemory::ReturnNowAndSoon();
      });
    known = group;
  }
  return group;
}

vtkDSMRankGroup::vtkDSMRankGroup(std::unique_ptr<dsm::Transport> transport)
  : Messenger(std::move(transport))
  , Store(this->Messenger, dsm::BlockStore::Settings{})
  , FrameRenderer(this->Messenger)
{
  this->Messenger.GetHosts(); // collective the first time
}

void vtkDSMRankGroup::Join(Publisher* publisher)
{
  this->Publishers.push_back(publisher);
}

void vtkDSMRankGroup::Leave(Publisher* publisher)
{
  this->Publishers.erase(std::remove(this->Publishers.begin(), this->Publishers.end(), publisher),
    this->Publishers.end());
}

void vtkDSMRankGroup::Configure()
{
  using Options = vtkDSMMemoryOptions;
  static_assert(static_cast<int>(dsm::MemoryOrganization::Automatic) == Options::Automatic &&
      static_cast<int>(dsm::MemoryOrganization::Replicated) == Options::Replicated &&
      static_cast<int>(dsm::MemoryOrganization::ObjectBased) == Options::ObjectBased &&
      static_cast<int>(dsm::MemoryOrganization::PageBased) == Options::PageBased,
    "the options number the organizations as the store does");
  const dsm::BlockStore::Settings old = this->Store.GetSettings();
  dsm::BlockStore::Settings next = old;
  next.Organization = static_cast<dsm::MemoryOrganization>(this->Options->GetMemoryOrganization());
  next.HostSharing = this->Options->GetHostSharing();
  next.MemoryBytes = static_cast<std::uint64_t>(this->Options->GetMemory()) << 20;
  next.SourceCacheBytes = RestrictRoomForChunks(next.MemoryBytes);
  next.ScratchDirectory = this->Options->GetScratchDirectory();
  next.CacheBytes = static_cast<std::size_t>(this->Options->GetCacheSize()) << 20;
  const int threads = this->Options->GetNumberOfThreads();
  next.Workers = threads > 0 ? threads : this->Messenger.GetCoresPerRank();
  const auto isPaged = [](dsm::MemoryOrganization organization)
  { return organization == dsm::MemoryOrganization::PageBased; };
  if (next.HostSharing != old.HostSharing ||
    isPaged(next.Organization) != isPaged(this->Store.GetOrganization()))
  {
    for (Publisher* publisher : this->Publishers)
    {
      publisher->GiveUpBlocks();
    }
  }
  if (next.Organization != old.Organization || next.HostSharing != old.HostSharing ||
    next.MemoryBytes != old.MemoryBytes || next.ScratchDirectory != old.ScratchDirectory)
  {
    ++this->SettingsVersion;
  }
  this->Messenger.SetSilenceLimit(this->Options->GetSilenceLimit());
  this->Store.SetSettings(next);
}

std::uint64_t vtkDSMRankGroup::GetMostForChunks(std::uint64_t memoryBytes) const
{
  return std::max(memoryBytes / ChunksDivisor, std::min(memoryBytes / 2, this->LeastForChunks));
}

std::uint64_t vtkDSMRankGroup::RestrictRoomForChunks(std::uint64_t memoryBytes) const
{
  return vol::ChunkCache::GetShared().Restrict(
    memoryBytes == 0 ? SIZE_MAX : static_cast<std::size_t>(this->GetMostForChunks(memoryBytes)));
}

std::uint64_t vtkDSMRankGroup::WidenRoomForChunks(std::uint64_t bytes, std::uint64_t least)
{
  this->LeastForChunks = std::max(this->LeastForChunks, least);
  dsm::BlockStore::Settings settings = this->Store.GetSettings();
  const auto ranksOnHost = static_cast<std::uint64_t>(this->Messenger.GetRanksOnHost());
  const auto memory = this->Messenger.GatherValueTogether("Allocating the chunk cache",
    [&]
    {
      return settings.MemoryBytes != 0 ? settings.MemoryBytes
                                       : dsm::GetAvailableHostMemory() / 2 / ranksOnHost;
    });
  const std::uint64_t most =
    this->GetMostForChunks(*std::min_element(memory.begin(), memory.end()));
  vol::ChunkCache::GetShared().Widen(static_cast<std::size_t>(std::min(bytes, most)));
  settings.SourceCacheBytes = RestrictRoomForChunks(settings.MemoryBytes);
  this->Store.SetSettings(settings);
  return settings.SourceCacheBytes;
}

bool vtkDSMRankGroup::Settle()
{
  try
  {
    this->WithRoom([this] { this->Store.Settle(); });
    return true;
  }
  catch (const dsm::MemoryShortage&)
  {
    if (this->Store.GetSettings().ScratchDirectory.empty())
    {
      throw;
    }
  }
  for (Publisher* publisher : this->Publishers)
  {
    publisher->GiveUpBlocks();
  }
  return false;
}

/// Returns whether there was anything to free.
bool vtkDSMRankGroup::MakeRoom()
{
  Publisher* oldest = nullptr;
  for (Publisher* publisher : this->Publishers)
  {
    if (publisher->GetOldestHidden() != 0 &&
      (!oldest || publisher->GetOldestHidden() < oldest->GetOldestHidden()))
    {
      oldest = publisher;
    }
  }
  if (oldest)
  {
    oldest->GiveUpOldestHidden();
  }
  return oldest != nullptr;
}

void vtkDSMRankGroup::ReturnMemoryOfFiles()
{
  const std::uint64_t read = vol::ChunkCache::GetShared().GetBytesRead();
  if (read - this->BytesOfFiles >= LeastBytesOfFiles)
  {
    this->BytesOfFiles = read;
    dsm::FreedMemory::Return();
  }
}

void vtkDSMRankGroup::TellOrganization()
{
  const bool automatic =
    this->Store.GetSettings().Organization == dsm::MemoryOrganization::Automatic;
  // Groups come and go with what is shown; the user need not hear the same again.
  static std::pair told(dsm::MemoryOrganization::Automatic, false);
  const std::pair chosen(this->Store.GetOrganization(), this->Store.LacksMemory());
  const std::string& explanation =
    this->Store.GetExplanation(); // none before there is anything to keep
  if (!automatic || explanation.empty() || chosen == told)
  {
    return;
  }
  told = chosen;
  // One rank has no choice to make.
  if (this->Messenger.GetRank() == 0 && this->Messenger.GetSize() > 1)
  {
    const std::string text = "DSM Ray Tracer: " + explanation;
    if (chosen.second)
    {
      vtkOutputWindow::GetInstance()->DisplayText((text + "\n").c_str());
    }
    else
    {
      vtkLogF(INFO, "%s", text.c_str());
    }
  }
}
