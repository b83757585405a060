// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/MacrocellHierarchy.h"

#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <cstring>
#include <string>
#include <utility>

namespace bricks
{

namespace
{

constexpr const char* Building = "Building the macrocells";

/// The ranges of this rank's own bricks in ascending order of id; since all know who owns what, no
/// id need travel.
std::vector<std::byte> PackOwnRanges(const dsm::BlockSegment& segment)
{
  std::vector<std::byte> mine;
  segment.ForEachResident(
    [&](dsm::BlockId, const std::byte* block, std::size_t)
    {
      const auto& header = *reinterpret_cast<const VoxelBrickHeader*>(block);
      const std::vector<std::byte> bytes = dsm::Encode(ValueRange{ header.First, header.Last });
      mine.insert(mine.end(), bytes.begin(), bytes.end());
    });
  return mine;
}

/// The ranges of all bricks, by id, out of what each rank packed.
std::vector<ValueRange> Unpack(
  const std::vector<std::vector<std::byte>>& all, const dsm::BlockDirectory& directory)
{
  std::vector<std::size_t> next(all.size(), 0);
  std::vector<ValueRange> ranges(directory.GetCount());
  for (dsm::BlockId id = 0; id < ranges.size(); ++id)
  {
    const auto owner = static_cast<std::size_t>(directory.GetOwner(id));
    if (next[owner] + sizeof(ValueRange) > all[owner].size())
    {
      throw dsm::Error("Rank " + std::to_string(owner) +
        " is missing bricks that it owns. Do all ranks run the same build?");
    }
    std::memcpy(&ranges[id], all[owner].data() + next[owner], sizeof(ValueRange));
    next[owner] += sizeof(ValueRange);
  }
  return ranges;
}

MacrocellHierarchy::Level Coarsen(const MacrocellHierarchy::Level& fine)
{
  constexpr int ratio = 1 << MacrocellHierarchy::Shift;
  MacrocellHierarchy::Level coarse;
  coarse.Edge = fine.Edge * ratio;
  coarse.InverseEdge = 1.0 / coarse.Edge;
  for (int axis = 0; axis < 3; ++axis)
  {
    coarse.Size[axis] = (fine.Size[axis] + ratio - 1) / ratio;
  }
  const auto count = static_cast<std::size_t>(coarse.Size[0]) *
    static_cast<std::size_t>(coarse.Size[1]) * static_cast<std::size_t>(coarse.Size[2]);
  coarse.Ranges.assign(count, ValueRange::GetEmpty());
  std::size_t index = 0;
  for (int z = 0; z < fine.Size[2]; ++z)
  {
    for (int y = 0; y < fine.Size[1]; ++y)
    {
      for (int x = 0; x < fine.Size[0]; ++x)
      {
        const ValueRange& from = fine.Ranges[index++];
        const auto target = static_cast<std::size_t>(x / ratio) +
          static_cast<std::size_t>(coarse.Size[0]) *
            (static_cast<std::size_t>(y / ratio) +
              static_cast<std::size_t>(coarse.Size[1]) * static_cast<std::size_t>(z / ratio));
        coarse.Ranges[target].Add(from);
      }
    }
  }
  return coarse;
}

} // namespace

MacrocellHierarchy::MacrocellHierarchy(
  const BrickLattice& lattice, const dsm::BlockSegment& segment, dsm::Messenger& messenger)
{
  std::vector<ValueRange> ranges = GatherRanges(segment, messenger);
  messenger.RunTogether(Building, [&] { *this = MacrocellHierarchy(lattice, std::move(ranges)); });
}

std::vector<ValueRange> MacrocellHierarchy::GatherRanges(
  const dsm::BlockSegment& segment, dsm::Messenger& messenger)
{
  const auto all = messenger.GatherTogether(Building, [&] { return PackOwnRanges(segment); });
  std::vector<ValueRange> ranges;
  messenger.RunTogether(Building, [&] { ranges = Unpack(all, segment.GetDirectory()); });
  return ranges;
}

std::uint64_t MacrocellHierarchy::CountBytes(const BrickLattice& lattice)
{
  constexpr std::int64_t ratio = 1 << Shift;
  Index3 size = lattice.GetBricks();
  std::int64_t count = size.x * size.y * size.z;
  for (std::int64_t level = count; level > 1; count += level)
  {
    size = (size + Index3(ratio - 1)) / Index3(ratio);
    level = size.x * size.y * size.z;
  }
  return static_cast<std::uint64_t>(count) * sizeof(ValueRange);
}

MacrocellHierarchy::MacrocellHierarchy(const BrickLattice& lattice, std::vector<ValueRange> bricks)
{
  Level finest;
  finest.Edge = lattice.GetEdge();
  finest.InverseEdge = 1.0 / finest.Edge;
  for (int axis = 0; axis < 3; ++axis)
  {
    finest.Size[axis] = static_cast<int>(lattice.GetBricks()[axis]);
  }
  if (bricks.size() != lattice.GetBrickCount())
  {
    throw dsm::Error("The ranges of " + std::to_string(bricks.size()) +
      " bricks do not match the lattice's " + std::to_string(lattice.GetBrickCount()) +
      " bricks. Publish the lattice of these bricks.");
  }
  finest.Ranges = std::move(bricks);
  this->Levels.push_back(std::move(finest));
  while (this->Levels.back().Ranges.size() > 1)
  {
    this->Levels.push_back(Coarsen(this->Levels.back()));
  }
}

} // namespace bricks
