// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/ReadingSource.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/fetch/ReaderThreads.h"

#include <cstdint>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

namespace dsm
{

/// What the source and the threads share; it lives for as long as a read that was given up.
struct ReadingSource::Shared
{
  struct Done
  {
    BlockWant Block;
    std::vector<std::byte> Bytes;
    std::exception_ptr Failure;
  };

  std::mutex Guard;
  Messenger* Messages = nullptr;
  std::uint64_t Round = 0; ///< grows when all is given up
  std::vector<Done> Come;

  bool IsWanted(std::uint64_t round)
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    return this->Round == round;
  }

  void Finish(Done&& done, std::uint64_t round)
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    if (this->Round == round)
    {
      this->Come.push_back(std::move(done)); // room was made by whoever handed the read over
      this->Messages->WakeUp();
    }
  }
};

ReadingSource::ReadingSource(Messenger& messenger, std::shared_ptr<const BlockReader> reader)
  : Reader(std::move(reader))
  , State(std::make_shared<Shared>())
{
  this->State->Messages = &messenger;
  this->State->Come.reserve(MostReads);
}

ReadingSource::~ReadingSource()
{
  this->Abandon();
}

void ReadingSource::Begin(const BlockWant& block, std::byte*)
{
  this->Waiting.push_back(block);
}

bool ReadingSource::Submit()
{
  const bool any = !this->Waiting.empty() && this->Reads < MostReads;
  this->HandOver();
  return any;
}

void ReadingSource::HandOver()
{
  while (!this->Waiting.empty() && this->Reads < MostReads)
  {
    const BlockWant block = this->Waiting.front();
    std::uint64_t round = 0;
    {
      const std::lock_guard<std::mutex> lock(this->State->Guard);
      round = this->State->Round;
    }
    ReaderThreads::GetShared().Add(
      [state = this->State, reader = this->Reader, block, round,
        bytes = block.From->GetDirectory().GetBytes(block.Id)]
      {
        if (!state->IsWanted(round))
        {
          return; // its segment may be gone, too
        }
        Shared::Done done{ block, {}, nullptr };
        try
        {
          done.Bytes.resize(bytes);
          reader->Read(block.Id, done.Bytes.data(), bytes);
        }
        catch (...)
        {
          done.Failure = std::current_exception();
        }
        state->Finish(std::move(done), round);
      });
    this->Waiting.pop_front();
    ++this->Reads;
  }
}

bool ReadingSource::Poll(const Deliver& deliver)
{
  std::vector<Shared::Done> come;
  come.reserve(MostReads);
  {
    const std::lock_guard<std::mutex> lock(this->State->Guard);
    come.swap(this->State->Come);
  }
  for (const Shared::Done& done : come)
  {
    --this->Reads;
    if (done.Failure)
    {
      std::rethrow_exception(done.Failure); // the frame is over, and the rest with it
    }
    deliver(done.Block, done.Bytes.data());
  }
  this->HandOver();
  return !come.empty();
}

void ReadingSource::Abandon() noexcept
{
  this->Waiting.clear();
  this->Reads = 0;
  const std::lock_guard<std::mutex> lock(this->State->Guard);
  ++this->State->Round;
  this->State->Come.clear();
}

void ReadingSource::Read(BlockId id, std::byte* block, std::size_t bytes) const
{
  this->Reader->Read(id, block, bytes);
}

} // namespace dsm
