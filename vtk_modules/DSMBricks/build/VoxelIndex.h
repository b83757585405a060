// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelIndex_h
#define bricks_VoxelIndex_h

#include "DSMBricks/build/BrickLooker.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/fetch/BlockReader.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace bricks
{

/// What must be known of a volume's bricks before any is read: found once by looking through all of them,
/// and then kept.
struct VoxelIndex
{
  std::vector<ValueRange> Bricks;       ///< by id
  IsovalueSurvey Survey;                ///< of all
  std::vector<dsm::ByteDigest> Digests; ///< of the bricks' bytes, by id

  /// Which bricks are not known to have the same bytes in both, of as many.
  static std::vector<bool> Compare(const std::vector<dsm::ByteDigest>& digests,
    const std::vector<dsm::ByteDigest>& others, std::size_t bricks);

  /// The bytes that are kept, with a checksum. Decode accepts any bytes, and returns nothing unless they are a valid
  /// index of `bricks` bricks.
  std::vector<std::byte> Encode() const;
  /// Size of what Encode returns for an index of `bricks` bricks.
  static std::size_t CountBytes(std::size_t bricks);
  static std::optional<VoxelIndex> Decode(const std::vector<std::byte>& bytes, std::size_t bricks);

  /// How to look through the bricks.
  struct Pass
  {
    /// Bricks in the order in which they are best read: all of them, the same on every rank.
    std::vector<dsm::BlockId> Order;
    /// What this rank has seen of them, of this lattice or another; may be null. These are not read.
    const SeenBricks* Seen = nullptr;
    int Threads = 1;
  };

  /// Collective: each rank reads its part of the bricks that none has seen, a few at a time. `progress` (may be empty) is told
  /// the part done, in [0, 1]; what it or the reader throws becomes an Error on every rank.
  static VoxelIndex Find(dsm::Messenger& messenger, const BrickLattice& lattice,
    const dsm::BlockReader& reader, const Pass& pass, dsm::FunctionRef<void(double)> progress);

private:
  /// Whether Find can have produced these numbers, which may come from a file.
  bool IsValid() const;
};

} // namespace bricks

#endif
