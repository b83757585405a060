// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFileVolume.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMBricks/build/CellAverages.h"
#include "DSMBricks/build/ValidSource.h"
#include "DSMBricks/layout/DealBricks.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/FreedMemory.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/Url.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/cache/FileCells.h"
#include "DSMVolumeFiles/cache/FileSamples.h"
#include "DSMVolumeFiles/cache/ReadAhead.h"
#include "DSMVolumeFiles/range/LookThrough.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"

#include "vtkDataSet.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <tuple>
#include <utility>

namespace
{

using bricks::Box;
using bricks::Index3;

/// Bricks of a time step; the same ones of the next step are read ahead.
class SteppingReader final : public dsm::BlockReader
{
public:
  using Step = std::shared_ptr<vol::ReadAhead::Step>;

  /// `ahead`: what has been read of this step already. It and `next` may be null.
  SteppingReader(std::shared_ptr<const dsm::BlockReader> here, Step ahead, Step next)
    : Here(std::move(here))
    , Ahead(std::move(ahead))
    , Next(std::move(next))
  {
  }

  void Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    if (!this->TryRead(id, block, bytes))
    {
      this->Here->Read(id, block, bytes);
      this->PrefetchNext(id, bytes);
    }
  }

  bool TryRead(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    const bool isHere = this->Ahead && this->Ahead->Take(id, block, bytes);
    if (isHere)
    {
      this->PrefetchNext(id, bytes);
    }
    return isHere;
  }

  bool ReadWithoutWaiting(dsm::BlockId id, std::byte* block, std::size_t bytes) const override
  {
    if (this->TryRead(id, block, bytes))
    {
      return true;
    }
    const bool isRead = this->Here->ReadWithoutWaiting(id, block, bytes);
    if (isRead)
    {
      this->PrefetchNext(id, bytes);
    }
    return isRead;
  }

  bool MayPrefetch() const override { return this->Here->MayPrefetch(); }
  void Prefetch(const std::vector<dsm::BlockId>& ids) const override { this->Here->Prefetch(ids); }
  void NoteKept(dsm::BlockId id, std::size_t bytes) const override
  {
    this->PrefetchNext(id, bytes);
  }

private:
  void PrefetchNext(dsm::BlockId id, std::size_t bytes) const
  {
    if (!this->Next)
    {
      return;
    }
    try
    {
      vol::ReadAhead::GetShared().Add(this->Next, id, bytes);
    }
    catch (const std::bad_alloc&) // it is read when it is wanted
    {
    }
  }

  std::shared_ptr<const dsm::BlockReader> Here;
  Step Ahead;
  Step Next;
};

/// How a rank that has no part of the file's values opens it.
struct Opening
{
  std::int32_t Level;
  std::int32_t RawType;
  std::int64_t RawSamples[3];
  std::int32_t RawComponents;
  std::int32_t RawBigEndian;
  std::uint64_t RawHeaderBytes;
  double Spacing[3];
  double Origin[3];
  std::int32_t HasOrigin;
};

std::vector<char> EncodeOpening(const vtkDSMFileValues& values)
{
  const vol::OpenOptions& options = values.GetOptions();
  Opening opening{};
  opening.Level = options.Level;
  opening.RawType = static_cast<std::int32_t>(options.Bare.Type);
  opening.RawComponents = options.Bare.Components;
  opening.RawBigEndian = options.Bare.BigEndian ? 1 : 0;
  opening.RawHeaderBytes = options.Bare.HeaderBytes;
  opening.HasOrigin = options.Origin ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    opening.RawSamples[axis] = options.Bare.Samples[axis];
    opening.Spacing[axis] = options.Spacing[static_cast<std::size_t>(axis)];
    opening.Origin[axis] = options.Origin ? (*options.Origin)[static_cast<std::size_t>(axis)] : 0.0;
  }
  std::vector<char> bytes(sizeof(opening));
  std::memcpy(bytes.data(), &opening, sizeof(opening));
  bytes.insert(
    bytes.end(), options.Dataset.c_str(), options.Dataset.c_str() + options.Dataset.size() + 1);
  for (const std::string& path : values.GetFile()->GetPaths())
  {
    const std::string whole = vol::GetWholePath(path);
    bytes.insert(bytes.end(), whole.c_str(), whole.c_str() + whole.size() + 1);
  }
  return bytes;
}

