// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FragmentDigests_h
#define dsm_FragmentDigests_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/publish/Publication.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dsm
{

/// Digests of this rank's contributions to the blocks of a segment, a few bytes for each block.
/// When the blocks are published again, they show which contributions have changed.
class FragmentDigests
{
public:
  FragmentDigests() = default;
  explicit FragmentDigests(BlockId count)
    : Digests(count)
  {
  }

  BlockId GetCount() const { return this->Digests.size(); }
  /// The order of a block's fragments counts. One of a block that there is not is left out.
  void Add(const Fragment& fragment);
  /// Returns whether both have the same fragments of a block. Both must have the same number of
  /// blocks.
  bool IsSame(const FragmentDigests& other, BlockId id) const
  {
    return this->Digests[id] == other.Digests[id];
  }
  /// Returns the bytes on a rank, for this object and for another one that it is compared with.
  static std::uint64_t CountBytes(BlockId count) { return 2 * count * sizeof(ByteDigest); }

private:
  std::vector<ByteDigest> Digests;
};

/// Yields what another source does, and notes it.
class NotingFragmentSource final : public FragmentSource
{
public:
  /// Both must outlive it.
  NotingFragmentSource(FragmentSource& source, FragmentDigests& digests)
    : Source(source)
    , Digests(digests)
  {
  }
  bool Next(Fragment& fragment) override;
  double GetProgress() const override { return this->Source.GetProgress(); }

private:
  FragmentSource& Source;
  FragmentDigests& Digests;
};

} // namespace dsm

#endif
