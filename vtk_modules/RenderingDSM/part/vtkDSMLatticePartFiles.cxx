// SPDX-License-Identifier: BSD-3-Clause
// Lattices that are in a file.
#include "vtkDSMLatticePart.h"

#include "DSMBricks/build/VoxelIndex.h"
#include "DSMCore/memory/HostMemory.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMLatticeValues.h"
#include "vtkDSMNestedLevels.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkObject.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace
{

/// The most bricks of a level that is published as a whole; their tables take tens of MiB on each rank.
constexpr std::size_t MostBricks = std::size_t(1) << 20;

/// Once for each file.
void TellOfLargeChunks(const std::string& name, std::uint64_t need, std::uint64_t room)
{
  static std::set<std::string> told;
  if (told.insert(name).second)
  {
    vtkGenericWarningMacro("The chunks of "
      << name << " are large: a brick needs up to " << dsm::FormatMebibytes(need)
      << " of chunks at once, but the limit is " << dsm::FormatMebibytes(room)
      << ". Each chunk is read and decompressed many times, which is slow. Raise the memory per "
         "rank (DSMMemory), or convert the file with dsm_convert.");
  }
}

} // namespace

const vtkDSMFileValues* vtkDSMLatticePart::FindFileValues(const Choice& choice) const
{
  for (const auto& member : this->Lattice.Members)
  {
    if (vtkDataSet* image = this->FindOwn(member))
    {
      Info info;
      vtkDataArray* const array = vtkDSMImageArrays::Find(image, choice, info);
      return array ? vtkDSMGetFileValues(array) : nullptr;
    }
  }
  return nullptr;
}

std::unique_ptr<vtkDSMFileVolume> vtkDSMLatticePart::FindFile(
  const Request& request, const std::vector<Info>& infos, const bricks::BrickLattice& lattice) const
{
  const Choice& choice = request.Array;
  const bricks::LatticePlan::Member& first = this->Lattice.Members.front();
  // Values at points; what colors by cells or by colors themselves is cut by the ranks that have it, and so are
  // means of cells of which some are missing, and what a mask hides parts of.
  const bricks::ValidValues& valid = infos[static_cast<std::size_t>(first.Piece)].Valid;
  if (choice.HasMask() || this->HasGaps(infos) || lattice.IsOfCells() ||
    choice.Component == vtkDSMImagePiece::Color ||
    (choice.OnCells && valid.Exclude(lattice.GetScalarType())))
  {
    return nullptr;
  }
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<vtkDSMFileVolume::Seat> mine;
  messenger.RunTogether("Reading the " + request.Purpose,
    [&]
    {
      for (const Piece& piece : this->Pieces)
      {
        if (piece.Image)
        {
          Info info;
          mine.push_back(vtkDSMFileVolume::Describe(
            piece.Image, vtkDSMImageArrays::Find(piece.Image, choice, info), choice.OnCells));
        }
      }
    });
  const vtkDSMFileValues* const own = this->FindFileValues(choice);
  return vtkDSMFileVolume::Find(messenger, this->Lattice, vtkDSMGather::Items(messenger, mine), own,
    own && this->FindOwn(first), choice.Component, choice.OnCells, valid);
}

std::shared_ptr<const bricks::VoxelField> vtkDSMLatticePart::LookAtCoarser(
  const vtkDSMFileVolume& file, const bricks::BrickLattice& lattice, const Request& request) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  for (int level = 1; level <= file.CountCoarser(); ++level)
  {
    const auto coarser = file.FindCoarser(messenger, level);
    const auto field = std::make_shared<bricks::VoxelField>();
    std::optional<bricks::VoxelIndex> index;
    if (coarser)
    {
      messenger.RunTogether("Preparing the " + request.Purpose,
        [&]
        {
          field->Lattice = bricks::BrickLattice(
            coarser->GetPoints(), lattice.GetScalarType(), lattice.HasCellMask());
        });
      index = coarser->FindIndex(messenger, field->Lattice, nullptr,
        this->Group->GetStore().GetSettings().Workers, request.Progress);
    }
    if (index)
    {
      messenger.RunTogether("Building the macrocells",
        [&]
        {
          field->Survey = index->Survey;
          field->Hierarchy = bricks::MacrocellHierarchy(field->Lattice, std::move(index->Bricks));
        });
      return field;
    }
  }
  throw dsm::Error("The coarser levels of the file '" + file.GetPath() + "' do not have " +
    request.GetName() +
    ", or are too large themselves to find the range of its values. Write levels until one is "
    "smaller.");
}