std::shared_ptr<const vol::VolumeFile> OpenAs(
  const std::vector<char>& bytes, vol::OpenOptions& options)
{
  Opening opening{};
  if (bytes.size() <= sizeof(opening) || bytes.back() != '\0')
  {
    throw dsm::Error("Another rank did not send the options to open the volume's file. Do all "
                     "ranks run the same build?");
  }
  std::memcpy(&opening, bytes.data(), sizeof(opening));
  options.Level = opening.Level;
  options.Bare.Type = static_cast<bricks::ScalarType>(opening.RawType);
  options.Bare.Components = opening.RawComponents;
  options.Bare.BigEndian = opening.RawBigEndian != 0;
  options.Bare.HeaderBytes = opening.RawHeaderBytes;
  for (int axis = 0; axis < 3; ++axis)
  {
    options.Bare.Samples[axis] = opening.RawSamples[axis];
    options.Spacing[static_cast<std::size_t>(axis)] = opening.Spacing[axis];
  }
  if (opening.HasOrigin != 0)
  {
    options.Origin = { opening.Origin[0], opening.Origin[1], opening.Origin[2] };
  }
  std::vector<std::string> words; // the dataset, and then the files
  for (auto word = bytes.begin() + sizeof(opening); word != bytes.end();)
  {
    const auto end = std::find(word, bytes.end(), '\0');
    words.emplace_back(word, end);
    word = end + 1;
  }
  options.Dataset = words.front();
  return vol::OpenCachedVolume({ words.begin() + 1, words.end() }, options);
}

} // namespace

vtkDSMFileVolume::Seat vtkDSMFileVolume::Describe(
  vtkDataSet* image, vtkAbstractArray* array, bool onCells)
{
  Seat seat{};
  int extent[6];
  vtkDSMImagePiece::GetExtent(image, extent);
  const int ends = onCells ? 0 : 1;
  const Index3 size(
    extent[1] - extent[0] + ends, extent[3] - extent[2] + ends, extent[5] - extent[4] + ends);
  if (const vtkDSMFileValues* values = array ? vtkDSMGetFileValues(array, size) : nullptr)
  {
    seat.InFile = 1;
    seat.Step = values->GetStep();
    seat.NextStep = values->GetNextStep();
    seat.Array = static_cast<std::int64_t>(values->GetArrayNumber());
    seat.Stamp = values->GetFile()->GetStamp();
    for (int axis = 0; axis < 3; ++axis)
    {
      seat.ToFile[axis] = values->GetBox().Min[axis] - extent[2 * axis];
    }
  }
  return seat;
}

vtkDSMFileVolume::vtkDSMFileVolume(std::shared_ptr<const vtkDSMFileValues> values, int component,
  bool onCells, const bricks::ValidValues& valid)
  : Values(std::move(values))
  , Component(this->Values->GetArray().Components == 1 ? 0 : component)
  , OnCells(onCells)
  , Valid(valid)
{
}

std::unique_ptr<vtkDSMFileVolume> vtkDSMFileVolume::Find(dsm::Messenger& messenger,
  const bricks::LatticePlan::Lattice& lattice, const std::vector<Seat>& seats,
  const vtkDSMFileValues* own, bool isFirst, int component, bool onCells,
  const bricks::ValidValues& valid)
{
  const auto getPlace = [&](const bricks::LatticePlan::Member& member)
  {
    const Seat& seat = seats[member.Piece];
    return std::make_tuple(seat.InFile, seat.Step, seat.Array, seat.Stamp,
      seat.ToFile[0] - member.IndexToLattice.x, seat.ToFile[1] - member.IndexToLattice.y,
      seat.ToFile[2] - member.IndexToLattice.z);
  };
  const auto& members = lattice.Members;
  const auto place = getPlace(members.front());
  if (std::get<0>(place) == 0 ||
    std::any_of(members.begin(), members.end(),
      [&](const auto& member) { return getPlace(member) != place; }))
  {
    return nullptr;
  }
  std::vector<char> mine;
  messenger.RunTogether("Opening the volume's file",
    [&]
    {
      if (isFirst)
      {
        mine = EncodeOpening(*own);
      }
    });
  const std::vector<char> opening = vtkDSMGather::Items(messenger, mine);
  std::unique_ptr<vtkDSMFileVolume> volume;
  try
  {
    vol::OpenOptions options = own ? own->GetOptions() : vol::OpenOptions{};
    const auto file = own ? own->GetFile() : OpenAs(opening, options);
    const Index3 first(std::get<4>(place), std::get<5>(place), std::get<6>(place));
    const auto array = static_cast<std::size_t>(std::get<2>(place));
    const Box box{ first, first + lattice.Points - Index3(onCells ? 1 : 0) };
    if (file->GetStamp() == std::get<3>(place) && array < file->GetArrays().size() &&
      bricks::Intersect(box, { Index3(0), file->GetArrays()[array].Grid.Samples }).GetCount() ==
        box.GetCount())
    {
      const int nextStep = seats[members.front().Piece].NextStep;
      volume.reset(new vtkDSMFileVolume(
        std::make_shared<vtkDSMFileValues>(file, array, std::get<1>(place), box, nextStep, options),
        component, onCells, valid));
    }
  }
  catch (const std::exception&) // the pieces' own ranks read them then
  {
    volume.reset();
  }
  volume = KeepIfEverywhere(messenger, std::move(volume));
  if (volume)
  {
    volume->CheckSameEverywhere(messenger);
  }
  return volume;
}

