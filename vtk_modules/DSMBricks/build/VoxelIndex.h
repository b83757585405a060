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

/// Data about a volume's bricks that are needed before any brick is read. They are found once, in a
/// pass over all bricks, and then kept.
struct VoxelIndex
{
  std::vector<ValueRange> Bricks;       ///< by id
  IsovalueSurvey Survey;                ///< over all bricks, until LeaveOutFills
  std::vector<dsm::ByteDigest> Digests; ///< digests of the bricks' bytes, by id

  /// Creates the index of bricks that were not read: they may have any value of their type.
  static VoxelIndex CreateUnknown(const BrickLattice& lattice, const IsovalueSurvey& survey);

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
    /// Bricks that this rank has examined before, of this lattice or another; may be null. These
    /// are not read again.
    const SeenBricks* Seen = nullptr;
    int Threads = 1;
    BrickLooker::FillerTest IsFiller = {};
  };

  /// Collective: each rank reads its part of the bricks that no rank has seen, a few at a time. `progress`
  /// (may be empty) receives the completed part, in [0, 1]. An exception of it or of the reader becomes an
  /// Error on every rank.
  static VoxelIndex Find(dsm::Messenger& messenger, const BrickLattice& lattice,
    const dsm::BlockReader& reader, const Pass& pass, dsm::FunctionRef<void(double)> progress);

  /// Collective: leaves fill values that nothing declares out of the survey (FillValues.h). Reads bricks only if
  /// the survey and the ranges of the bricks leave it open whether there are any, and then at most 128 of them,
  /// evenly spread; the survey is of these then. Errors as those of Find.
  void LeaveOutFills(dsm::Messenger& messenger, const BrickLattice& lattice,
    const dsm::BlockReader& reader, int threads);

private:
  /// Returns whether Find can have produced these numbers, which may come from a file.
  bool IsValid() const;
};

} // namespace bricks

#endif
