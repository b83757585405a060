// SPDX-License-Identifier: BSD-3-Clause
// The listening thread of a page store.
#include "DSMCore/paged/PagedStoreInternals.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

namespace dsm
{

void PagedStore::Internals::StartListening()
{
  std::vector<PageFaults::Fault> faults;
  faults.reserve(PageFaults::LargestReport);
  // The application's signals are not for this thread.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try
  {
    this->Listener = std::thread(&Internals::Listen, this, std::move(faults));
  }
  catch (...)
  {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void PagedStore::Internals::StopListening()
{
  if (!this->Listener.joinable())
  {
    return;
  }
  if (getpid() != this->Process)
  {
    this->Listener.detach(); // a child has no such thread
    return;
  }
  this->Faults->StopWaiting();
  this->Listener.join();
}

void PagedStore::Internals::Listen(std::vector<PageFaults::Fault> faults)
{
  while (this->Faults->WaitForFaults(faults))
  {
    bool any = false;
    {
      std::unique_lock<std::mutex> lock(this->Guard);
      for (const PageFaults::Fault& fault : faults)
      {
        try
        {
          any |= this->Take(fault);
        }
        catch (...)
        {
          this->ListenersFailure = std::current_exception();
          this->HasListenerFailed = true;
          this->Messages.WakeUp();
          this->HasClosed.wait(lock, [this] { return this->Phase != FramePhase::Open; });
          this->Take(fault);
        }
      }
    }
    if (any)
    {
      this->Messages.WakeUp();
    }
  }
}

bool PagedStore::Internals::Take(const PageFaults::Fault& fault)
{
  const Segment* segment = nullptr;
  for (const auto& each : this->Segments)
  {
    const auto* const candidate = static_cast<const Segment*>(each.get());
    segment = candidate->Contains(fault.Address) ? candidate : segment;
  }
  BlockId id = 0;
  if (!segment || !segment->FindRemote(fault.Address, id) || this->Phase == FramePhase::Closed ||
    fault.Thread == this->CommunicationThread)
  {
    this->Faults->Answer(fault, PageFaults::Reply::Refused);
    return false;
  }
  if (segment->Lines[id].State == LineState::Cached)
  {
    this->Faults->Answer(fault, PageFaults::Reply::Present);
    return false;
  }
  if (this->Phase == FramePhase::Cancelled)
  {
    this->TakeCancelled(fault, *segment, id);
    return false;
  }
  Worker* const worker = this->FindWorker(fault.Thread);
  if (worker)
  {
    this->AdjustHold(*worker, fault);
  }
  WorkerCounters& counters = worker ? worker->Slow : this->Strangers;
  ++counters.Misses;
  counters.Joins += this->Want({ segment, id }) ? 1 : 0;
  this->Waiting.push_back(Stopped{ fault, segment, id, worker, Clock::now() });
  return true;
}

void PagedStore::Internals::TakeCancelled(
  const PageFaults::Fault& fault, const Segment& segment, BlockId id)
{
  LineStatus& line = segment.Lines[id];
  PageFaults::Reply reply = PageFaults::Reply::Present;
  if (line.State != LineState::Zeroed)
  {
    try
    {
      this->Faults->PlaceZeros(segment.GetAddress(id), segment.Layout.GetFootprint(id));
      line.MoveTo(LineState::Zeroed);
      this->HasZeros = true;
      reply = PageFaults::Reply::Placed;
    }
    catch (const std::exception&)
    {
      reply = PageFaults::Reply::Refused;
    }
  }
  this->Faults->Answer(fault, reply);
}

/// A thread that faults at the same place again did not get to read it: blocks go too soon.
void PagedStore::Internals::AdjustHold(Worker& worker, const PageFaults::Fault& fault)
{
  if (worker.LastFault == fault.Address)
  {
    this->Hold = std::min<Clock::duration>(2 * this->Hold, LongestHold);
  }
  else
  {
    this->Hold = std::max<Clock::duration>(this->Hold - this->Hold / 8, ShortestHold);
  }
  worker.LastFault = fault.Address;
}

PagedStore::Worker* PagedStore::Internals::FindWorker(int thread) const
{
  for (const auto& each : this->Workers)
  {
    auto* const worker = static_cast<Worker*>(each.get());
    if (worker->Thread.load(std::memory_order_relaxed) == thread)
    {
      return worker;
    }
  }
  return nullptr;
}

} // namespace dsm
