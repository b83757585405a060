// SPDX-License-Identifier: BSD-3-Clause
#ifndef LoopbackCluster_h
#define LoopbackCluster_h

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/Messenger.h"

#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

inline std::unique_ptr<dsm::Messenger> CreateMessenger(std::unique_ptr<dsm::Transport> transport)
{
  return std::make_unique<dsm::Messenger>(std::move(transport));
}

/// Runs `program` on `ranks` ranks, each a thread of this process with a messenger of its own, which
/// `create` makes, and rethrows what the lowest failing rank threw.
template <class Create = decltype(&CreateMessenger)>
void RunOnCluster(int ranks, const std::function<void(dsm::Messenger&)>& program,
  const Create& create = &CreateMessenger)
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
          const auto messenger = create(std::move(transports[rank]));
          program(*messenger);
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
