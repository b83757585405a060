// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/BrickLooker.h"

#include "DSMBricks/layout/VoxelBrickHeader.h"

#include <cstring>

namespace bricks
{

BrickLooker::BrickLooker(const BrickLattice& lattice, const dsm::BlockReader& reader, int threads)
  : Lattice(lattice)
  , Reader(reader)
  , Surveys(static_cast<std::size_t>(threads))
  , Blocks(static_cast<std::size_t>(threads))
{
}

const std::byte* BrickLooker::Read(dsm::BlockId id, int thread)
{
  std::vector<std::byte>& block = this->Blocks[static_cast<std::size_t>(thread)];
  block.resize(this->Lattice.GetBlockBytes(id));
  this->Reader.Read(id, block.data(), block.size());
  return block.data();
}

SeenBrick BrickLooker::See(dsm::BlockId id, int thread)
{
  const std::vector<std::byte>& block = this->Blocks[static_cast<std::size_t>(thread)];
  VoxelBrickHeader header;
  std::memcpy(&header, block.data(), sizeof(header));
  SeenBrick seen{ { header.First, header.Last }, {} };
  seen.Digest.Add(block.data(), block.size());
  this->Surveys[static_cast<std::size_t>(thread)].CountBrick(this->Lattice, id, block.data());
  return seen;
}

IsovalueSurvey BrickLooker::GetSurvey() const
{
  IsovalueSurvey sum;
  for (const IsovalueSurvey& one : this->Surveys)
  {
    sum.Add(one);
  }
  return sum;
}

} // namespace bricks
