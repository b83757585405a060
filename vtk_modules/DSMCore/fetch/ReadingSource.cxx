// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/ReadingSource.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/base/ReaderThreads.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

namespace dsm
{

namespace
{

/// Seconds between two polls that count, at most: this process may have been stopped.
constexpr double LongestPause = 1.0;

} // namespace

/// State that the source and the threads share; it lives as long as an abandoned read.
struct ReadingSource::Shared
{
  struct Done
  {
    BlockWant Block;
    BlockMemory Memory;
    std::exception_ptr Failure;
  };

  std::mutex Guard;
  Messenger* Messages = nullptr;
  std::uint64_t Round = 0; ///< grows when all reads are abandoned
  std::vector<Done> Arrived;

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
      this->Arrived.push_back(std::move(done)); // within the reserved room
      this->Messages->WakeUp();
    }
  }
};

ReadingSource::ReadingSource(
  Messenger& messenger, std::shared_ptr<const BlockReader> reader, std::string name)
  : Reader(std::move(reader))
  , Name(std::move(name))
  , State(std::make_shared<Shared>())
{
  this->State->Messages = &messenger;
  this->State->Arrived.reserve(MostReads);
  this->Reading.reserve(MostReads);
}

ReadingSource::~ReadingSource()
{
  this->Abandon();
}

void ReadingSource::Begin(const BlockWant& block)
{
  this->Waiting.push_back({ block, this->Seconds });
}

bool ReadingSource::Submit()
{
  const std::size_t before = this->Waiting.size();
  this->HandOver();
  return this->Waiting.size() != before;
}

bool ReadingSource::TryRead(const BlockWant& block)
{
  const std::size_t bytes = block.From->GetDirectory().GetBytes(block.Id);
  if (!this->Spare || this->SpareBytes != bytes)
  {
    this->Spare = AllocateBlock(bytes);
    this->SpareBytes = bytes;
  }
  if (!this->Reader->TryRead(block.Id, this->Spare.get(), bytes))
  {
    return false;
  }
  this->AtHand.push_back({ block, {} });
  this->AtHand.back().Memory = std::move(this->Spare);
  return true;
}

void ReadingSource::HandOver()
{
  while (!this->Waiting.empty() && this->Reading.size() + this->AtHand.size() < MostReads)
  {
    const Wanted wanted = this->Waiting.front();
    const BlockWant block = wanted.Block;
    if (this->TryRead(block))
    {
      this->Waiting.pop_front();
      continue;
    }
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
          done.Memory = AllocateBlock(bytes);
          reader->Read(block.Id, done.Memory.get(), bytes);
        }
        catch (...)
        {
          done.Failure = std::current_exception();
        }
        state->Finish(std::move(done), round);
      });
    this->Waiting.pop_front();
    this->Reading.push_back(wanted);
  }
}

void ReadingSource::CheckDisk()
{
  const auto now = std::chrono::steady_clock::now();
  this->Seconds +=
    std::min(std::chrono::duration<double>(now - this->LastPoll).count(), LongestPause);
  this->LastPoll = now;
  const double limit = PartOfSilence * this->State->Messages->GetSilenceLimit();
  const Wanted* const oldest = !this->Reading.empty() ? &this->Reading.front()
    : !this->Waiting.empty()                          ? &this->Waiting.front()
                                                      : nullptr;
  if (limit > 0.0 && oldest && this->Seconds - oldest->Since > limit)
  {
    char seconds[32];
    std::snprintf(seconds, sizeof(seconds), "%g", limit);
    throw Error("Brick " + std::to_string(oldest->Block.Id) + " of " + this->Name +
      " did not arrive within " + seconds +
      " s (three quarters of the silence limit). The disk or network does not respond or is too "
      "slow. The next frame requests the brick again. To wait longer, raise the silence limit "
      "(DSMSilenceLimit; 0 waits forever).");
  }
}

bool ReadingSource::Poll(const Deliver& deliver)
{
  std::vector<Shared::Done> arrived;
  arrived.reserve(MostReads);
  {
    const std::lock_guard<std::mutex> lock(this->State->Guard);
    arrived.swap(this->State->Arrived);
  }
  for (Shared::Done& done : arrived)
  {
    this->Reading.erase(std::find_if(this->Reading.begin(), this->Reading.end(),
      [&](const Wanted& wanted) { return wanted.Block == done.Block; }));
    if (done.Failure)
    {
      std::rethrow_exception(done.Failure); // the frame is over, and the rest with it
    }
    deliver(done.Block, std::move(done.Memory));
  }
  std::vector<Ready> atHand = std::exchange(this->AtHand, {});
  for (Ready& ready : atHand)
  {
    deliver(ready.Block, std::move(ready.Memory));
  }
  this->HandOver();
  this->CheckDisk();
  return !arrived.empty() || !atHand.empty();
}

void ReadingSource::Abandon() noexcept
{
  this->Waiting.clear();
  this->Reading.clear();
  this->AtHand.clear();
  const std::lock_guard<std::mutex> lock(this->State->Guard);
  ++this->State->Round;
  this->State->Arrived.clear();
}

bool ReadingSource::ReadWithoutWaiting(BlockId id, std::byte* block, std::size_t bytes) const
{
  try
  {
    return this->Reader->ReadWithoutWaiting(id, block, bytes);
  }
  catch (const std::exception&)
  {
    return false;
  }
}

void ReadingSource::Prefetch(std::vector<BlockId> ids)
{
  ReaderThreads::GetShared().Add(
    [reader = this->Reader, ids = std::move(ids)] { reader->Prefetch(ids); });
}

void ReadingSource::NoteKept(const BlockWant& block)
{
  this->Reader->NoteKept(block.Id, block.From->GetDirectory().GetBytes(block.Id));
}

void ReadingSource::Read(BlockId id, std::byte* block, std::size_t bytes) const
{
  this->Reader->Read(id, block, bytes);
}

} // namespace dsm
