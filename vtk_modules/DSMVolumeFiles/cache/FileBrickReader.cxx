// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/cache/FileBrickReader.h"

#include "DSMVolumeFiles/base/ReadingManner.h"

#include <utility>

namespace vol
{

FileBrickReader::FileBrickReader(
  const rt::BrickLattice& lattice, std::shared_ptr<const rt::VoxelSource> source, Foresight foresee)
  : Lattice(lattice)
  , Bricks(lattice, std::move(source))
  , Foresee(std::move(foresee))
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

void FileBrickReader::TellSystem(dsm::BlockId id) const
{
  const rt::Box cells = this->Lattice.GetCellsOfBrick(id);
  this->Foresee({ cells.Min, cells.Max + rt::Index3(1) });
}

} // namespace vol
