// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/cache/ReadAhead.h"

#include "DSMCore/base/ReaderThreads.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

/// Divisor for the part of the cache's room that bricks read ahead may take.
constexpr std::size_t RoomDivisor = 2;

/// After a frame its picture is still drawn and delivered, and ParaView's processes talk to one another: on a host
/// without spare cores, reading would keep them from it for longer than this.
constexpr std::chrono::milliseconds Rest{ 30 };

} // namespace

struct ReadAhead::Step::Contents
{
  ChunkCache& Cache;
  const Way To;

  std::mutex Guard;
  std::unordered_map<dsm::BlockId, std::vector<std::byte>> Bricks;
  std::unordered_set<dsm::BlockId> Known; ///< that were added
};

ReadAhead::Step::Step(ChunkCache& cache, Way way)
  : Self(new Contents{ cache, std::move(way), {}, {}, {} })
{
}

ReadAhead::Step::~Step()
{
  for (const auto& [id, brick] : this->Self->Bricks)
  {
    this->Self->Cache.Return(brick.size());
  }
}

bool ReadAhead::Step::Take(dsm::BlockId id, std::byte* block, std::size_t bytes)
{
  std::vector<std::byte> brick;
  {
    const std::lock_guard<std::mutex> lock(this->Self->Guard);
    const auto found = this->Self->Bricks.find(id);
    if (found == this->Self->Bricks.end() || found->second.size() != bytes)
    {
      return false;
    }
    brick = std::move(found->second);
    this->Self->Bricks.erase(found);
  }
  std::copy(brick.begin(), brick.end(), block);
  this->Self->Cache.Return(bytes);
  return true;
}

struct ReadAhead::Shared : std::enable_shared_from_this<Shared>
{
  struct Job
  {
    std::weak_ptr<Step> For;
    dsm::BlockId Id;
    std::size_t Bytes;
  };

  explicit Shared(ChunkCache& cache)
    : Cache(cache)
  {
  }

  /// Notes the brick. Returns whether it was not added before.
  static bool Note(Step& step, dsm::BlockId id)
  {
    const std::lock_guard<std::mutex> lock(step.Self->Guard);
    return step.Self->Known.insert(id).second;
  }

  /// Under the lock: has the next brick read, if there is any and nothing stands against it.
  void Begin()
  {
    if (this->IsReading || this->Pauses > 0 || this->Waiting.empty())
    {
      return;
    }
    try
    {
      dsm::ReaderThreads::GetShared().Add([self = this->shared_from_this()] { self->ReadNext(); });
      this->IsReading = true;
    }
    catch (const std::exception&) // no thread can be had: then nothing is read ahead
    {
      this->Waiting.clear();
    }
  }

  void ReadNext()
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    while (this->Pauses == 0 && std::chrono::steady_clock::now() < this->RestsUntil)
    {
      const auto until = this->RestsUntil;
      lock.unlock();
      std::this_thread::sleep_until(until);
      lock.lock();
    }
    if (this->Pauses == 0 && !this->Waiting.empty())
    {
      const Job job = std::move(this->Waiting.front());
      this->Waiting.pop_front();
      lock.unlock();
      Read(job);
      lock.lock();
    }
    this->IsReading = false;
    this->Begin();
  }

  static void Read(const Job& job)
  {
    const std::shared_ptr<Step> step = job.For.lock();
    if (!step)
    {
      return;
    }
    Step::Contents& contents = *step->Self;
    bool hasRoom = false;
    try
    {
      if (contents.To.IsSame && contents.To.IsSame(job.Id))
      {
        return;
      }
      hasRoom = contents.Cache.Lend(job.Bytes, RoomDivisor);
      if (!hasRoom)
      {
        contents.To.Reader->Prefetch({ job.Id });
        return;
      }
      std::vector<std::byte> brick(job.Bytes);
      contents.To.Reader->Read(job.Id, brick.data(), brick.size());
      const std::lock_guard<std::mutex> lock(contents.Guard);
      contents.Bricks.emplace(job.Id, std::move(brick));
    }
    catch (...) // the brick is read when a ray needs it
    {
      contents.Cache.Return(hasRoom ? job.Bytes : 0);
    }
  }

  ChunkCache& Cache;
  std::mutex Guard;
  int Pauses = 0;
  std::chrono::steady_clock::time_point RestsUntil;
  bool IsReading = false;
  std::deque<Job> Waiting;
  std::map<std::uint64_t, std::shared_ptr<Step>> Steps;
};

ReadAhead& ReadAhead::GetShared()
{
  static ReadAhead ahead(ChunkCache::GetShared());
  return ahead;
}

ReadAhead::ReadAhead(ChunkCache& cache)
  : State(std::make_shared<Shared>(cache))
{
}

std::shared_ptr<ReadAhead::Step> ReadAhead::Find(std::uint64_t key) const
{
  const std::lock_guard<std::mutex> lock(this->State->Guard);
  const auto known = this->State->Steps.find(key);
  return known == this->State->Steps.end() ? nullptr : known->second;
}

std::shared_ptr<ReadAhead::Step> ReadAhead::Open(std::uint64_t key, Way way)
{
  const std::lock_guard<std::mutex> lock(this->State->Guard);
  std::shared_ptr<Step>& step = this->State->Steps[key];
  if (!step)
  {
    step = std::make_shared<Step>(this->State->Cache, std::move(way));
  }
  return step;
}

void ReadAhead::Add(const std::shared_ptr<Step>& step, dsm::BlockId id, std::size_t bytes)
{
  if (Shared::Note(*step, id))
  {
    const std::lock_guard<std::mutex> lock(this->State->Guard);
    this->State->Waiting.push_back({ step, id, bytes });
    this->State->Begin();
  }
}

void ReadAhead::Tidy()
{
  std::vector<std::shared_ptr<Step>> unused; // goes without the lock
  const std::lock_guard<std::mutex> lock(this->State->Guard);
  auto& steps = this->State->Steps;
  for (auto entry = steps.begin(); entry != steps.end();)
  {
    const bool isUsed = entry->second.use_count() > 1;
    if (!isUsed)
    {
      unused.push_back(std::move(entry->second));
    }
    entry = isUsed ? std::next(entry) : steps.erase(entry);
  }
}

ReadAhead::Pause::Pause(ReadAhead& ahead)
  : Ahead(ahead)
{
  const std::lock_guard<std::mutex> lock(this->Ahead.State->Guard);
  ++this->Ahead.State->Pauses;
}

ReadAhead::Pause::~Pause()
{
  const std::lock_guard<std::mutex> lock(this->Ahead.State->Guard);
  --this->Ahead.State->Pauses;
  this->Ahead.State->RestsUntil = std::chrono::steady_clock::now() + Rest;
  this->Ahead.State->Begin();
}

} // namespace vol
