// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_RankGroup_h
#define dsm_test_RankGroup_h

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/Messenger.h"

#include <gtest/gtest.h>

#include <exception>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace dsm_test
{

/// Plays a cluster: runs `rank` on `size` threads, each with the messenger of one rank of a loopback
/// group. An exception on any rank fails the test.
inline void RunRanks(int size, const std::function<void(dsm::Messenger&)>& rank)
{
  auto transports = dsm::LoopbackTransport::CreateGroup(size);
  std::vector<std::thread> threads;
  for (auto& transport : transports)
  {
    threads.emplace_back(
      [&rank, own = std::move(transport)]() mutable
      {
        dsm::Messenger messenger(std::move(own));
        const int number = messenger.GetRank();
        try
        {
          rank(messenger);
        }
        catch (const std::exception& exception)
        {
          ADD_FAILURE() << "Rank " << number << " threw: " << exception.what();
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}

/// The text of the Error that `step` throws; empty, and a failure, when it throws none.
template <class Step>
std::string GetErrorText(const Step& step)
{
  try
  {
    step();
  }
  catch (const dsm::Error& error)
  {
    return error.what();
  }
  ADD_FAILURE() << "no dsm::Error was thrown";
  return {};
}

} // namespace dsm_test

#endif
