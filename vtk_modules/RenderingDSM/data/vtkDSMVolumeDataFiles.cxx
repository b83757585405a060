// SPDX-License-Identifier: BSD-3-Clause
// Lattices that are in a file.
#include "vtkDSMVolumeData.h"

#include "DSMBricks/build/VoxelIndex.h"
#include "DSMCore/memory/HostMemory.h"

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

void vtkDSMVolumeData::PublishFile(const vtkDSMFileVolume& file, bool isCoarser,
  const vtkDSMFileValues* own, const std::string& what, const std::function<void(double)>& progress,
  Publication::Part& part, Publication::Part&& old) const
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  dsm::BlockStore& store = this->Group->GetStore();
  bricks::VoxelField& field = *part.Field;
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
      staysInMemory = old.Source && old.Field->Lattice == field.Lattice &&
        old.Field->Segment->GetDirectory().GetFingerprint() == directory->GetFingerprint();
      part.Source = staysInMemory ? std::move(old.Source)
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
    old = {};
    const auto publish = [&] { return store.Publish(what, *directory, part.Source); };
    field.Segment = isCoarser ? publish() : this->Group->WithRoom(publish);
  }
  bricks::VoxelIndex index =
    file.FindIndex(messenger, field.Lattice, own, store.GetSettings().Workers, progress);
  std::vector<bool> differ;
  messenger.RunTogether("Building the macrocells",
    [&]
    {
      part.Bricks = std::make_shared<const vtkDSMFileVolume::Digests>(
        hasSteps ? std::move(index.Digests) : vtkDSMFileVolume::Digests());
      if (staysInMemory)
      {
        differ = bricks::VoxelIndex::Compare(*old.Bricks, *part.Bricks, index.Bricks.size());
        field.Segment =
          std::move(old.Field->Segment); // retired with the field, should anything fail
      }
      part.Source->SetReader(file.CreateSteppingReader(field.Lattice, part.Bricks), name);
      field.Survey = index.Survey;
      field.Hierarchy = bricks::MacrocellHierarchy(field.Lattice, std::move(index.Bricks));
    });
  if (staysInMemory)
  {
    store.Refresh(what, field.Segment, differ);
  }
}
