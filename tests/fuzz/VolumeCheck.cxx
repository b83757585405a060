// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeCheck.h"

#include "InputFolder.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CopyBox.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"
#include "DSMVolumeFiles/range/ValueRanges.h"
#include "IndexCheck.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace fuzz
{

namespace
{

constexpr std::uint64_t MostChunkBytes = std::uint64_t(4) << 20;
/// More arrays of a file are not looked at.
constexpr std::size_t MostArrays = 4;

void Require(bool holds, const std::string& what)
{
  if (!holds)
  {
    Fail(what);
  }
}

/// Calls what may throw dsm::Error; returns whether it did not. The text must contain one of `names`.
template <class Call>
bool Try(const std::vector<std::string>& names, const Call& call)
{
  try
  {
    call();
    return true;
  }
  catch (const dsm::Error& error)
  {
    const std::string text = error.what();
    const bool isNamed = std::any_of(names.begin(), names.end(),
      [&](const std::string& name) { return text.find(name) != std::string::npos; });
    Require(isNamed, "this error does not name the file: " + text);
    return false;
  }
}

/// Bytes to be read to, with others behind them that must stay as they are.
class Guarded
{
public:
  Guarded(std::size_t bytes, int filler)
    : Count(bytes)
    , Bytes(bytes + Guard, static_cast<std::byte>(filler))
    , Filler(static_cast<std::byte>(filler))
  {
  }
  std::byte* Get() { return this->Bytes.data(); }
  const std::byte* Get() const { return this->Bytes.data(); }
  void Check() const
  {
    const auto end = this->Bytes.begin() + static_cast<std::ptrdiff_t>(this->Count);
    Require(std::all_of(end, this->Bytes.end(), [&](std::byte one) { return one == this->Filler; }),
      "bytes behind the samples were written");
  }
  bool operator==(const Guarded& other) const
  {
    return std::memcmp(this->Get(), other.Get(), this->Count) == 0;
  }

private:
  static constexpr std::size_t Guard = 64;
  std::size_t Count;
  std::vector<std::byte> Bytes;
  std::byte Filler;
};

class ChunkCheck
{
public:
  ChunkCheck(
    const vol::VolumeFile& file, std::vector<std::string> names, std::size_t array, int step)
    : File(file)
    , Names(std::move(names))
    , Array(array)
    , Step(step)
    , Grid(file.GetArrays()[array].Grid)
    , SampleBytes(file.GetArrays()[array].GetSampleBytes())
  {
  }

  void Check(const bricks::Index3& chunk) const
  {
    const bricks::Box box = this->Grid.GetBox(chunk);
    const bricks::Box halo = this->Grid.GetBoxWithHalo(chunk);
    const long double most = static_cast<long double>(MostChunkBytes) / this->SampleBytes;
    const bricks::Index3 size = halo.GetSize();
    if (static_cast<long double>(size.x) * size.y * size.z > most)
    {
      return;
    }
    const std::size_t bytes = static_cast<std::size_t>(box.GetCount()) * this->SampleBytes;
    Guarded samples(bytes, 0x5a);
    const bool isRead = Try(
      this->Names, [&] { this->File.ReadChunk(this->Array, this->Step, chunk, samples.Get()); });
    samples.Check();
    if (isRead)
    {
      Guarded again(bytes, 0xa5);
      this->File.ReadChunk(this->Array, this->Step, chunk, again.Get());
      Require(samples == again, "some samples of a chunk are not set, or differ when read again");
    }
    this->CheckPart(chunk, box, isRead ? &samples : nullptr);
    this->CheckHalo(chunk, box, halo, isRead ? &samples : nullptr);
    Try(this->Names, [&] { this->File.Prefetch(this->Array, this->Step, { { chunk, box } }); });
  }

private:
  /// `samples`: of the chunk, null where it cannot be read.
  void CheckPart(const bricks::Index3& chunk, const bricks::Box& box, const Guarded* samples) const
  {
    const bricks::Index3 half = (box.GetSize() + bricks::Index3(1)) / std::int64_t(2);
    const bricks::Box part{ box.Max - half, box.Max };
    const std::size_t bytes = static_cast<std::size_t>(part.GetCount()) * this->SampleBytes;
    Guarded read(bytes, 0x5a);
    bool isThere = false;
    Try(this->Names,
      [&] { isThere = this->File.ReadPart(this->Array, this->Step, chunk, part, read.Get()); });
    read.Check();
    if (isThere && samples)
    {
      Guarded expected(bytes, 0xa5);
      vol::CopyBox(part, samples->Get(), box, expected.Get(), part, this->SampleBytes);
      Require(read == expected, "a part of a chunk has other values than the chunk");
    }
  }

  void CheckHalo(const bricks::Index3& chunk, const bricks::Box& box, const bricks::Box& halo,
    const Guarded* samples) const
  {
    Guarded read(static_cast<std::size_t>(halo.GetCount()) * this->SampleBytes, 0x5a);
    bool isThere = false;
    Try(this->Names,
      [&] { isThere = this->File.ReadWithHalo(this->Array, this->Step, chunk, read.Get()); });
    read.Check();
    if (isThere && samples)
    {
      const std::size_t bytes = static_cast<std::size_t>(box.GetCount()) * this->SampleBytes;
      Guarded own(bytes, 0xa5);
      vol::CopyBox(box, read.Get(), halo, own.Get(), box, this->SampleBytes);
      Require(own == *samples, "a chunk with its halo has other values than the chunk");
    }
  }

  const vol::VolumeFile& File;
  std::vector<std::string> Names;
  std::size_t Array;
  int Step;
  const vol::ChunkGrid& Grid;
  std::size_t SampleBytes;
};

void CheckArrays(const vol::VolumeFile& file)
{
  const std::vector<vol::FileArray>& arrays = file.GetArrays();
  const bricks::Index3 points = file.GetGeometry().Points;
  const bricks::Index3 cells = glm::max(points - bricks::Index3(1), bricks::Index3(1));
  Require(!arrays.empty(), "the file has no arrays");
  for (const vol::FileArray& array : arrays)
  {
    const bricks::Index3& samples = array.Grid.Samples;
    Require(array.Components >= 1, "an array has no components");
    Require(glm::all(glm::greaterThan(samples, bricks::Index3(0))) &&
        glm::all(glm::greaterThan(array.Grid.ChunkSamples, bricks::Index3(0))),
      "an array, or its chunks, have no samples");
    Require(
      samples == (array.OnCells ? cells : points), "an array has another shape than the file");
    Require(array.Grid.GetCount() > 0, "the number of chunks is not positive");
  }
}

void CheckTimes(const vol::VolumeFile& file)
{
  Require(file.GetSteps() >= 1 && file.GetLevels() >= 1, "the file has no steps, or no levels");
  for (int step = 1; step < file.GetSteps(); ++step)
  {
    Require(file.GetTime(step - 1) < file.GetTime(step), "the times of the steps do not ascend");
  }
}

void CheckGeometry(const vol::FileGeometry& geometry)
{
  const auto areFinite = [](const double* numbers, std::size_t count)
  { return std::all_of(numbers, numbers + count, [](double one) { return std::isfinite(one); }); };
  Require(areFinite(geometry.Origin, 3) && areFinite(geometry.Spacing, 3) &&
      areFinite(geometry.Direction, 9),
    "the geometry has a number that is not finite");
  // VTK's indices are int.
  const auto areInt = [](const bricks::Index3& indices)
  {
    return glm::all(
             glm::greaterThanEqual(indices, bricks::Index3(std::numeric_limits<int>::min()))) &&
      glm::all(glm::lessThanEqual(indices, bricks::Index3(std::numeric_limits<int>::max())));
  };
  Require(areInt(geometry.First) && areInt(geometry.Points) &&
      areInt(geometry.First + geometry.Points - bricks::Index3(1)),
    "indices of points are beyond those that VTK has");
}

void CheckValues(const vol::ArrayStep& of, const std::vector<std::string>& names)
{
  const vol::VolumeFile& file = *of.File;
  const vol::ChunkGrid& grid = of.Get().Grid;
  const ChunkCheck check(file, names, of.Array, of.Step);
  const bricks::Index3 last = grid.GetCounts() - bricks::Index3(1);
  const auto isLess = [](const bricks::Index3& a, const bricks::Index3& b)
  { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); };
  std::set<bricks::Index3, decltype(isLess)> chunks(isLess);
  for (const bricks::Index3& chunk : { bricks::Index3(0), last / std::int64_t(2), last,
         bricks::Index3(0, last.y, last.z / 2), glm::min(last, bricks::Index3(1)) })
  {
    chunks.insert(chunk);
  }
  for (const bricks::Index3& chunk : chunks)
  {
    check.Check(chunk);
  }
  Try(names, [&] { CheckIndex(of.Get(), file.ReadIndex(of.Array, of.Step)); });
  const bricks::Box whole{ bricks::Index3(0), grid.Samples };
  Try(names, [&] { vol::LoadRanges(of, whole, true); });
}

} // namespace

