// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFileValues.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/FreedMemory.h"
#include "DSMVolumeFiles/base/Url.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include "vtkMultiProcessController.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <thread>
#include <utility>

namespace
{

/// Samples that are all read to find what values there are: of a file on a disk, and on a server. Then those of a
/// coarser level.
constexpr std::int64_t MostOnDisk = std::int64_t(1) << 28;
constexpr std::int64_t MostOnServer = std::int64_t(1) << 22;
constexpr std::int64_t MostOfCoarser = std::int64_t(1) << 22;

std::int64_t CountSamples(const vol::FileArray& array)
{
  return bricks::Box{ bricks::Index3(0), array.Grid.Samples }.GetCount();
}

/// This rank's share of the host's cores. Not collective, so how many ranks the host has is what their launcher says;
/// else all of them may be here.
int GetThreads()
{
  vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
  int ranks = controller ? controller->GetNumberOfProcesses() : 1;
  for (const char* name : { "OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS" })
  {
    const char* const text = std::getenv(name);
    const int here = text ? std::atoi(text) : 0;
    ranks = here > 0 ? std::min(ranks, here) : ranks;
  }
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / std::max(1, ranks));
}

} // namespace

vtkDSMFileValues::vtkDSMFileValues(std::shared_ptr<const vol::VolumeFile> file, std::size_t array,
  int step, const bricks::Box& box, int nextStep, vol::OpenOptions options)
  : Of{ std::move(file), array, step }
  , NextStep(nextStep)
  , Box(box)
  , Options(std::move(options))
{
}

void vtkDSMFileValues::ReadBox(const bricks::Box& box, std::byte* out) const
{
  vol::ChunkCache::GetShared().ReadBox(
    this->Of, { box.Min + this->Box.Min, box.Max + this->Box.Min }, out);
}

std::shared_ptr<vtkDSMFileValues> vtkDSMFileValues::OpenCoarser(int level) const
{
  if (level > this->CountCoarser())
  {
    return nullptr;
  }
  const vol::FileArray& array = this->GetArray();
  vol::OpenOptions options = this->Options;
  options.Level += level;
  options.OpenedAt = this->Of.File->GetTimeOpened();
  const auto file = vol::OpenCachedVolume(this->Of.File->GetPaths(), options);
  const auto& arrays = file->GetArrays();
  const auto found = std::find_if(arrays.begin(), arrays.end(),
    [&](const vol::FileArray& one)
    {
      return one.Name == array.Name && one.OnCells == array.OnCells && one.Type == array.Type &&
        one.Components == array.Components && one.Valid == array.Valid;
    });
  if (found == arrays.end() || this->Of.Step >= file->GetSteps())
  {
    return nullptr;
  }
  return std::make_shared<vtkDSMFileValues>(file, static_cast<std::size_t>(found - arrays.begin()),
    this->Of.Step, bricks::Box{ bricks::Index3(0), found->Grid.Samples }, None, options);
}

bool vtkDSMFileValues::IsTooLargeToRead() const
{
  return this->CountCoarser() > 0 &&
    CountSamples(this->GetArray()) >
    (vol::IsUrl(this->Of.File->GetPath()) ? MostOnServer : MostOnDisk);
}

void vtkDSMFileValues::Prefetch(std::vector<bricks::Box> boxes) const
{
  for (bricks::Box& box : boxes)
  {
    box = { box.Min + this->Box.Min, box.Max + this->Box.Min };
  }
  vol::ChunkCache::GetShared().Prefetch(this->Of, boxes);
}

std::uint64_t vtkDSMFileValues::GetStamp() const
{
  const std::string& path = this->Of.File->GetPath();
  const std::int64_t numbers[] = { static_cast<std::int64_t>(this->Of.File->GetStamp()),
    static_cast<std::int64_t>(this->Of.Array), this->Of.Step, this->Box.Min.x, this->Box.Min.y,
    this->Box.Min.z, this->Box.Max.x, this->Box.Max.y, this->Box.Max.z };
  bricks::ByteHash hash;
  hash.Add(path.data(), path.size());
  hash.Add(numbers, sizeof(numbers));
  return hash.Get();
}

vtkDSMFileValues::Place vtkDSMFileValues::Find(const bricks::Index3& sample) const
{
  const vol::ChunkGrid& grid = this->GetArray().Grid;
  const bricks::Index3 chunk = (sample + this->Box.Min) / grid.ChunkSamples;
  const bricks::Box has = grid.GetBox(chunk);
  return { vol::ChunkCache::GetShared().Get(this->Of, chunk),
    { has.Min - this->Box.Min, has.Max - this->Box.Min } };
}

const vol::ValueRanges* vtkDSMFileValues::FindRanges(
  const std::function<bool(double)>& goesOn, bool withBricks) const
{
  const std::lock_guard<std::mutex> lock(this->RangesLock);
  if (!this->Ranges)
  {
    this->Ranges = vol::LoadRanges(this->Of, this->Box, this->IsShare);
  }
  if (!this->Ranges && this->IsTooLargeToRead() && this->ReadCoarserRanges(goesOn))
  {
    return this->Ranges ? &*this->Ranges : nullptr;
  }
  if (!this->Ranges)
  {
    this->ReadRanges(goesOn, withBricks && vol::CanLookAtBricks(this->GetArray()));
    dsm::FreedMemory::Return(); // memory of the threads that examined bricks
    if (this->Ranges)
    {
      vol::KeepRanges(this->Of, this->Box, *this->Ranges);
    }
  }
  return this->Ranges ? &*this->Ranges : nullptr;
}

bool vtkDSMFileValues::ReadCoarserRanges(const std::function<bool(double)>& goesOn) const
{
  std::shared_ptr<const vtkDSMFileValues> coarser;
  for (int level = 1; level <= this->CountCoarser(); ++level)
  {
    const auto next = this->OpenCoarser(level);
    coarser = next ? next : coarser;
    if (coarser && CountSamples(coarser->GetArray()) <= MostOfCoarser)
    {
      break;
    }
  }
  const vol::ValueRanges* const ranges = coarser ? coarser->FindRanges(goesOn) : nullptr;
  if (ranges)
  {
    this->Ranges = *ranges;
  }
  return coarser != nullptr;
}

void vtkDSMFileValues::ReadRanges(const std::function<bool(double)>& goesOn, bool withBricks) const
{
  if (!withBricks)
  {
    this->Ranges = vol::FindRanges(this->Of, this->Box, GetThreads(), goesOn);
    return;
  }
  std::optional<vol::Look> look = vol::LookThrough(this->Of, this->Box, GetThreads(), goesOn);
  if (look)
  {
    this->Ranges = std::move(look->Ranges);
    this->Seen = std::move(look->Bricks);
  }
}

std::optional<bricks::SeenBricks> vtkDSMFileValues::TakeSeen() const
{
  const std::lock_guard<std::mutex> lock(this->RangesLock);
  return std::exchange(this->Seen, std::nullopt);
}
