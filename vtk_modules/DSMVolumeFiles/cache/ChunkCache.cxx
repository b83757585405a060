// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/base/ReaderThreads.h"
#include "DSMVolumeFiles/base/CopyBox.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/ReadingManner.h"
#include "DSMVolumeFiles/base/Url.h"
#include "DSMVolumeFiles/open/SeriesFile.h"

#include <atomic>
#include <exception>
#include <map>
#include <new>
#include <utility>

namespace vol
{

namespace
{

constexpr std::size_t SharedBytes = std::size_t(128) << 20;

/// While a chunk is read, its bytes as the file has them are in memory, too, which hardly are more than it.
constexpr std::size_t InHandOfEach = 2;

/// About what a chunk takes beside its samples: a chunk may have a single one.
constexpr std::size_t EntryBytes = 400;

/// Requests to servers at the same time, and the part of the room that they may fill.
constexpr int RequestsAhead = 16;
constexpr std::uint64_t PartAhead = 4;

/// Samples along an axis that a brick has in common with the next.
constexpr int Overlap = 2;

} // namespace

ChunkCache& ChunkCache::GetShared()
{
  static ChunkCache cache(SharedBytes);
  return cache;
}

std::size_t ChunkCache::KeyHash::operator()(const Key& key) const
{
  const std::int64_t words[] = { static_cast<std::int64_t>(key.File),
    static_cast<std::int64_t>(key.Array), key.Step, key.Number };
  return dsm::HashBytes(words, sizeof(words));
}

void ChunkCache::SetLimit(std::size_t bytes)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Limit = bytes;
  this->Together = 0;
  this->Evict();
}

std::size_t ChunkCache::GetLimit() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Limit;
}

std::uint64_t ChunkCache::CountBytesTogether(const FileArray& array, std::int64_t samples)
{
  const std::size_t sampleBytes = array.GetSampleBytes();
  return array.Grid.CountBytesOfChunks(samples, sampleBytes) +
    2 * InHandOfEach * array.Grid.CountBytesOfChunks(1, sampleBytes);
}

void ChunkCache::Widen(std::size_t bytes)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Together = std::max(this->Together, bytes);
}

std::size_t ChunkCache::GetRoom() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->ComputeRoom();
}

std::size_t ChunkCache::Restrict(std::size_t bytes)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Restriction = bytes;
  this->Evict();
  return this->ComputeRoom();
}

bool ChunkCache::Lend(std::size_t bytes, std::size_t divisor)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  const std::size_t most = this->ComputeRoom() / divisor;
  if (bytes > most || this->Lent > most - bytes)
  {
    return false;
  }
  this->Lent += bytes;
  this->Bytes += bytes;
  this->Evict();
  return true;
}

void ChunkCache::Return(std::size_t bytes)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Lent -= bytes;
  this->Bytes -= bytes;
}

void ChunkCache::Forget(const VolumeFile& file)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  for (auto place = this->Order.begin(); place != this->Order.end();)
  {
    if (place->File == file.GetNumber())
    {
      const auto entry = this->Entries.find(*place);
      this->Bytes -= entry->second.Bytes;
      this->Entries.erase(entry);
      place = this->Order.erase(place);
    }
    else
    {
      ++place;
    }
  }
}

std::size_t ChunkCache::GetBytes() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Bytes;
}

std::uint64_t ChunkCache::GetBytesRead() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->BytesRead;
}