int CheckVolume(const std::filesystem::path& path, const vol::OpenOptions& options)
{
  const std::string name = path.filename().string();
  std::shared_ptr<const vol::VolumeFile> file;
  vol::MayBeVolumeFile(path.string());
  vol::IsBareFile(path.string());
  // What is wrong may be in another file of the same folder.
  const std::vector<std::string> names{ name, GetInputFolder().string() };
  if (!Try(names, [&] { file = vol::OpenVolumeFile(path.string(), options); }))
  {
    return 0;
  }
  CheckTimes(*file);
  CheckArrays(*file);
  CheckGeometry(file->GetGeometry());
  file->GetTableBytes();
  const int lastStep = file->GetSteps() - 1;
  Try(names, [&] { vol::FindStamp(path.string(), options); });
  for (const int step : std::set<int>{ 0, lastStep })
  {
    Try(names, [&] { file->GetFiles(step); });
    Try(names, [&] { file->GetOrigin(step); });
    for (std::size_t array = 0; array < std::min(MostArrays, file->GetArrays().size()); ++array)
    {
      CheckValues({ file, array, step }, names);
    }
  }
  return file->GetLevels();
}

void CheckLevels(const std::filesystem::path& path)
{
  const int levels = CheckVolume(path);
  if (levels > 1)
  {
    vol::OpenOptions coarsest;
    coarsest.Level = levels - 1;
    CheckVolume(path, coarsest);
  }
}

} // namespace fuzz
