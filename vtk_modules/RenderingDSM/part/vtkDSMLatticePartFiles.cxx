// SPDX-License-Identifier: BSD-3-Clause
// Lattices that are in a file.
#include "vtkDSMLatticePart.h"

#include "DSMBricks/build/VoxelIndex.h"
#include "DSMCore/memory/HostMemory.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"
#include "vtkDSMLatticeValues.h"

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
        this->IndexToData * fine.File->GetIndexOf(*file));
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
  bricks::VoxelIndex index = file.FindIndex(messenger, field.Lattice,
    this->FindFileValues(request.Array), store.GetSettings().Workers, request.Progress);
  std::vector<bool> differ;
  messenger.RunTogether("Building the macrocells",
    [&]
    {
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