ChunkCache::Chunk ChunkCache::Get(const ArrayStep& of, const bricks::Index3& chunk)
{
  const FileArray& what = of.Get();
  const Key key{ of.File->GetNumber(), of.Array, of.Step, what.Grid.GetNumber(chunk) };
  const std::size_t chunkBytes =
    static_cast<std::size_t>(what.Grid.GetBox(chunk).GetCount()) * what.GetSampleBytes();
  const std::size_t inHand = chunkBytes * InHandOfEach;
  std::promise<Chunk> promise;
  std::shared_ptr<ByteBuffer> bytes;
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    const auto known = this->Entries.find(key);
    if (known != this->Entries.end())
    {
      if (known->second.Bytes != 0)
      {
        this->Order.splice(this->Order.begin(), this->Order, known->second.Place);
      }
      else if (WithoutWaiting::IsInForce())
      {
        throw WouldWait{};
      }
      const std::shared_future<Chunk> data = known->second.Data;
      lock.unlock();
      try
      {
        return data.get();
      }
      catch (const WouldWait&) // told to who began to read it, not to this thread
      {
        return this->Get(of, chunk);
      }
    }
    const auto hasRoom = [&]
    { return this->InHand == 0 || this->InHand + this->Lent + inHand <= this->ComputeRoom(); };
    if (WithoutWaiting::IsInForce() && !hasRoom())
    {
      throw WouldWait{};
    }
    this->Entries[key].Data = promise.get_future().share();
    this->HandsFree.wait(lock, hasRoom);
    this->InHand += inHand;
    this->Bytes += inHand;
    bytes = this->Evict(chunkBytes);
  }
  std::exception_ptr failure;
  try
  {
    try
    {
      if (!bytes)
      {
        bytes = std::make_shared<ByteBuffer>(chunkBytes);
      }
      of.File->ReadChunk(of.Array, of.Step, chunk, bytes->data());
    }
    catch (const std::bad_alloc&)
    {
      throw FileError({ of.File->GetPath(), what.Name, chunk },
        "cannot be read: out of memory for its " + std::to_string(chunkBytes) +
          " bytes. Use a host with more memory, or write the file with "
          "smaller chunks.");
    }
  }
  catch (...)
  {
    failure = std::current_exception();
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->InHand -= inHand;
  this->Bytes -= inHand;
  this->HandsFree.notify_all();
  try
  {
    if (failure)
    {
      std::rethrow_exception(failure);
    }
    Entry& entry = this->Entries.at(key);
    this->Order.push_front(key);
    entry.Place = this->Order.begin();
    entry.Bytes = bytes->size() + EntryBytes;
    this->Bytes += entry.Bytes;
    this->BytesRead += bytes->size();
    promise.set_value(bytes);
    this->Evict();
    return bytes;
  }
  catch (...)
  {
    promise.set_exception(std::current_exception());
    this->Entries.erase(key);
    throw;
  }
}

void ChunkCache::ReadBox(const ArrayStep& of, const bricks::Box& box, std::byte* out)
{
  this->Read(of, box, false, out);
}

void ChunkCache::ReadScattered(const ArrayStep& of, const bricks::Box& box, std::byte* out)
{
  const ScatteredReads scope;
  this->Read(of, box, true, out);
}

void ChunkCache::ReadBoxes(const ArrayStep& of, const std::vector<bricks::Box>& boxes,
  const std::vector<std::byte*>& outs, int threads)
{
  const FileArray& what = of.Get();
  std::map<std::int64_t, std::vector<std::size_t>> wanted; // by which boxes a chunk is
  for (std::size_t box = 0; box < boxes.size(); ++box)
  {
    bricks::ForEachIndex(what.Grid.GetChunks(boxes[box]),
      [&](const bricks::Index3& chunk) { wanted[what.Grid.GetNumber(chunk)].push_back(box); });
  }
  const std::vector<std::pair<std::int64_t, std::vector<std::size_t>>> chunks(
    wanted.begin(), wanted.end());
  bricks::ParallelFor(threads, chunks.size(),
    [&](std::size_t index, int)
    {
      const bricks::Index3 chunk = what.Grid.GetChunk(chunks[index].first);
      const bricks::Box part = what.Grid.GetBox(chunk);
      const Chunk samples = this->Get(of, chunk);
      for (const std::size_t box : chunks[index].second)
      {
        CopyBox(bricks::Intersect(part, boxes[box]), samples->data(), part, outs[box], boxes[box],
          what.GetSampleBytes());
      }
    });
}

bool ChunkCache::HasChunk(const ArrayStep& of, const bricks::Index3& chunk) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Entries.count(
           { of.File->GetNumber(), of.Array, of.Step, of.Get().Grid.GetNumber(chunk) }) != 0;
}

void ChunkCache::Read(const ArrayStep& of, const bricks::Box& box, bool scattered, std::byte* out)
{
  if (this->ReadWithHalo(of, box, out) || this->ReadFill(of, box, out))
  {
    return;
  }
  ByteBuffer dense;
  const FileArray& what = of.Get();
  bricks::ForEachIndex(what.Grid.GetChunks(box),
    [&](const bricks::Index3& chunk)
    {
      const bricks::Box part = what.Grid.GetBox(chunk);
      const bricks::Box common = bricks::Intersect(part, box);
      if (scattered && !this->HasChunk(of, chunk))
      {
        dense.resize(static_cast<std::size_t>(common.GetCount()) * what.GetSampleBytes());
        if (of.File->ReadPart(of.Array, of.Step, chunk, common, dense.data()))
        {
          CopyBox(common, dense.data(), common, out, box, what.GetSampleBytes());
          const std::lock_guard<std::mutex> lock(this->Guard);
          this->BytesRead += dense.size();
          return;
        }
      }
      const Chunk samples = this->Get(of, chunk);
      CopyBox(common, samples->data(), part, out, box, what.GetSampleBytes());
    });
}

