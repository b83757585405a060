// SPDX-License-Identifier: BSD-3-Clause
#ifndef LoopbackCluster_h
#define LoopbackCluster_h

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/Messenger.h"

#include <exception>
#include <functional>
#include <thread>
#include <vector>

/// Runs `program` on `ranks` ranks, each a thread of this process with a messenger of its own, and
/// rethrows what the lowest failing rank threw.
inline void RunOnCluster(int ranks, const std::function<void(dsm::Messenger&)>& program)
{
  auto transports = dsm::LoopbackTransport::CreateGroup(ranks);
  std::vector<std::exception_ptr> failures(ranks);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < ranks; ++rank)
  {
    threads.emplace_back(
      [&, rank]
      {
        try
        {
          dsm::Messenger messenger(std::move(transports[rank]));
          program(messenger);
        }
        catch (...)
        {
          failures[rank] = std::current_exception();
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  for (const std::exception_ptr& failure : failures)
  {
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }
}

#endif
