// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/range/ValueRanges.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/layout/LaneRanges.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/range/KeptFile.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace vol
{

namespace
{

/// Kind of the kept file, with the version of its layout.
constexpr const char* Kind = "ranges4";

void Add(ValueRanges& ranges, std::size_t number, double value)
{
  if (std::isnan(value))
  {
    return;
  }
  ranges.All[number].Add(value);
  if (std::isfinite(value))
  {
    ranges.Finite[number].Add(value);
  }
}

/// The range of numbers that all are finite, found for many at a time. False when one is not.
template <class T>
bool FindFinite(const T* values, std::int64_t count, T& least, T& greatest)
{
  constexpr int lanes = 64 / sizeof(T);
  T low[lanes];
  T high[lanes];
  T check[lanes] = {};
  std::fill_n(low, lanes, values[0]);
  std::fill_n(high, lanes, values[0]);
  std::int64_t at = 0;
  for (; at + lanes <= count; at += lanes)
  {
    bricks::AddToLanes(values + at, lanes, low, high, check);
  }
  bricks::AddToLanes(values + at, static_cast<int>(count - at), low, high, check);
  least = *std::min_element(low, low + lanes);
  greatest = *std::max_element(high, high + lanes);
  return std::all_of(check, check + lanes, [](T one) { return one == T{ 0 }; });
}

template <class T>
void AddRow(ValueRanges& ranges, const T* row, std::int64_t samples, const FileArray& array)
{
  const int components = array.Components;
  // Missing floating point numbers are NaN already.
  const bool hasMissing = std::is_integral_v<T> && array.Valid.Exclude(array.Type);
  const bricks::MissingTest<T> isMissing(array.Valid);
  T least;
  T greatest;
  if (!hasMissing && components == 1 && samples > 0 && FindFinite(row, samples, least, greatest))
  {
    for (ValueRange* range : { &ranges.All.front(), &ranges.Finite.front() })
    {
      range->Add(static_cast<double>(least));
      range->Add(static_cast<double>(greatest));
    }
    return;
  }
  for (std::int64_t sample = 0; sample < samples; ++sample)
  {
    double sum = 0.0;
    for (int component = 0; component < components; ++component)
    {
      const T stored = row[sample * components + component];
      const auto value = hasMissing && isMissing(stored) ? std::numeric_limits<double>::quiet_NaN()
                                                         : static_cast<double>(stored);
      Add(ranges, static_cast<std::size_t>(component), value);
      sum += value * value;
    }
    if (components > 1)
    {
      Add(ranges, static_cast<std::size_t>(components), std::sqrt(sum));
    }
  }
}

/// Divides the room of the shared cache among as many threads as it suffices for: each needs a
/// chunk, and the chunk's stored bytes.
class Room
{
public:
  Room(const FileArray& array, int threads)
    : Threads(std::max(1, threads))
  {
    const bricks::Index3 samples = glm::min(array.Grid.ChunkSamples, array.Grid.Samples);
    // A product that does not fit 64 bits exceeds the room, too.
    const std::uint64_t most = FileLimits::ArrayBytes / this->GetThreads();
    const std::size_t each = MultiplyWithin(most,
      { 2, array.GetSampleBytes(),
        static_cast<std::uint64_t>(bricks::Box{ bricks::Index3(0), samples }.GetCount()) })
                               .value_or(most);
    bool isLent = false;
    while (
      !(isLent = ChunkCache::GetShared().Lend(each * this->GetThreads(), 1)) && this->Threads > 1)
    {
      this->Threads /= 2;
    }
    this->Bytes = isLent ? each * this->GetThreads() : 0;
  }
  ~Room() { ChunkCache::GetShared().Return(this->Bytes); }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  std::size_t GetThreads() const { return static_cast<std::size_t>(this->Threads); }

private:
  int Threads;
  std::size_t Bytes = 0;
};

} // namespace

ValueRanges::ValueRanges(int components)
  : All(static_cast<std::size_t>(components > 1 ? components + 1 : 1))
  , Finite(this->All.size())
{
}

bool ValueRanges::IsValid(bricks::ScalarType type) const
{
  const auto [lowest, highest] = bricks::Dispatch(type,
    [](auto zero)
    {
      using T = decltype(zero);
      const bool hasInfinity = std::numeric_limits<T>::has_infinity;
      return hasInfinity
        ? std::pair<double, double>(-HUGE_VAL, HUGE_VAL)
        : std::pair<double, double>(static_cast<double>(std::numeric_limits<T>::lowest()),
            static_cast<double>(std::numeric_limits<T>::max()));
    });
  const auto isRange = [](const ValueRange& range, double least, double greatest)
  {
    const ValueRange none;
    return (range.Least == none.Least && range.Greatest == none.Greatest) ||
      (range.Least >= least && range.Least <= range.Greatest && range.Greatest <= greatest);
  };
  constexpr double finite = std::numeric_limits<double>::max();
  for (std::size_t index = 0; index < this->All.size(); ++index)
  {
    // The magnitude of vectors may exceed the type of their components.
    const bool isMagnitude = this->All.size() > 1 && index + 1 == this->All.size();
    const ValueRange& all = this->All[index];
    if (!isRange(all, isMagnitude ? 0.0 : lowest, isMagnitude ? HUGE_VAL : highest) ||
      !isRange(this->Finite[index], std::max(all.Least, -finite), std::min(all.Greatest, finite)))
    {
      return false;
    }
  }
  return true;
}

void ValueRanges::Add(const ValueRanges& other)
{
  for (std::size_t index = 0; index < this->All.size(); ++index)
  {
    this->All[index].Add(other.All[index]);
    this->Finite[index].Add(other.Finite[index]);
  }
}

void ValueRanges::Add(const FileArray& array, const std::byte* samples, const bricks::Box& have,
  const bricks::Box& want)
{
  bricks::Dispatch(array.Type,
    [&](auto zero)
    {
      const auto* values = reinterpret_cast<const decltype(zero)*>(samples);
      const bricks::Index3 size = have.GetSize();
      if (want.Min == have.Min && want.Max == have.Max)
      {
        AddRow(*this, values, have.GetCount(), array);
        return;
      }
      for (std::int64_t z = want.Min.z; z < want.Max.z; ++z)
      {
        for (std::int64_t y = want.Min.y; y < want.Max.y; ++y)
        {
          const std::int64_t first =
            ((z - have.Min.z) * size.y + y - have.Min.y) * size.x + want.Min.x - have.Min.x;
          AddRow(*this, values + first * array.Components, want.GetSize().x, array);
        }
      }
    });
}

std::optional<ValueRanges> FindRanges(const ArrayStep& of, const bricks::Box& box, int threads,
  const std::function<bool(double)>& goesOn)
{
  const FileArray& array = of.Get();
  const bricks::Box chunks = array.Grid.GetChunks(box);
  const Room room(array, threads);
  std::vector<ValueRanges> parts(room.GetThreads(), ValueRanges(array.Components));
  std::vector<ByteBuffer> buffers(parts.size());
  std::vector<char> hasFill(parts.size(), 0);
  std::atomic<std::int64_t> done{ 0 };
  std::atomic<bool> stopped{ false };
  bricks::ParallelFor(static_cast<int>(parts.size()), static_cast<std::size_t>(chunks.GetCount()),
    [&](std::size_t index, int thread)
    {
      if (stopped)
      {
        return;
      }
      const bricks::Index3 chunk =
        chunks.Min + ChunkGrid{ chunks.GetSize() }.GetChunk(static_cast<std::int64_t>(index));
      const bricks::Box have = array.Grid.GetBox(chunk);
      // The fill value counts once.
      const bool isFill = of.File->IsFill(of.Array, of.Step, have);
      if (!isFill || !hasFill[static_cast<std::size_t>(thread)])
      {
        ByteBuffer& samples = buffers[static_cast<std::size_t>(thread)];
        samples.resize(static_cast<std::size_t>(have.GetCount()) * array.GetSampleBytes());
        of.File->ReadChunk(of.Array, of.Step, chunk, samples.data());
        parts[static_cast<std::size_t>(thread)].Add(
          array, samples.data(), have, bricks::Intersect(have, box));
        hasFill[static_cast<std::size_t>(thread)] |= isFill ? 1 : 0;
      }
      ++done;
      if (thread == 0 &&
        !goesOn(static_cast<double>(done) / static_cast<double>(chunks.GetCount())))
      {
        stopped = true;
      }
    });
  if (stopped)
  {
    return std::nullopt;
  }
  ValueRanges ranges = parts.front();
  for (const ValueRanges& part : parts)
  {
    ranges.Add(part);
  }
  return ranges;
}

namespace
{

/// Returns the ranges of all of the array, if the file has them.
std::optional<ValueRanges> ReadOwn(const ArrayStep& of)
{
  ValueRanges ranges(of.Get().Components);
  const std::vector<double> own = of.File->ReadIndex(of.Array, of.Step).Ranges;
  if (own.size() != 4 * ranges.All.size())
  {
    return std::nullopt;
  }
  for (std::size_t index = 0; index < ranges.All.size(); ++index)
  {
    ranges.All[index] = { own[4 * index], own[4 * index + 1] };
    ranges.Finite[index] = { own[4 * index + 2], own[4 * index + 3] };
  }
  return ranges.IsValid(of.Get().Type) ? std::optional<ValueRanges>(std::move(ranges))
                                       : std::nullopt;
}

std::optional<ValueRanges> LoadKept(const ArrayStep& of, const bricks::Box& box)
{
  ValueRanges ranges(of.Get().Components);
  const std::size_t list = ranges.All.size() * sizeof(ValueRange);
  const std::vector<std::byte> kept = KeptFile(of, box, Kind).Load(2 * list);
  if (kept.empty())
  {
    return std::nullopt;
  }
  std::memcpy(ranges.All.data(), kept.data(), list);
  std::memcpy(ranges.Finite.data(), kept.data() + list, list);
  return ranges.IsValid(of.Get().Type) ? std::optional<ValueRanges>(std::move(ranges))
                                       : std::nullopt;
}

/// Adds the part of `box` outside of `other`, as disjoint boxes.
void AddOutside(bricks::Box box, const bricks::Box& other, std::vector<bricks::Box>& out)
{
  for (int axis = 0; axis < 3 && !box.IsEmpty(); ++axis)
  {
    bricks::Box below = box;
    bricks::Box above = box;
    below.Max[axis] = std::min(box.Max[axis], other.Min[axis]);
    above.Min[axis] = std::max(box.Min[axis], other.Max[axis]);
    for (const bricks::Box& beside : { below, above })
    {
      if (!beside.IsEmpty())
      {
        out.push_back(beside);
      }
    }
    box.Min[axis] = std::max(box.Min[axis], other.Min[axis]);
    box.Max[axis] = std::min(box.Max[axis], other.Max[axis]);
  }
}

/// Merges kept boxes, the smallest first, that together cover a box; returns nothing if they do
/// not.
std::optional<ValueRanges> LoadCovering(const ArrayStep& of, const bricks::Box& box)
{
  std::vector<bricks::Box> boxes = KeptFile::FindBoxes(of, Kind);
  std::sort(boxes.begin(), boxes.end(),
    [](const bricks::Box& a, const bricks::Box& b) { return a.GetCount() < b.GetCount(); });
  ValueRanges ranges(of.Get().Components);
  std::vector<bricks::Box> left{ box };
  for (const bricks::Box& one : boxes)
  {
    const auto meets = [&](const bricks::Box& part)
    { return !bricks::Intersect(part, one).IsEmpty(); };
    const std::optional<ValueRanges> kept =
      std::any_of(left.begin(), left.end(), meets) ? LoadKept(of, one) : std::nullopt;
    if (kept)
    {
      ranges.Add(*kept);
      std::vector<bricks::Box> outside;
      for (const bricks::Box& part : left)
      {
        AddOutside(part, one, outside);
      }
      left = std::move(outside);
    }
  }
  return left.empty() ? std::optional<ValueRanges>(std::move(ranges)) : std::nullopt;
}

} // namespace

std::optional<ValueRanges> LoadRanges(const ArrayStep& of, const bricks::Box& box, bool isShare)
{
  std::optional<ValueRanges> ranges;
  if (isShare || of.Get().Grid.IsWhole(box))
  {
    ranges = ReadOwn(of);
  }
  if (!ranges)
  {
    ranges = LoadKept(of, box);
  }
  if (!ranges && isShare)
  {
    ranges = LoadCovering(of, box);
  }
  return ranges;
}

void KeepRanges(const ArrayStep& of, const bricks::Box& box, const ValueRanges& ranges)
{
  const std::size_t list = ranges.All.size() * sizeof(ValueRange);
  std::vector<std::byte> bytes(2 * list);
  std::memcpy(bytes.data(), ranges.All.data(), list);
  std::memcpy(bytes.data() + list, ranges.Finite.data(), list);
  KeptFile(of, box, Kind).Keep(bytes.data(), bytes.size());
}

} // namespace vol