bool ChunkCache::ReadWithHalo(const ArrayStep& of, const bricks::Box& box, std::byte* out)
{
  const FileArray& what = of.Get();
  const bricks::Index3 chunk = box.Min / what.Grid.ChunkSamples;
  const bricks::Box all = what.Grid.GetBoxWithHalo(chunk);
  if (all.Min != box.Min || all.Max != box.Max || this->HasChunk(of, chunk) ||
    !of.File->ReadWithHalo(of.Array, of.Step, chunk, out))
  {
    return false;
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->BytesRead += static_cast<std::size_t>(box.GetCount()) * what.GetSampleBytes();
  return true;
}

bool ChunkCache::ReadFill(const ArrayStep& of, const bricks::Box& box, std::byte* out)
{
  const FileArray& what = of.Get();
  const bricks::Index3 chunk = box.Min / what.Grid.ChunkSamples;
  const bool isInOne = bricks::Intersect(what.Grid.GetBox(chunk), box).GetCount() == box.GetCount();
  if (isInOne || !of.File->IsFill(of.Array, of.Step, box))
  {
    return false;
  }
  const Chunk samples = this->Get(of, chunk);
  Repeat(samples->data(), what.GetSampleBytes(), out,
    static_cast<std::size_t>(box.GetCount()) * what.GetSampleBytes());
  return true;
}

void ChunkCache::FetchAhead(const ArrayStep& of, const bricks::Index3& chunk)
{
  static dsm::ReaderThreads threads(RequestsAhead);
  static std::atomic<std::uint64_t> waiting{ 0 };
  const std::uint64_t bytes =
    static_cast<std::uint64_t>(of.Get().Grid.GetBox(chunk).GetCount()) * of.Get().GetSampleBytes();
  if (waiting.fetch_add(bytes) + bytes > this->GetRoom() / PartAhead)
  {
    waiting -= bytes;
    return;
  }
  threads.Add(
    [this, of, chunk, bytes]
    {
      try
      {
        this->Get(of, chunk);
      }
      catch (const std::exception&) // who needs the chunk asks again
      {
      }
      waiting -= bytes;
    });
}

void ChunkCache::Prefetch(const ArrayStep& of, const std::vector<bricks::Box>& boxes)
{
  const FileArray& what = of.Get();
  const bool isRemote = IsUrl(of.File->GetPath());
  try
  {
    std::vector<VolumeFile::ChunkPart> parts;
    for (const bricks::Box& box : boxes)
    {
      // Samples that a brick needs beyond its own cells belong to another brick, too.
      const bricks::Box own{ box.Min,
        glm::max(box.Min + bricks::Index3(1), box.Max - bricks::Index3(Overlap)) };
      bricks::ForEachIndex(what.Grid.GetChunks(own),
        [&](const bricks::Index3& chunk)
        {
          if (this->HasChunk(of, chunk))
          {
            return;
          }
          if (isRemote)
          {
            this->FetchAhead(of, chunk);
          }
          else
          {
            parts.push_back({ chunk, bricks::Intersect(what.Grid.GetBox(chunk), box) });
          }
        });
    }
    of.File->Prefetch(of.Array, of.Step, parts);
  }
  catch (const std::exception&)
  {
    return;
  }
}

std::shared_ptr<ByteBuffer> ChunkCache::Evict(std::size_t bytes)
{
  std::shared_ptr<ByteBuffer> left;
  while (this->Bytes > this->ComputeRoom() && !this->Order.empty())
  {
    const auto last = this->Entries.find(this->Order.back());
    this->Bytes -= last->second.Bytes;
    Chunk chunk = last->second.Data.get();
    this->Entries.erase(last);
    this->Order.pop_back();
    if (!left && chunk->size() == bytes && chunk.use_count() == 1)
    {
      // Synchronize with the last user, which has finished reading.
      std::atomic_thread_fence(std::memory_order_acquire);
      left = std::const_pointer_cast<ByteBuffer>(chunk);
    }
  }
  return left;
}

std::shared_ptr<const VolumeFile> OpenCachedVolume(
  const std::vector<std::string>& paths, const OpenOptions& options)
{
  ChunkCache::GetShared(); // so that it is there until the file is not
  std::shared_ptr<const VolumeFile> file = OpenVolumeSeries(paths, options);
  const VolumeFile* const bare = file.get();
  const auto forget = [file = std::move(file)](const VolumeFile* old) mutable
  {
    ChunkCache::GetShared().Forget(*old);
    file.reset();
  };
  return { bare, forget };
}

} // namespace vol
