// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ServedWork_h
#define rt_ServedWork_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/SharedFailure.h"
#include "DSMRayTracing/frame/Standstill.h"
#include "DSMRayTracing/frame/WorkerPool.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace rt
{

/// Work of all ranks' threads that acquires blocks, from the store's BeginFrame to its EndFrame: workers work, and the
/// thread that makes this serves the other ranks. It ends on all ranks together: whatever fails in between is kept, and
/// reported (FrameAgreement).
template <class Store>
class ServedWork
{
public:
  ServedWork(const ServedWork&) = delete;
  ServedWork& operator=(const ServedWork&) = delete;

protected:
  /// Collective; the store's BeginFrame is called before. Keeps references.
  ServedWork(Store& store, dsm::Messenger& messenger, WorkerPool& pool)
    : Blocks(store)
    , Messenger(messenger)
    , Agreement(
        messenger, [this] { this->Stop(); }, [this] { this->Cancel(); })
    , Number(messenger.BeginSession())
    , Pool(pool)
    , NoProgress(messenger.GetSilenceLimit())
  {
    messenger.BeginServing();
  }
  virtual ~ServedWork() = default;

  /// Works until all ranks have stopped, and ends the store's frame. Throws only when a rank is lost, and with it
  /// all that is collective. `prepare` may fail.
  void Run(int workers, dsm::FunctionRef<void()> prepare)
  {
    try
    {
      prepare();
      this->Pool.Start(
        workers, [this](int index) { this->RunWorker(index); },
        [this]
        {
          this->FinishWorker();
          this->Messenger.WakeUp();
        });
    }
    catch (...)
    {
      this->Fail(std::current_exception());
    }
    dsm::FirstFailure lost;
    try
    {
      this->Messenger.ServeUntil([this] { return this->Agreement.IsOver(); },
        [this] { return this->Service(); },
        [this](std::exception_ptr cause) { this->Fail(cause); });
    }
    catch (...)
    {
      lost.Keep(std::current_exception());
      this->Messenger.Insist([this] { this->Blocks.Cancel(this->Failure.GetText()); });
    }
    this->Messenger.EndServing();
    this->Pool.Wait();
    this->End();
    this->Blocks.EndFrame();
    lost.Throw();
  }

  /// Collective, after Run. Throws the same dsm::Error on every rank when one has failed; `what` begins its text.
  void Finish(const char* what)
  {
    // The last messages must be sent before the application continues with something else.
    this->Messenger.Flush();
    const dsm::Status& outcome = this->Agreement.GetOutcome();
    if (!outcome.IsOk() || this->Agreement.IsAborted())
    {
      // A rank that gave up may not have taken what it had asked for; it takes it while it waits here.
      this->Messenger.Barrier();
    }
    if (!outcome.IsOk())
    {
      throw dsm::Error(
        std::string(what) + " Rank " + std::to_string(outcome.FailedRank) + ": " + outcome.Cause);
    }
  }

  /// A worker's thread; what it throws fails the work of all ranks.
  virtual void Work(int index) = 0;
  /// A worker's thread, behind all that it has to do.
  virtual void FinishWorker() {}
  /// Any thread: no worker begins anything more.
  virtual void Cancel() {}
  /// The communication thread, often, as Messenger::ProgressUntil says. May fail.
  virtual bool ServeMore() { return false; }
  /// The communication thread, when this rank's workers have stopped, whatever has failed. Returns bytes for all
  /// ranks; may fail.
  virtual std::vector<std::byte> Collect() { return {}; }
  /// The communication thread, before the frame ends.
  virtual void End() {}

  /// Any thread of this rank has failed.
  void Fail(std::exception_ptr cause)
  {
    if (!this->Stopped)
    {
      this->Failure.Keep(cause);
    }
    this->Cancel();
  }
  /// Returns whether any rank is known to have failed, or to have ended the work.
  bool IsInVain() const
  {
    return !this->Failure.IsEmpty() || this->Stopped || this->Agreement.IsAborted();
  }

  Store& Blocks;
  dsm::Messenger& Messenger;
  FrameAgreement Agreement;
  const std::uint32_t Number; ///< of the session

private:
  /// Another rank has failed, which that rank reports.
  void Stop()
  {
    this->Stopped = true;
    this->Cancel();
  }

  void RunWorker(int index)
  {
    try
    {
      this->Work(index);
    }
    catch (...)
    {
      this->Blocks.Leave(this->Blocks.GetWorker(index));
      this->Fail(std::current_exception());
    }
  }

  /// The communication thread, again and again until all ranks have stopped; returns whether it did anything.
  bool Service()
  {
    const bool didSomething = this->Serve();
    const bool idle = this->Pool.GetRunning() == 0; // asked first: a worker fails before it stops
    if (!idle && this->NoProgress.IsOver([this] { return this->GetWork(); }))
    {
      this->Messenger.GiveUpThisRank();
    }
    this->CancelIfFailed();
    const bool isThrough = !this->Agreement.IsDone() && idle && this->Blocks.Drain();
    std::vector<std::byte> report;
    if (isThrough)
    {
      try
      {
        report = this->Collect();
      }
      catch (...)
      {
        this->Fail(std::current_exception());
      }
    }
    this->ReportFailure();
    if (isThrough)
    {
      this->Agreement.ReportDone(std::move(report));
    }
    return didSomething || isThrough;
  }

  /// Other ranks' requests, and what else there is.
  bool Serve()
  {
    bool didSomething = false;
    try
    {
      didSomething = this->Blocks.Service();
      didSomething = this->ServeMore() || didSomething;
    }
    catch (...)
    {
      this->Fail(std::current_exception());
    }
    return didSomething;
  }

  std::pair<double, std::uint64_t> GetWork() const
  {
    return { this->Pool.GetProcessorSeconds(), this->Blocks.GetCounters().BytesReceived };
  }

  /// Workers that wait for bricks wait no longer.
  void CancelIfFailed()
  {
    if ((this->Stopped || !this->Failure.IsEmpty()) && !this->Cancelled)
    {
      this->Messenger.Insist(
        [this]
        {
          this->Blocks.Cancel(
            this->Failure.IsEmpty() ? "another rank has failed" : this->Failure.GetText());
        });
      this->Cancelled = true;
    }
  }

  void ReportFailure()
  {
    if (!this->Failure.IsEmpty() && !this->Agreement.HasFailed())
    {
      std::string cause;
      this->Messenger.Insist([&] { cause = this->Failure.GetText(); });
      this->Agreement.ReportFailure(cause);
    }
  }

  WorkerPool& Pool;
  SharedFailure Failure;
  std::atomic<bool> Stopped{ false };
  bool Cancelled = false;
  Standstill NoProgress;
};

} // namespace rt

#endif
