// SPDX-License-Identifier: BSD-3-Clause
#ifndef AccessFrame_h
#define AccessFrame_h

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/WorkerPool.h"

#include <functional>
#include <mutex>
#include <string>

/// A frame without a picture.

namespace AccessTiming
{

/// A frame in which the first `workers` workers of each rank, which may differ, call `work`, and all
/// ranks serve. Collective.
template <class Store>
void RunFrame(dsm::Messenger& messenger, Store& store, rt::WorkerPool& pool, int workers,
  const std::function<void(typename Store::Worker&, int)>& work)
{
  store.BeginFrame();
  rt::FrameAgreement agreement(messenger, [] {});
  messenger.BeginSession();
  std::mutex guard;
  std::string cause;
  if (workers > 0)
  {
    pool.Start(
      workers,
      [&](int index)
      {
        typename Store::Worker& worker = store.GetWorker(index);
        store.Enter(worker);
        try
        {
          work(worker, index);
        }
        catch (...)
        {
          const std::lock_guard<std::mutex> lock(guard);
          cause = dsm::Messenger::DescribeException();
        }
        store.Leave(worker);
      },
      [&messenger] { messenger.WakeUp(); });
  }
  messenger.ProgressUntil([&] { return agreement.IsOver(); },
    [&]
    {
      bool any = store.Service();
      if (!agreement.IsDone() && (workers == 0 || pool.GetRunning() == 0))
      {
        if (!cause.empty())
        {
          agreement.ReportFailure(cause);
        }
        agreement.ReportDone();
        any = true;
      }
      return any;
    });
  if (workers > 0)
  {
    pool.Wait();
  }
  store.EndFrame();
  messenger.ProgressUntil([&] { return messenger.GetUnsentBytes() == 0; });
  if (!agreement.GetOutcome().IsOk())
  {
    throw dsm::Error(agreement.GetOutcome().Cause);
  }
}

} // namespace AccessTiming

#endif