std::shared_ptr<vtkDSMLatticePart::Values> vtkDSMLatticePart::PublishLevel(
  std::shared_ptr<const vtkDSMFileVolume> file, const Request& request,
  std::shared_ptr<Values> values, std::shared_ptr<Values> old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  vtkDSMNestedLevels::Volumes levels{ file };
  for (int level = 1; level <= file->CountCoarser(); ++level)
  {
    auto coarser = file->FindCoarser(messenger, level);
    if (!coarser)
    {
      break;
    }
    levels.push_back(std::move(coarser));
  }
  std::size_t level = 0;
  const bricks::BrickLattice lattice = values->Field->Lattice;
  std::shared_ptr<vtkDSMNestedLevels> nested;
  messenger.RunTogether("Preparing the " + request.Purpose,
    [&]
    {
      const auto isTooLarge = [&]
      {
        const bricks::BrickLattice bricks(levels[level]->GetPoints(), lattice.GetScalarType(),
          lattice.HasCellMask(), bricks::BrickLattice::GetDefaultEdge(lattice.GetScalarType()));
        return bricks.GetBrickCount() > MostBricks;
      };
      while (level + 1 < levels.size() && isTooLarge())
      {
        ++level;
      }
      if (level > 0)
      {
        values = this->MakeValues(bricks::BrickLattice(levels[level]->GetPoints(),
                                    lattice.GetScalarType(), lattice.HasCellMask()),
          this->IndexToData * file->GetIndexOf(*levels[level]));
        values->SlicesToData = this->IndexToData;
        values->Level = static_cast<int>(level);
      }
      nested = vtkDSMNestedLevels::Create(levels, lattice);
    });
  this->PublishFile(*levels[level], level > 0, request, request.GetName(), *values, std::move(old));
  values->File = std::move(file);
  values->Nested = std::move(nested);
  return values;
}

std::shared_ptr<bricks::VoxelField> vtkDSMLatticePart::PublishBox(const Values& finest,
  const vtkDSMNestedLevels::Boxes& boxes, int level, const Request& request) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::BlockStore& store = this->Group->GetStore();
  const vtkDSMNestedLevels& nested = *finest.Nested;
  const vtkDSMFileVolume& volume = nested.GetVolume(level);
  std::shared_ptr<bricks::VoxelField> field;
  std::optional<dsm::BlockDirectory> directory;
  std::shared_ptr<dsm::ReadingSource> source;
  messenger.RunTogether("Preparing the " + request.Purpose,
    [&]
    {
      const bricks::BrickLattice lattice = nested.GetLattice(boxes, level);
      field = this->MakeValues(lattice, glm::dmat4(1.0))->Field;
      directory = nested.CreateDirectory(boxes, level, lattice, messenger.GetSize());
      directory->SetLevel(nested.GetFileLevel(level));
      directory->SetReadThroughCache();
      directory->AddIndexBytes(
        volume.GetTableBytes() + dsm::ReadingSource::MostReads * directory->GetLargest());
      source = std::make_shared<dsm::ReadingSource>(messenger,
        nested.CreateReader(boxes, level, lattice), "the file '" + volume.GetPath() + "'");
    });
  const std::string what = "a box of level " + std::to_string(level) + " of " + request.GetName();
  field->Segment = this->Group->WithRoom([&] { return store.Publish(what, *directory, source); });
  return field;
}

vtkDSMPart::Boxed vtkDSMLatticePart::PublishBoxes(const vtkDSMPartValues& finest,
  const vtkDSMNestedLevels::Boxes& boxes, const Request& request, const Boxed& old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const auto& all = dynamic_cast<const Values&>(finest);
  all.Nested->ExchangeRanges(messenger);
  Boxed boxed;
  for (int level = 0; level < all.Nested->GetCount(); ++level)
  {
    if (boxes[static_cast<std::size_t>(level)].IsEmpty())
    {
      continue;
    }
    const vtkDSMNestedLevels::Boxes own(boxes.begin() + level, boxes.end());
    const auto known = std::find_if(old.begin(), old.end(),
      [&](const auto& one)
      {
        const auto& values = dynamic_cast<const Values&>(*one);
        return values.BoxLevel == level && values.Boxes == own;
      });
    const auto bricked = known != old.end() ? dynamic_cast<const Values&>(**known).Bricked
                                            : this->PublishBox(all, boxes, level, request);
    messenger.RunTogether("Building the macrocells",
      [&]
      {
        const std::shared_ptr<bricks::VoxelField> field(new bricks::VoxelField(*bricked),
          [bricked](const bricks::VoxelField* one) { delete one; });
        field->Hole = all.Nested->FindHole(boxes, level);
        field->Hierarchy = bricks::MacrocellHierarchy(
          field->Lattice, all.Nested->FindRanges(boxes, level, field->Lattice));
        const auto values = std::make_shared<Values>(
          field, this->IndexToData * all.Nested->GetToFinest(boxes, level));
        values->BoxLevel = level;
        values->Boxes = own;
        values->Bricked = bricked;
        boxed.push_back(values);
      });
  }
  return boxed;
}

