// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/cache/FileBrickReader.h"

#include "DSMVolumeFiles/base/ReadingManner.h"

#include <algorithm>
#include <new>
#include <utility>

namespace vol
{

FileBrickReader::FileBrickReader(const bricks::BrickLattice& lattice,
  std::shared_ptr<const bricks::VoxelSource> source, Prefetcher prefetch)
  : Lattice(lattice)
  , Bricks(lattice, std::move(source))
  , PrefetchBoxes(std::move(prefetch))
{
}

void FileBrickReader::Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const
{
  this->Bricks.Read(id, block, bytes);
}

bool FileBrickReader::ReadWithoutWaiting(dsm::BlockId id, std::byte* block, std::size_t bytes) const
{
  if (!this->CanTell)
  {
    return false;
  }
  const WithoutWaiting scope;
  try
  {
    this->Bricks.Read(id, block, bytes);
    return true;
  }
  catch (const WouldWait& wait)
  {
    if (wait.Always)
    {
      this->CanTell = false;
    }
    return false;
  }
}

void FileBrickReader::Prefetch(const std::vector<dsm::BlockId>& ids) const
{
  try
  {
    std::vector<bricks::Box> boxes(ids.size());
    std::transform(ids.begin(), ids.end(), boxes.begin(),
      [&](dsm::BlockId id)
      {
        const bricks::Box cells = this->Lattice.GetCellsOfBrick(id);
        return bricks::Box{ cells.Min, cells.Max + bricks::Index3(1) };
      });
    this->PrefetchBoxes(std::move(boxes));
  }
  catch (const std::bad_alloc&) // they are read when they are wanted
  {
  }
}

} // namespace vol
