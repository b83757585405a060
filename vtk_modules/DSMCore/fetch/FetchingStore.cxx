// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/FetchingStore.h"

#include "DSMCore/fetch/BlockFetcher.h"

namespace dsm
{

void FetchingStore::Refresh(
  std::string_view what, const BlockSegment& segment, const std::vector<bool>& changed)
{
  this->Fetcher->Messages.RunTogether(what, [&] { this->Fetcher->Refresh(segment, changed); });
}

bool FetchingStore::MayBeginFrame() const
{
  return this->Fetcher->MayBeginFrame();
}

void FetchingStore::BeginFrame(bool agreed)
{
  this->Fetcher->BeginFrame(agreed);
}

bool FetchingStore::Service()
{
  return this->Fetcher->Service();
}

void FetchingStore::Cancel(const std::string& cause)
{
  this->Fetcher->Cancel(cause);
}

bool FetchingStore::Drain()
{
  return this->Fetcher->Drain();
}

void FetchingStore::EndFrame()
{
  this->Fetcher->EndFrame();
}

bool FetchingStore::MayPrefetch() const
{
  return this->Fetcher->MayPrefetch();
}

std::uint64_t FetchingStore::GetMisses(const FetchWorker& worker) const
{
  return this->Fetcher->GetMisses(worker);
}

StoreCounters FetchingStore::GetCounters() const
{
  return this->Fetcher->GetCounters();
}

std::uint64_t FetchingStore::GetBytesFrom(int owner) const
{
  return this->Fetcher->GetBytesFrom(owner);
}

std::vector<WorkerCounters> FetchingStore::GetWorkerCounters() const
{
  return this->Fetcher->GetWorkerCounters();
}

} // namespace dsm