void vtkDSMFileVolume::CheckSameEverywhere(dsm::Messenger& messenger) const
{
  // A series opens a step's file when it is wanted, so one rank may have had it open for long.
  vol::VolumeFile::StepOrigin origin;
  const auto stamps = messenger.GatherValueTogether("Opening the volume's file",
    [&]
    {
      origin = this->Values->GetFile()->GetOrigin(this->Values->GetStep());
      return origin.Stamp;
    });
  if (std::any_of(
        stamps.begin(), stamps.end(), [&](std::uint64_t stamp) { return stamp != stamps.front(); }))
  {
    throw vol::FileError(
      origin.Path, "changed or was replaced while the ranks opened it. Reload it.");
  }
}

std::unique_ptr<vtkDSMFileVolume> vtkDSMFileVolume::KeepIfEverywhere(
  dsm::Messenger& messenger, std::unique_ptr<vtkDSMFileVolume> volume)
{
  const auto all = messenger.AllGatherValue(std::int32_t(volume ? 1 : 0));
  if (std::find(all.begin(), all.end(), 0) != all.end())
  {
    volume.reset();
  }
  return volume;
}

bool vtkDSMFileVolume::IsWhole() const
{
  return this->Values->GetArray().Grid.IsWhole(this->Values->GetBox());
}

int vtkDSMFileVolume::CountCoarser() const
{
  return this->IsWhole() ? this->Values->CountCoarser() : 0;
}

std::unique_ptr<vtkDSMFileVolume> vtkDSMFileVolume::FindCoarser(
  dsm::Messenger& messenger, int level) const
{
  std::unique_ptr<vtkDSMFileVolume> volume;
  try
  {
    volume = this->OpenCoarser(level);
  }
  catch (const std::exception&) // the finest is there
  {
    volume.reset();
  }
  return KeepIfEverywhere(messenger, std::move(volume));
}

std::unique_ptr<vtkDSMFileVolume> vtkDSMFileVolume::OpenCoarser(int level) const
{
  const auto values = this->Values->OpenCoarser(level);
  if (!values)
  {
    return nullptr;
  }
  std::unique_ptr<vtkDSMFileVolume> volume(
    new vtkDSMFileVolume(values, this->Component, this->OnCells, this->Valid));
  // Not every file says how large a level's samples are.
  const glm::dmat4 toThis = this->GetIndexOf(*volume);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double scale = toThis[axis][axis];
    const auto points = static_cast<double>(volume->GetPoints()[axis]);
    const auto thesePoints = static_cast<double>(this->GetPoints()[axis]);
    if (points < 2.0 || !(std::abs(scale * points - thesePoints) <= 2.0 * scale) ||
      !(std::abs(toThis[3][axis]) <= 2.0 * scale))
    {
      return nullptr;
    }
  }
  return volume;
}

glm::dmat4 vtkDSMFileVolume::GetIndexToWorld() const
{
  const vol::FileGeometry& geometry = this->Values->GetFile()->GetGeometry();
  const Index3 first = geometry.First + this->Values->GetBox().Min;
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 3; ++row)
  {
    matrix[3][row] = geometry.Origin[row];
    for (int axis = 0; axis < 3; ++axis)
    {
      matrix[axis][row] = geometry.Direction[3 * row + axis] * geometry.Spacing[axis];
      matrix[3][row] += matrix[axis][row] * static_cast<double>(first[axis]);
    }
  }
  return matrix;
}

