// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BrickLooker_h
#define bricks_BrickLooker_h

#include "DSMBricks/layout/BrickLattice.h"
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/fetch/BlockReader.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace bricks
{

/// Data about a brick, found in one pass over it. Plain.
struct SeenBrick
{
  ValueRange Range;
  dsm::ByteDigest Digest;
};

/// Bricks that one rank has examined by itself, with their data.
struct SeenBricks
{
  BrickLattice Lattice;
  Box Bricks;                  ///< which, on the lattice of bricks
  std::vector<SeenBrick> Seen; ///< x fastest
  IsovalueSurvey Survey;       ///< over all of these bricks

  bool Has(const Index3& brick) const
  {
    return !Intersect(this->Bricks, { brick, brick + Index3(1) }).IsEmpty();
  }
  /// Returns the index in Seen of a brick, which must be among Bricks.
  std::size_t Find(const Index3& brick) const
  {
    const Index3 at = brick - this->Bricks.Min;
    const Index3 size = this->Bricks.GetSize();
    return static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z));
  }
};

/// Reads bricks and collects the data of the top level about them. If bricks hold nothing but the fill value, it
/// reads only one of each size. Its threads are numbered from 0; each keeps its own brick and survey, so that none
/// waits.
class BrickLooker
{
public:
  /// Returns whether a brick holds nothing but the fill value, as VoxelBrickReader::IsFiller. Empty: no brick does.
  using FillerTest = std::function<bool(dsm::BlockId)>;

  /// `reader` must outlive it. Throws std::bad_alloc.
  BrickLooker(const BrickLattice& lattice, const dsm::BlockReader& reader, int threads,
    FillerTest isFiller = {});

  /// The block of a brick, which stays until the thread's next one; null where the thread has read a block with the
  /// same bytes before. Throws what the reader does.
  const std::byte* Read(dsm::BlockId id, int thread);
  /// Returns the data of the brick that the thread has read. Each brick counts once in the survey.
  SeenBrick See(dsm::BlockId id, int thread);
  /// Returns the survey of all bricks that were passed to See.
  IsovalueSurvey GetSurvey() const;

private:
  /// The data of all bricks of one size that hold nothing but the fill value.
  struct Filler
  {
    Index3 Cells;
    SeenBrick Seen;
    IsovalueSurvey Survey; ///< of one of them
  };
  struct Work
  {
    IsovalueSurvey Survey;
    std::vector<std::byte> Block;
    std::vector<Filler> Fillers;
    bool IsFiller = false; ///< the brick that Read was called for
    std::size_t Known = 0; ///< its place among Fillers, or their number
  };

  const BrickLattice& Lattice;
  const dsm::BlockReader& Reader;
  FillerTest IsFiller;
  std::vector<Work> Works;
};

} // namespace bricks

#endif
