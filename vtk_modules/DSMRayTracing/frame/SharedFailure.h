// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SharedFailure_h
#define rt_SharedFailure_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/transport/Messenger.h"

#include <exception>
#include <mutex>
#include <string>

namespace rt
{

/// The first failure among a rank's workers and its communication thread. Any thread.
class SharedFailure
{
public:
  void Keep(std::exception_ptr failure)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->First.Keep(failure);
  }
  bool IsEmpty() const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->First.IsEmpty();
  }
  std::string GetText() const
  {
    try
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->First.Throw();
      return {};
    }
    catch (...)
    {
      return dsm::Messenger::DescribeException();
    }
  }

private:
  mutable std::mutex Mutex;
  dsm::FirstFailure First;
};

} // namespace rt

#endif