glm::dmat4 vtkDSMFileVolume::GetIndexOf(const vtkDSMFileVolume& other) const
{
  return glm::inverse(this->GetIndexToWorld()) * other.GetIndexToWorld();
}

const std::string& vtkDSMFileVolume::GetPath() const
{
  return this->Values->GetFile()->GetPath();
}

std::uint64_t vtkDSMFileVolume::GetTableBytes() const
{
  return this->Values->GetFile()->GetTableBytes();
}

bool vtkDSMFileVolume::HasSteps() const
{
  return this->Values->GetFile()->GetSteps() > 1;
}

std::shared_ptr<const vol::FileBrickReader> vtkDSMFileVolume::CreateReader(
  const bricks::BrickLattice& lattice, bool scattered) const
{
  const auto& values = this->Values;
  const vol::FileSamples::Part part{ values->GetBox(), this->Component, lattice.GetScalarType() };
  vol::ChunkCache& cache = vol::ChunkCache::GetShared();
  if (!this->OnCells)
  {
    return std::make_shared<vol::FileBrickReader>(lattice,
      bricks::ValidSource::Make(
        std::make_shared<vol::FileSamples>(values->GetArrayStep(), part, cache, scattered), lattice,
        this->Valid),
      [values](std::vector<Box> boxes) { values->Prefetch(std::move(boxes)); });
  }
  const Box cells{ Index3(0), lattice.GetCells() };
  const auto reader =
    std::make_shared<vol::FileCells>(values->GetArrayStep(), part, cache, scattered);
  return std::make_shared<vol::FileBrickReader>(lattice,
    std::make_shared<bricks::CellAverages>(reader),
    [values, cells](std::vector<Box> boxes)
    {
      for (Box& box : boxes) // of points
      {
        box = bricks::Intersect({ box.Min - Index3(1), box.Max }, cells);
      }
      values->Prefetch(std::move(boxes));
    });
}

std::shared_ptr<const bricks::VoxelSource> vtkDSMFileVolume::CreateSamples(
  bricks::ScalarType type) const
{
  const vol::FileSamples::Part part{ this->Values->GetBox(), this->Component, type };
  return std::make_shared<const vol::FileSamples>(
    this->Values->GetArrayStep(), part, vol::ChunkCache::GetShared(), true);
}

std::uint64_t vtkDSMFileVolume::GetKey(const bricks::BrickLattice& lattice) const
{
  const std::uint64_t numbers[] = { this->Values->GetStamp(),
    static_cast<std::uint64_t>(this->Component), static_cast<std::uint64_t>(lattice.GetEdge()),
    static_cast<std::uint64_t>(lattice.GetScalarType()) };
  bricks::ByteHash hash;
  hash.Add(numbers, sizeof(numbers));
  hash.Add(&this->Valid, sizeof(this->Valid));
  return hash.Get();
}

std::shared_ptr<const dsm::BlockReader> vtkDSMFileVolume::CreateSteppingReader(
  const bricks::BrickLattice& lattice, std::shared_ptr<const Digests> digests) const
{
  vol::ReadAhead& ahead = vol::ReadAhead::GetShared();
  SteppingReader::Step next;
  if (this->Values->GetNextStep() != vtkDSMFileValues::None)
  {
    const auto values = std::make_shared<vtkDSMFileValues>(this->Values->GetFile(),
      this->Values->GetArrayNumber(), this->Values->GetNextStep(), this->Values->GetBox(),
      vtkDSMFileValues::None, this->Values->GetOptions());
    const vtkDSMFileVolume volume(values, this->Component, this->OnCells, this->Valid);
    vol::ReadAhead::Way way;
    way.Reader = volume.CreateReader(lattice, true);
    way.IsSame = [volume, lattice, digests, differ = std::vector<bool>()](dsm::BlockId id) mutable
    {
      if (differ.empty())
      {
        differ = volume.FindChanges(lattice, *digests);
      }
      return !differ[id];
    };
    next = ahead.Open(volume.GetKey(lattice), std::move(way));
  }
  return std::make_shared<SteppingReader>(
    this->CreateReader(lattice, true), ahead.Find(this->GetKey(lattice)), next);
}

std::vector<bool> vtkDSMFileVolume::FindChanges(
  const bricks::BrickLattice& lattice, const Digests& digests) const
{
  const auto bricks = static_cast<std::size_t>(lattice.GetBrickCount());
  std::optional<bricks::VoxelIndex> index;
  try
  {
    index = bricks::VoxelIndex::Decode(this->LoadIndex(lattice), bricks);
  }
  catch (const dsm::Error&) // it is said when the step is shown
  {
    index.reset();
  }
  return bricks::VoxelIndex::Compare(index ? index->Digests : Digests(), digests, bricks);
}

