// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/ConcurrentFragmentSource.h"

#include "DSMCore/base/Error.h"

#include <string>
#include <system_error>
#include <utility>

namespace dsm
{

ConcurrentFragmentSource::ConcurrentFragmentSource(
  std::vector<std::unique_ptr<FragmentSource>> sources)
  : Sources(std::move(sources))
  , Progress(this->Sources.size())
  , Producing(this->Sources.size())
{
  try
  {
    this->Threads.reserve(this->Sources.size());
    for (std::size_t index = 0; index < this->Sources.size(); ++index)
    {
      this->Threads.emplace_back(
        [this, index] { this->Produce(*this->Sources[index], this->Progress[index]); });
    }
  }
  catch (const std::system_error& error)
  {
    this->Stop(std::make_exception_ptr(
      Error(std::string("Cannot start a thread to prepare the data (") + error.what() +
        "). Raise the process's limit of threads (ulimit -u), free memory, or use fewer ranks on "
        "the host.")));
  }
  catch (...)
  {
    this->Stop(std::current_exception());
  }
}

void ConcurrentFragmentSource::Stop(std::exception_ptr failure)
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Stopping = true;
    this->Failure = this->Failure ? this->Failure : failure;
  }
  this->Changed.notify_all();
}

ConcurrentFragmentSource::~ConcurrentFragmentSource()
{
  this->Stop(nullptr);
  for (std::thread& thread : this->Threads)
  {
    thread.join();
  }
}

void ConcurrentFragmentSource::Produce(FragmentSource& source, std::atomic<double>& progress)
{
  std::exception_ptr failure;
  try
  {
    Fragment fragment;
    while (source.Next(fragment))
    {
      progress = source.GetProgress();
      std::unique_lock<std::mutex> lock(this->Mutex);
      this->Changed.wait(lock, [this] { return this->Stopping || this->Waiting.size() < Ahead; });
      if (this->Stopping)
      {
        break;
      }
      this->Waiting.push_back(std::move(fragment));
      lock.unlock();
      this->Changed.notify_all();
    }
  }
  catch (...)
  {
    failure = std::current_exception();
  }
  progress = 1.0;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    --this->Producing;
    this->Stopping = this->Stopping || failure;
    this->Failure = this->Failure ? this->Failure : failure;
  }
  this->Changed.notify_all();
}

bool ConcurrentFragmentSource::Next(Fragment& fragment)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  this->Changed.wait(
    lock, [this] { return this->Failure || !this->Waiting.empty() || this->Producing == 0; });
  if (this->Failure)
  {
    std::rethrow_exception(this->Failure);
  }
  if (this->Waiting.empty())
  {
    return false;
  }
  fragment = std::move(this->Waiting.front());
  this->Waiting.pop_front();
  lock.unlock();
  this->Changed.notify_all();
  return true;
}

double ConcurrentFragmentSource::GetProgress() const
{
  double sum = 0.0;
  for (const auto& progress : this->Progress)
  {
    sum += progress;
  }
  return this->Progress.empty() ? 1.0 : sum / this->Progress.size();
}

} // namespace dsm
