// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMReadAhead.h"

#include "DSMCore/fetch/ReaderThreads.h"

#include <deque>
#include <exception>
#include <mutex>
#include <set>
#include <vector>

namespace
{

/// What is read ahead takes this part of the cache's room at most.
constexpr std::size_t RoomDivisor = 2;

} // namespace

struct vtkDSMReadAhead::Shared : std::enable_shared_from_this<Shared>
{
  explicit Shared(vol::ChunkCache& cache)
    : Cache(cache)
  {
  }

  /// Under the lock: has the next chunk read, if there is any and nothing stands against it.
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
    if (this->Pauses == 0 && !this->Waiting.empty())
    {
      const rt::Index3 chunk = this->Waiting.front();
      this->Waiting.pop_front();
      const std::shared_ptr<const vol::VolumeFile> file = this->File;
      const std::size_t array = this->Array;
      const int step = this->Step;
      lock.unlock();
      try
      {
        // Else the system has been asked for it (vol::VolumeFile::Foresee), and no more need be read than a brick is.
        const vol::FileArray& what = file->GetArrays()[array];
        const rt::Index3 first = what.Grid.GetBox(chunk).Min;
        std::vector<std::byte> sample(what.GetSampleBytes());
        if (!file->ReadPart(array, step, chunk, { first, first + rt::Index3(1) }, sample.data()))
        {
          this->Cache.Get(file, array, step, chunk);
        }
      }
      catch (const std::exception&)
      {
      }
      lock.lock();
    }
    this->IsReading = false;
    this->Begin();
  }

  vol::ChunkCache& Cache;
  std::mutex Guard;
  int Pauses = 0;
  bool IsReading = false;
  std::shared_ptr<const vol::VolumeFile> File;
  std::size_t Array = 0;
  int Step = 0;
  std::deque<rt::Index3> Waiting;
  std::set<std::int64_t> Known; ///< numbers of the chunks that were added
  std::size_t Bytes = 0;        ///< of them
};

vtkDSMReadAhead& vtkDSMReadAhead::GetShared()
{
  static vtkDSMReadAhead ahead(vol::ChunkCache::GetShared());
  return ahead;
}

vtkDSMReadAhead::vtkDSMReadAhead(vol::ChunkCache& cache)
  : State(std::make_shared<Shared>(cache))
{
}

void vtkDSMReadAhead::Add(const std::shared_ptr<const vol::VolumeFile>& file, std::size_t array,
  int step, const rt::Index3& chunk)
{
  Shared& state = *this->State;
  const vol::FileArray& what = file->GetArrays()[array];
  const std::lock_guard<std::mutex> lock(state.Guard);
  if (state.File != file || state.Array != array || state.Step != step)
  {
    state.Waiting.clear();
    state.Known.clear();
    state.Bytes = 0;
    state.File = file;
    state.Array = array;
    state.Step = step;
  }
  const std::size_t bytes =
    static_cast<std::size_t>(what.Grid.GetBox(chunk).GetCount()) * what.GetSampleBytes();
  if (state.Bytes + bytes <= state.Cache.GetRoom() / RoomDivisor &&
    state.Known.insert(what.Grid.GetNumber(chunk)).second)
  {
    state.Bytes += bytes;
    state.Waiting.push_back(chunk);
    state.Begin();
  }
}

vtkDSMReadAhead::Pause::Pause(vtkDSMReadAhead& ahead)
  : Ahead(ahead)
{
  const std::lock_guard<std::mutex> lock(this->Ahead.State->Guard);
  ++this->Ahead.State->Pauses;
}

vtkDSMReadAhead::Pause::~Pause()
{
  const std::lock_guard<std::mutex> lock(this->Ahead.State->Guard);
  --this->Ahead.State->Pauses;
  this->Ahead.State->Begin();
}