dsm::BlockDirectory vtkDSMFileVolume::CreateDirectory(
  const bricks::BrickLattice& lattice, int ranks) const
{
  return lattice.CreateDirectory(bricks::DealBricks(
    lattice, this->Values->GetArray().Grid.ChunkSamples, this->Values->GetBox().Min, ranks));
}

std::vector<std::byte> vtkDSMFileVolume::ReadIndex(const bricks::BrickLattice& lattice) const
{
  if (this->Values->GetArray().Components != 1 || this->OnCells || !this->IsWhole() ||
    this->HasOwnMissing())
  {
    return {};
  }
  vol::VolumeFile::Index index =
    this->Values->GetFile()->ReadIndex(this->Values->GetArrayNumber(), this->Values->GetStep());
  return index.BrickEdge == lattice.GetEdge() ? std::move(index.Bricks) : std::vector<std::byte>();
}

vol::KeptFile vtkDSMFileVolume::GetKept(const bricks::BrickLattice& lattice) const
{
  std::string kind =
    "bricks3-" + std::to_string(lattice.GetEdge()) + "-" + std::to_string(this->Component);
  if (this->HasOwnMissing())
  {
    bricks::ByteHash hash;
    hash.Add(&this->Valid, sizeof(this->Valid));
    kind += "-" + std::to_string(hash.Get());
  }
  return { this->Values->GetArrayStep(), this->Values->GetBox(), kind };
}

std::vector<std::byte> vtkDSMFileVolume::LoadIndex(const bricks::BrickLattice& lattice) const
{
  const auto bricks = static_cast<std::size_t>(lattice.GetBrickCount());
  std::vector<std::byte> bytes = this->ReadIndex(lattice);
  // If the file's own index is damaged, the one that replaces it is kept.
  return bricks::VoxelIndex::Decode(bytes, bricks)
    ? std::move(bytes)
    : this->GetKept(lattice).Load(bricks::VoxelIndex::CountBytes(bricks));
}

std::optional<bricks::VoxelIndex> vtkDSMFileVolume::FindIndex(dsm::Messenger& messenger,
  const bricks::BrickLattice& lattice, const vtkDSMFileValues* own, int threads,
  const std::function<void(double)>& progress) const
{
  const char* const what = "Indexing the volume";
  const std::optional<bricks::SeenBricks> seen = own ? own->TakeSeen() : std::nullopt;
  std::vector<std::byte> bytes;
  messenger.RunTogether(what,
    [&]
    {
      if (messenger.GetRank() == 0)
      {
        bytes = this->LoadIndex(lattice);
      }
    });
  bytes = messenger.Broadcast(std::move(bytes));
  std::optional<bricks::VoxelIndex> known;
  messenger.RunTogether(
    what, [&] { known = bricks::VoxelIndex::Decode(bytes, lattice.GetBrickCount()); });
  std::shared_ptr<const vol::FileBrickReader> reader;
  messenger.RunTogether(what, [&] { reader = this->CreateReader(lattice, false); });
  if (known)
  {
    known->LeaveOutFills(messenger, lattice, *reader, threads);
    return known;
  }
  if (this->Values->IsTooLargeToRead())
  {
    return std::nullopt;
  }
  bricks::VoxelIndex::Pass pass;
  pass.Threads = threads;
  pass.Seen = seen && !this->HasOwnMissing() ? &*seen : nullptr;
  messenger.RunTogether(what,
    [&]
    {
      pass.IsFiller = [reader](dsm::BlockId id) { return reader->IsFiller(id); };
      pass.Order = vol::OrderBricks(lattice, { bricks::Index3(0), lattice.GetBricks() },
        this->Values->GetArray(), this->Values->GetBox().Min);
    });
  bricks::VoxelIndex found = bricks::VoxelIndex::Find(messenger, lattice, *reader, pass, progress);
  found.LeaveOutFills(messenger, lattice, *reader, threads);
  dsm::FreedMemory::Return(); // memory of the threads that examined bricks
  messenger.RunTogether(what,
    [&]
    {
      if (messenger.GetRank() == 0)
      {
        const std::vector<std::byte> encoded = found.Encode();
        this->GetKept(lattice).Keep(encoded.data(), encoded.size());
      }
    });
  return found;
}
