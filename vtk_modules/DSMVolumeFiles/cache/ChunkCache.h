// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ChunkCache_h
#define vol_ChunkCache_h

#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/format/ArrayStep.h"

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace vol
{

/// The most recently read chunks of files, up to a number of bytes. Any thread; a chunk that two threads want
/// at the same time is read once. Chunks that are being read and unpacked count, too: if several exceed the
/// limit, one waits for the other.
class ChunkCache
{
public:
  using Chunk = std::shared_ptr<const ByteBuffer>;

  explicit ChunkCache(std::size_t bytes)
    : Limit(bytes)
  {
  }

  /// Returns the cache that all files of the process share.
  static ChunkCache& GetShared();

  /// Applies from now on. Chunks in use stay in memory until they are released.
  void SetLimit(std::size_t bytes);
  std::size_t GetLimit() const;
  /// Returns the bytes that a cache needs so that consecutive boxes of so many samples along each axis do not read
  /// their common chunks again: the chunks that one box lies in, and those that two threads read meanwhile.
  static std::uint64_t CountBytesTogether(const FileArray& array, std::int64_t samples);
  /// Raises the limit to at least so many bytes, until SetLimit is called: a reader needs chunks of that size
  /// together.
  void Widen(std::size_t bytes);
  /// Lowers the effective limit from now on, for a caller with a limited amount of memory; GetLimit stays.
  /// Returns the effective limit.
  std::size_t Restrict(std::size_t bytes);
  /// That, or less where it is restricted.
  std::size_t GetRoom() const;
  /// Lets others have a part of the room, where chunks have to leave: false, and nothing is lent, if all that is
  /// would be more than the room divided by `divisor`.
  bool Lend(std::size_t bytes, std::size_t divisor);
  /// Returns room that Lend has given.
  void Return(std::size_t bytes);
  /// The file's chunks leave.
  void Forget(const VolumeFile& file);
  /// In memory now, with what is lent, and what is being read.
  std::size_t GetBytes() const;
  /// Read so far, of chunks as they are in memory.
  std::uint64_t GetBytesRead() const;

  /// The samples of a chunk, as VolumeFile::ReadChunk gives them. Throws what that throws, to all who wait; the
  /// next one who asks tries again. Where a thread is not to wait (WithoutWaiting), not for another one either.
  Chunk Get(const ArrayStep& of, const bricks::Index3& chunk);

  /// The samples of a box of an array, dense, x fastest, through the cache.
  void ReadBox(const ArrayStep& of, const bricks::Box& box, std::byte* out);
  /// The same for boxes far from one another: of chunks that are not here, no more is read than must be.
  void ReadScattered(const ArrayStep& of, const bricks::Box& box, std::byte* out);

  /// The samples of boxes, likewise, each to its own place, by so many threads; each chunk is read once for all of
  /// them.
  void ReadBoxes(const ArrayStep& of, const std::vector<bricks::Box>& boxes,
    const std::vector<std::byte*>& outs, int threads);

  /// Boxes will probably be read soon: advises the system of their chunks that are not cached, each one once; fetches
  /// those of a server on other threads. Errors are reported when the boxes are read.
  void Prefetch(const ArrayStep& of, const std::vector<bricks::Box>& boxes);

private:
  /// The cache does not keep a file open.
  struct Key
  {
    std::uint64_t File; ///< VolumeFile::GetNumber
    std::size_t Array;
    int Step;
    std::int64_t Number;

    bool operator==(const Key& other) const
    {
      return this->File == other.File && this->Array == other.Array && this->Step == other.Step &&
        this->Number == other.Number;
    }
  };
  struct KeyHash
  {
    std::size_t operator()(const Key& key) const;
  };
  struct Entry
  {
    std::shared_future<Chunk> Data;
    std::size_t Bytes = 0; ///< 0: being read
    std::list<Key>::iterator Place;
  };

  void Read(const ArrayStep& of, const bricks::Box& box, bool scattered, std::byte* out);
  void FetchAhead(const ArrayStep& of, const bricks::Index3& chunk);
  bool HasChunk(const ArrayStep& of, const bricks::Index3& chunk) const;
  /// A box that a chunk and its halo fill, where the file has these together and the chunk is not here.
  bool ReadWithHalo(const ArrayStep& of, const bricks::Box& box, std::byte* out);
  /// A box of several chunks, none of which is stored.
  bool ReadFill(const ArrayStep& of, const bricks::Box& box, std::byte* out);
  /// Under the lock, as GetRoom without it.
  std::size_t ComputeRoom() const
  {
    return std::min(std::max(this->Limit, this->Together), this->Restriction);
  }
  /// Under the lock. Returns the memory of an evicted and unused chunk, if it has so many bytes: new memory
  /// from the system has to be filled with zeros first.
  std::shared_ptr<ByteBuffer> Evict(std::size_t bytes = 0);

  mutable std::mutex Guard;
  std::size_t Limit;
  std::size_t Together = 0; ///< see Widen
  std::size_t Restriction = SIZE_MAX;
  std::size_t Bytes = 0;
  std::size_t Lent = 0;   ///< part of Bytes that is in use
  std::size_t InHand = 0; ///< part of Bytes that is being read
  std::condition_variable HandsFree;
  std::uint64_t BytesRead = 0;
  std::list<Key> Order; ///< keys of the cached chunks, the most recently used first
  std::unordered_map<Key, Entry, KeyHash> Entries;
};

/// As OpenVolumeSeries; when its last user releases the volume, its chunks leave the shared cache.
std::shared_ptr<const VolumeFile> OpenCachedVolume(
  const std::vector<std::string>& paths, const OpenOptions& options);

} // namespace vol

#endif
