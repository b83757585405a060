// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/VoxelBrickReader.h"

#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace bricks
{

VoxelBrickReader::VoxelBrickReader(
  const BrickLattice& lattice, std::shared_ptr<const VoxelSource> source)
  : Lattice(lattice)
  , Source(std::move(source))
{
  const Box all{ Index3(0), lattice.GetCells() };
  if ((this->Source->HasCellMask() && !lattice.HasCellMask()) ||
    Intersect(this->Source->GetCells(), all).GetCount() != all.GetCount())
  {
    throw dsm::Error(
      "Bricks can be read from a file only if it contains the entire volume and no blanked cells.");
  }
}

void VoxelBrickReader::Read(dsm::BlockId id, std::byte* block, std::size_t bytes) const
{
  std::fill_n(block, bytes, std::byte{ 0 }); // gaps between the parts are part of the digest, too
  VoxelBrickSink sink(this->Lattice);
  sink.Begin(id, block, bytes);
  VoxelBrickHeader header;
  std::memcpy(&header, block, sizeof(header));
  const Box cells = this->Lattice.GetCellsOfBrick(id);
  this->Source->ReadSamples({ cells.Min, cells.Max + Index3(1) }, block + header.SampleOffset);
  if (header.MaskOffset != 0)
  {
    std::vector<std::uint8_t> holdsData(static_cast<std::size_t>(cells.GetCount()));
    this->Source->ReadCellMask(cells, holdsData.data());
    for (std::size_t cell = 0; cell < holdsData.size(); ++cell)
    {
      block[header.MaskOffset + (cell >> 3)] |= std::byte{ holdsData[cell] } << (cell & 7);
    }
  }
  sink.Finish(id, block, bytes);
}

bool VoxelBrickReader::IsFiller(dsm::BlockId id) const
{
  const Box cells = this->Lattice.GetCellsOfBrick(id);
  return this->Source->IsFill({ cells.Min, cells.Max + Index3(1) });
}

} // namespace bricks
