// SPDX-License-Identifier: BSD-3-Clause
// Chunks without a file of any format: where they are, what they hold, how they are packed and kept.
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CopyBox.h"
#include "DSMVolumeFiles/base/ReadingManner.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"
#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <thread>
#include <vector>

namespace
{

/// Chunks of a thousand bytes, of which one cannot be read.
class SlowFile final : public vol::VolumeFile
{
public:
  SlowFile()
    : VolumeFile("slow")
  {
    vol::FileArray array;
    array.Grid = { bricks::Index3(10 * Chunks, 10, 10), bricks::Index3(10) };
    this->Arrays.push_back(array);
  }
  void ReadChunk(std::size_t, int, const bricks::Index3& chunk, std::byte* out) const override
  {
    const int now = ++this->Reading;
    for (int most = this->Most; now > most && !this->Most.compare_exchange_weak(most, now);)
    {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    --this->Reading;
    if (chunk.x == Bad)
    {
      throw dsm::Error("damaged");
    }
    std::fill_n(out, 1000, static_cast<std::byte>(chunk.x));
  }

  static constexpr int Chunks = 24;
  static constexpr int Bad = 11;
  mutable std::atomic<int> Reading{ 0 };
  mutable std::atomic<int> Most{ 0 };
};

/// A chunk that has to be waited for.
class ColdFile final : public vol::VolumeFile
{
public:
  ColdFile()
    : VolumeFile("cold")
  {
    vol::FileArray array;
    array.Grid = { bricks::Index3(10), bricks::Index3(10) };
    this->Arrays.push_back(array);
  }
  void ReadChunk(std::size_t, int, const bricks::Index3&, std::byte* out) const override
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (vol::WithoutWaiting::IsInForce())
    {
      throw vol::WouldWait{};
    }
    std::fill_n(out, 1000, std::byte(7));
  }
};

TEST(ChunkCache, WhatIsBeingReadCountsToo)
{
  for (const int most : { 1, 3 })
  {
    const auto file = std::make_shared<SlowFile>();
    vol::ChunkCache cache(most == 1 ? 0 : 6500); // each takes twice its bytes while it is read
    std::atomic<int> wrong{ 0 };
    std::atomic<int> failed{ 0 };
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 8; ++thread)
    {
      threads.emplace_back(
        [&, thread]
        {
          for (int chunk = thread; chunk < SlowFile::Chunks; chunk += 8)
          {
            try
            {
              const auto bytes = cache.Get({ file, 0, 0 }, bricks::Index3(chunk, 0, 0));
              wrong += bytes->size() == 1000 && bytes->back() == std::byte(chunk) ? 0 : 1;
            }
            catch (const dsm::Error&)
            {
              ++failed;
            }
          }
        });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(failed, 1);
    EXPECT_EQ(file->Most, most);
    EXPECT_LE(cache.GetBytes(), cache.GetLimit()) << "nothing is in hand any more";
  }
}

/// Chunks of one sample each, of which none is stored.
class SparseFile final : public vol::VolumeFile
{
public:
  SparseFile()
    : VolumeFile("sparse")
  {
    vol::FileArray array;
    array.Grid = { bricks::Index3(1000, 10, 10), bricks::Index3(1) };
    this->Arrays.push_back(array);
  }
  void ReadChunk(std::size_t, int, const bricks::Index3&, std::byte* out) const override
  {
    ++this->Reads;
    *out = std::byte(7);
  }
  bool IsFill(std::size_t, int, const bricks::Box& box) const override { return box.Min.x > 0; }

