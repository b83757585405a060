// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/BrickLooker.h"

#include "DSMBricks/layout/VoxelBrickHeader.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace bricks
{

BrickLooker::BrickLooker(
  const BrickLattice& lattice, const dsm::BlockReader& reader, int threads, FillerTest isFiller)
  : Lattice(lattice)
  , Reader(reader)
  , IsFiller(std::move(isFiller))
  , Works(static_cast<std::size_t>(threads))
{
}

const std::byte* BrickLooker::Read(dsm::BlockId id, int thread)
{
  Work& work = this->Works[static_cast<std::size_t>(thread)];
  work.IsFiller = this->IsFiller && this->IsFiller(id);
  if (work.IsFiller)
  {
    const Index3 cells = this->Lattice.GetCellsOfBrick(id).GetSize();
    const auto found = std::find_if(work.Fillers.begin(), work.Fillers.end(),
      [&](const Filler& one) { return one.Cells == cells; });
    work.Known = static_cast<std::size_t>(found - work.Fillers.begin());
    if (found != work.Fillers.end())
    {
      return nullptr;
    }
  }
  work.Block.resize(this->Lattice.GetBlockBytes(id));
  this->Reader.Read(id, work.Block.data(), work.Block.size());
  return work.Block.data();
}

SeenBrick BrickLooker::See(dsm::BlockId id, int thread)
{
  Work& work = this->Works[static_cast<std::size_t>(thread)];
  const Box cells = this->Lattice.GetCellsOfBrick(id);
  if (work.IsFiller && work.Known < work.Fillers.size())
  {
    const Filler& filler = work.Fillers[work.Known];
    if (filler.Survey.All > 0)
    {
      work.Survey.CountUniform(cells, this->Lattice.GetCells(), filler.Survey.Least);
    }
    return filler.Seen;
  }
  VoxelBrickHeader header;
  std::memcpy(&header, work.Block.data(), sizeof(header));
  SeenBrick seen{ { header.First, header.Last }, {} };
  seen.Digest.Add(work.Block.data(), work.Block.size());
  work.Survey.CountBrick(cells, this->Lattice.GetCells(), work.Block.data());
  if (work.IsFiller)
  {
    work.Fillers.push_back({ cells.GetSize(), seen, {} });
    work.Fillers.back().Survey.CountBrick(cells, this->Lattice.GetCells(), work.Block.data());
  }
  return seen;
}

IsovalueSurvey BrickLooker::GetSurvey() const
{
  IsovalueSurvey sum;
  for (const Work& work : this->Works)
  {
    sum.Add(work.Survey);
  }
  return sum;
}

} // namespace bricks