std::shared_ptr<vtkDSMPartValues> vtkDSMLatticePart::PublishCoarser(
  const vtkDSMPartValues& finest, int level, const Request& request) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  const auto& fine = dynamic_cast<const Values&>(finest);
  const auto file = fine.File->FindCoarser(messenger, level);
  if (!file)
  {
    return nullptr;
  }
  std::shared_ptr<Values> values;
  messenger.RunTogether("Preparing the " + request.Purpose,
    [&]
    {
      const bricks::BrickLattice& lattice = fine.Field->Lattice;
      values = this->MakeValues(
        bricks::BrickLattice(file->GetPoints(), lattice.GetScalarType(), lattice.HasCellMask()),
        fine.SlicesToData * fine.File->GetIndexOf(*file));
      values->Looked = fine.Looked;
    });
  this->PublishFile(*file, true, request,
    "level " + std::to_string(level) + " of " + request.GetName(), *values, nullptr);
  return values;
}

void vtkDSMLatticePart::PublishFile(const vtkDSMFileVolume& file, bool isCoarser,
  const Request& request, const std::string& what, Values& values,
  std::shared_ptr<Values> old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::BlockStore& store = this->Group->GetStore();
  bricks::VoxelField& field = *values.Field;
  const bool hasSteps = !isCoarser && file.HasSteps();
  const std::string name = "the file '" + file.GetPath() + "'";
  // Rays meet bricks here and there, which lie in other chunks.
  const std::uint64_t need = file.CountChunkBytesOfBrick(field.Lattice);
  const auto ofBricks = [&](std::uint64_t bricks)
  { return std::min(bricks * need, file.CountBytes() + need); };
  const std::uint64_t least = ofBricks(4);
  const std::uint64_t room = this->Group->WidenRoomForChunks(ofBricks(8), least);
  // Smaller ones take no time that is worth a word, unless not even a single brick's stay, nor do values that lie side
  // by side, which are read in parts.
  constexpr std::uint64_t large = std::uint64_t(128) << 20;
  if (need > (room < need ? large / 8 : large) && room < least && messenger.GetRank() == 0)
  {
    TellOfLargeChunks(name, need, room);
  }
  std::optional<dsm::BlockDirectory> directory;
  bool staysInMemory = false;
  messenger.RunTogether("Opening the volume's file",
    [&]
    {
      directory = file.CreateDirectory(field.Lattice, messenger.GetSize());
      directory->SetLevel(file.GetLevel());
      staysInMemory = old && old->Source && old->Field->Lattice == field.Lattice &&
        old->Field->Segment->GetDirectory().GetFingerprint() == directory->GetFingerprint();
      values.Source = staysInMemory ? std::move(old->Source)
                                    : std::make_shared<dsm::ReadingSource>(
                                        messenger, file.CreateReader(field.Lattice, true), name);
      directory->SetReadThroughCache();
      // A frame is of one level, which reads in the finest's place.
      directory->AddIndexBytes(file.GetTableBytes() +
        (isCoarser ? 0 : dsm::ReadingSource::MostReads * directory->GetLargest()) +
        (hasSteps ? vtkDSMFileVolume::CountDigestBytes(field.Lattice) : 0));
    });
  if (!staysInMemory)
  {
    old.reset();
    const auto publish = [&] { return store.Publish(what, *directory, values.Source); };
    field.Segment = isCoarser ? publish() : this->Group->WithRoom(publish);
  }
  std::optional<bricks::VoxelIndex> found = file.FindIndex(messenger, field.Lattice,
    isCoarser ? nullptr : this->FindFileValues(request.Array), store.GetSettings().Workers,
    request.Progress);
  if (!found && !values.Looked)
  {
    values.Looked = this->LookAtCoarser(file, field.Lattice, request);
  }
  bricks::VoxelIndex index;
  std::vector<bool> differ;
  messenger.RunTogether("Building the macrocells",
    [&]
    {
      if (found)
      {
        index = std::move(*found);
      }
      else
      {
        index = bricks::VoxelIndex::CreateUnknown(field.Lattice, *values.Looked->Survey);
      }
      values.Bricks = std::make_shared<const vtkDSMFileVolume::Digests>(
        hasSteps ? std::move(index.Digests) : vtkDSMFileVolume::Digests());
      if (staysInMemory)
      {
        differ = bricks::VoxelIndex::Compare(*old->Bricks, *values.Bricks, index.Bricks.size());
        field.Segment =
          std::move(old->Field->Segment); // retired with the field, should anything fail
      }
      values.Source->SetReader(file.CreateSteppingReader(field.Lattice, values.Bricks), name);
      field.Survey = index.Survey;
      field.Hierarchy = bricks::MacrocellHierarchy(field.Lattice, std::move(index.Bricks));
    });
  if (staysInMemory)
  {
    store.Refresh(what, field.Segment, differ);
  }
}