  mutable int Reads = 0;
};

TEST(ChunkCache, SmallChunksTakeNoMoreThanTheLimit)
{
  const auto file = std::make_shared<SparseFile>();
  vol::ChunkCache cache(100000); // far more than the samples have
  for (int x = 0; x < 1000; ++x)
  {
    cache.Get({ file, 0, 0 }, { x, 0, 0 });
  }
  EXPECT_EQ(file->Reads, 1000);
  cache.Get({ file, 0, 0 }, { 0, 0, 0 });
  EXPECT_EQ(file->Reads, 1001) << "what a chunk takes beside its samples counts, too";
  EXPECT_LE(cache.GetBytes(), cache.GetLimit());
}

TEST(ChunkCache, WhatIsNotStoredIsReadOnceForABox)
{
  const auto file = std::make_shared<SparseFile>();
  vol::ChunkCache cache(1 << 20);
  std::vector<std::byte> box(999 * 100);
  cache.ReadBox({ file, 0, 0 }, { { 1, 0, 0 }, { 1000, 10, 10 } }, box.data());
  EXPECT_EQ(std::count(box.begin(), box.end(), std::byte(7)), 999 * 100);
  EXPECT_EQ(file->Reads, 1);
}

TEST(ChunkCache, HoldsWhatIsNeededTogetherWhereItMay)
{
  vol::ChunkCache cache(3000);
  cache.Widen(2000);
  EXPECT_EQ(cache.GetRoom(), 3000u);
  cache.Widen(5000);
  EXPECT_EQ(cache.GetRoom(), 5000u);
  EXPECT_EQ(cache.Restrict(4000), 4000u);
  cache.SetLimit(1000);
  EXPECT_EQ(cache.GetRoom(), 1000u) << "until the limit is set anew";
}

TEST(ChunkGrid, CountsTheChunksOfABoxAtWorst)
{
  const vol::ChunkGrid planes{ bricks::Index3(40, 30, 20), bricks::Index3(40, 30, 1) };
  EXPECT_EQ(planes.CountBytesOfChunks(17, 4), 17u * 40 * 30 * 4);
  EXPECT_EQ(planes.CountBytesOfChunks(33, 4), 20u * 40 * 30 * 4) << "no more than there are";
  EXPECT_EQ(planes.CountBytesOfChunks(1, 4), 40u * 30 * 4);
  const vol::ChunkGrid cubes{ bricks::Index3(100), bricks::Index3(16) };
  EXPECT_EQ(cubes.CountBytesOfChunks(17, 1), 8u * 16 * 16 * 16);
  EXPECT_EQ(cubes.CountBytesOfChunks(18, 1), 27u * 16 * 16 * 16);
}

/// The memory of what has left is used again, but not what somebody still looks at.
TEST(ChunkCache, ChunksThatAreHeldStayWhatTheyAre)
{
  const auto file = std::make_shared<SlowFile>();
  vol::ChunkCache cache(3000); // of one chunk, and of the next while it is read
  std::vector<vol::ChunkCache::Chunk> held;
  std::vector<const std::byte*> places;
  for (int chunk = 0; chunk < SlowFile::Bad; ++chunk)
  {
    const auto bytes = cache.Get({ file, 0, 0 }, bricks::Index3(chunk, 0, 0));
    places.push_back(bytes->data());
    if (chunk % 3 == 0)
    {
      held.push_back(bytes);
    }
  }
  for (std::size_t chunk = 0; chunk < held.size(); ++chunk)
  {
    EXPECT_EQ(std::count(held[chunk]->begin(), held[chunk]->end(), std::byte(3 * chunk)), 1000);
  }
  std::sort(places.begin(), places.end());
  EXPECT_NE(std::adjacent_find(places.begin(), places.end()), places.end())
    << "no memory was used again";
}

/// Who does not wait fails alone: not those who wait for the same chunk.
TEST(ChunkCache, OthersAreNotToldThatAThreadWouldWait)
{
  const auto file = std::make_shared<ColdFile>();
  vol::ChunkCache cache(1 << 20);
  std::vector<std::thread> threads;
  std::atomic<int> wouldWait{ 0 };
  std::atomic<int> read{ 0 };
  for (int thread = 0; thread < 8; ++thread)
  {
    threads.emplace_back(
      [&, thread]
      {
        std::optional<vol::WithoutWaiting> scope;
        if (thread % 2 == 0)
        {
          scope.emplace();
        }
        try
        {
          read += cache.Get({ file, 0, 0 }, bricks::Index3(0))->back() == std::byte(7) ? 1 : 0;
        }
        catch (const vol::WouldWait&)
        {
          wouldWait += scope ? 1 : 100;
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(read + wouldWait, 8);
  EXPECT_GE(read, 4);
  const vol::WithoutWaiting scope;
  EXPECT_EQ(cache.Get({ file, 0, 0 }, bricks::Index3(0))->back(), std::byte(7)) << "it is here now";
}

TEST(ChunkGrid, AChunkAndItsHaloAreTheBoxOfABrick)
{
  const vol::ChunkGrid grid{ { 9, 5, 4 }, { 4, 4, 4 } };
  for (std::int64_t number = 0; number < grid.GetCount(); ++number)
  {
    const bricks::Index3 chunk = grid.GetChunk(number);
    const bricks::Box all = grid.GetBoxWithHalo(chunk);
    std::vector<std::byte> seen(static_cast<std::size_t>(all.GetCount()), std::byte(0));
    std::int64_t count = 0;
    const auto add = [&](const bricks::Box& box)
    {
      const std::vector<std::byte> ones(static_cast<std::size_t>(box.GetCount()), std::byte(1));
      vol::CopyBox(box, ones.data(), box, seen.data(), all, 1);
      count += box.GetCount();
    };
    add(grid.GetBox(chunk));
    for (const bricks::Box& part : grid.GetHalo(chunk))
    {
      add(part);
    }
    EXPECT_EQ(count, all.GetCount());
    EXPECT_EQ(std::count(seen.begin(), seen.end(), std::byte(1)), all.GetCount());
  }
}

TEST(ChunkCodec, ShuffledElementsOfEveryWidthComeBack)
{
  for (const std::size_t width : { 1, 2, 3, 4, 7, 8, 16 })
  {
    const vol::ChunkCodec codec({ { "shuffle", width } });
    vol::ByteBuffer samples(100 * width + width / 2); // and some bytes of one more
    for (std::size_t place = 0; place < samples.size(); ++place)
    {
      samples[place] = std::byte(place * place % 251);
    }
    const vol::ByteBuffer stored = codec.Encode(samples);
    EXPECT_EQ(stored[1], samples[width]) << width;
    vol::ByteBuffer found(samples.size());
    EXPECT_TRUE(codec.Decode(stored, 0, found.data(), found.size()));
    EXPECT_EQ(found, samples) << width;
  }
}

template <class Decoded, class Encoded>
std::vector<Decoded> DecodeNumbers(
  const char* codec, const vol::CodecParameters& with, const std::vector<Encoded>& encoded)
{
  vol::ByteBuffer stored(encoded.size() * sizeof(Encoded));
  std::memcpy(stored.data(), encoded.data(), stored.size());
  std::vector<Decoded> found(encoded.size());
  vol::ChunkCodec({ vol::CodecStep(vol::FindCodec(codec), with) })
    .Decode(std::move(stored), 0, reinterpret_cast<std::byte*>(found.data()),
      found.size() * sizeof(Decoded));
  return found;
}

/// The numbers are numcodecs'.
TEST(ChunkCodec, NumbersAreConvertedAsNumPyDoesIt)
{
  using Type = bricks::ScalarType;
  const auto scaled = [](Type decoded, Type encoded, double scale, double offset) {
    return vol::CodecParameters{ 1, { decoded }, { encoded }, scale, offset };
  };
  const char* const fixed = "fixedscaleoffset";
  EXPECT_EQ((DecodeNumbers<float, std::int16_t>(
              fixed, scaled(Type::Float32, Type::Int16, 3, 0.1), { 1, 2, -7 })),
    (std::vector<float>{ 0x1.bbbbbcp-2f, 0x1.888888p-1f, -0x1.1ddddep+1f }));
  EXPECT_EQ((DecodeNumbers<float, float>(
              fixed, scaled(Type::Float32, Type::Float32, 3, 0.1), { 1, 2, -7 })),
    (std::vector<float>{ 0x1.bbbbbcp-2f, 0x1.88888ap-1f, -0x1.1ddddep+1f }));
  EXPECT_EQ((DecodeNumbers<std::int32_t, std::uint8_t>(
              fixed, scaled(Type::Int32, Type::UInt8, 0.3, -1000.7), { 1, 2, 200 })),
    (std::vector<std::int32_t>{ -997, -994, -334 }));
  EXPECT_EQ((DecodeNumbers<std::uint8_t, std::int8_t>(
              "delta", { 1, { Type::UInt8 }, { Type::Int8 } }, { 100, 100, 100, -5 })),
    (std::vector<std::uint8_t>{ 100, 200, 44, 39 }));
  EXPECT_EQ((DecodeNumbers<float, float>(
              "delta", { 1, { Type::Float32 }, { Type::Float32 } }, { 1e8f, 1, 1, -5 })),
    (std::vector<float>{ 1e8f, 1e8f, 1e8f, 99999992.0f }));
  EXPECT_EQ((DecodeNumbers<float, double>(
              "delta", { 1, { Type::Float32 }, { Type::Float64 } }, { 1e8, 1, 1, -5 })),
    (std::vector<float>{ 1e8f, 1e8f, 1e8f, 1e8f }));
  EXPECT_EQ((DecodeNumbers<std::int16_t, double>(
              "astype", { 1, { Type::Int16 }, { Type::Float64 } }, { -1.9, 2.9, 32769.0, 1e300 })),
    (std::vector<std::int16_t>{ -1, 2, -32767, 0 }));
}

/// What does not shrink grows, by what the compression needs for itself.
TEST(ChunkCodec, WhatIsPackedAgainComesBack)
{
  std::mt19937 random;
  for (const std::size_t bytes : { 1, 100, 100000 })
  {
    vol::ByteBuffer samples(bytes);
    std::generate(samples.begin(), samples.end(), [&] { return std::byte(random() & 0xff); });
    for (const auto& kinds : { std::vector<const char*>{ "deflate", "zstd" },
           std::vector<const char*>{ "zstd", "fletcher32", "deflate", "zstd" } })
    {
      std::vector<vol::CodecStep> steps;
      std::transform(kinds.begin(), kinds.end(), std::back_inserter(steps),
        [](const char* kind) { return vol::CodecStep{ kind }; });
      vol::ChunkCodec codec;
      try
      {
        codec = vol::ChunkCodec(steps);
      }
      catch (const dsm::Error& error)
      {
        GTEST_SKIP() << error.what();
      }
      vol::ByteBuffer found(bytes);
      EXPECT_TRUE(codec.Decode(codec.Encode(samples), 0, found.data(), found.size()));
      EXPECT_EQ(found, samples);
    }
  }
}

class ChunkCodecHalo : public testing::TestWithParam<const char*>
{
};

INSTANTIATE_TEST_SUITE_P(Compressions, ChunkCodecHalo, testing::Values("zstd", "deflate"));

TEST_P(ChunkCodecHalo, ComesBackWhereThereIsOne)
{
  vol::ChunkCodec codec;
  try
  {
    codec = vol::ChunkCodec({ { "shuffle", 4 }, { this->GetParam() }, { "fletcher32" } });
  }
  catch (const dsm::Error& error)
  {
    GTEST_SKIP() << error.what();
  }
  EXPECT_TRUE(codec.KeepsHalo());
  EXPECT_FALSE(vol::ChunkCodec({ { "fletcher32" } }).KeepsHalo());
  vol::ByteBuffer samples(64 * 4);
  vol::ByteBuffer halo(61 * 4);
  const auto number = [](std::size_t place) { return std::byte(place * place % 251); };
  for (std::size_t place = 0; place < samples.size(); ++place)
  {
    samples[place] = number(place);
  }
  for (std::size_t place = 0; place < halo.size(); ++place)
  {
    halo[place] = number(place + 1000);
  }
  const vol::ByteBuffer stored = codec.Encode(samples, halo);
  vol::ByteBuffer found(samples.size());
  EXPECT_TRUE(codec.Decode(stored, 0, found.data(), found.size()));
  EXPECT_EQ(found, samples) << "without asking for it";
  vol::ByteBuffer back(halo.size());
  EXPECT_TRUE(codec.Decode(stored, 0, found.data(), found.size(), &back));
  EXPECT_EQ(found, samples);
  EXPECT_EQ(back, halo);
  vol::ByteBuffer shorter(halo.size() + 4);
  EXPECT_FALSE(codec.Decode(stored, 0, found.data(), found.size(), &shorter));
  EXPECT_FALSE(codec.Decode(codec.Encode(samples), 0, found.data(), found.size(), &back));
  for (std::size_t place = 0; place < stored.size(); place += 7)
  {
    vol::ByteBuffer damaged = stored;
    damaged[place] ^= std::byte(0x20);
    EXPECT_THROW(codec.Decode(damaged, 0, found.data(), found.size(), &back), dsm::Error);
  }
}

TEST(HaloRecord, IsToldFromAnythingElse)
{
  const std::size_t bytes = vol::HaloRecord::GetBytes(61 * 4);
  for (const std::size_t size : { 0, 3, 61 * 4 })
  {
    SCOPED_TRACE(size);
    vol::ByteBuffer halo(size);
    for (std::size_t place = 0; place < size; ++place)
    {
      halo[place] = std::byte(place * place % 251);
    }
    const vol::ByteBuffer record = vol::HaloRecord::Make(77, halo, bytes);
    ASSERT_EQ(record.size(), bytes);
    vol::ByteBuffer found(size);
    EXPECT_TRUE(vol::HaloRecord::Take(record.data(), bytes, 77, found));
    EXPECT_EQ(found, halo);
    EXPECT_FALSE(vol::HaloRecord::Take(record.data(), bytes, 78, found)) << "of another chunk";
    EXPECT_FALSE(vol::HaloRecord::Take(record.data(), bytes - 4, 77, found));
    for (std::size_t place = 0; place < bytes; ++place)
    {
      vol::ByteBuffer damaged = record;
      damaged[place] ^= std::byte(0x20);
      EXPECT_FALSE(vol::HaloRecord::Take(damaged.data(), bytes, 77, found)) << place;
    }
    EXPECT_EQ(found, halo) << "it is as it was";
    found.resize(size + 1);
    EXPECT_FALSE(vol::HaloRecord::Take(record.data(), bytes, 77, found));
  }
}

template <class T>
vol::ValueRanges FindRangesOf(const std::vector<T>& values, bricks::ScalarType type)
{
  vol::FileArray array;
  array.Type = type;
  const bricks::Box box{ bricks::Index3(0),
    bricks::Index3(static_cast<std::int64_t>(values.size()), 1, 1) };
  array.Grid = { box.Max, box.Max };
  vol::ValueRanges ranges(1);
  ranges.Add(array, reinterpret_cast<const std::byte*>(values.data()), box, box);
  return ranges;
}

TEST(ValueRanges, OfRowsOfAnyLength)
{
  for (std::size_t count = 1; count < 70; ++count)
  {
    for (std::size_t place = 0; place < count; place += 3)
    {
      std::vector<float> floats(count, 2.5f);
      std::vector<std::uint8_t> bytes(count, 100);
      floats[place] = -7.5f;
      floats[count - 1 - place] = place == count - 1 - place ? -7.5f : 9.0f;
      bytes[place] = 250;
      const vol::ValueRange all = FindRangesOf(floats, bricks::ScalarType::Float32).All[0];
      EXPECT_EQ(all.Least, -7.5) << count << ", " << place;
      EXPECT_EQ(all.Greatest, *std::max_element(floats.begin(), floats.end()));
      const vol::ValueRange small = FindRangesOf(bytes, bricks::ScalarType::UInt8).Finite[0];
      EXPECT_EQ(small.Least, count == 1 ? 250.0 : 100.0);
      EXPECT_EQ(small.Greatest, 250.0);
    }
  }
}

TEST(ValueRanges, WhatIsNotFiniteIsToldApart)
{
  const double infinite = std::numeric_limits<double>::infinity();
  for (std::size_t place = 0; place < 20; ++place)
  {
    std::vector<double> values(20, 4.0);
    values[(place + 5) % 20] = 3.0;
    values[place] = std::numeric_limits<double>::quiet_NaN();
    const vol::ValueRanges numbers = FindRangesOf(values, bricks::ScalarType::Float64);
    EXPECT_EQ(numbers.All[0].Least, 3.0) << place;
    EXPECT_EQ(numbers.All[0].Greatest, 4.0);
    values[place] = -infinite;
    const vol::ValueRanges ranges = FindRangesOf(values, bricks::ScalarType::Float64);
    EXPECT_EQ(ranges.All[0].Least, -infinite);
    EXPECT_EQ(ranges.Finite[0].Least, 3.0);
    EXPECT_EQ(ranges.Finite[0].Greatest, 4.0);
  }
  EXPECT_TRUE(FindRangesOf(
    std::vector<double>(3, std::numeric_limits<double>::quiet_NaN()), bricks::ScalarType::Float64)
                .All[0]
                .IsEmpty());
}

} // namespace
