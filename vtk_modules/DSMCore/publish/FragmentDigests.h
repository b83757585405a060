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

/// What a rank contributes to each block of a segment, in a few bytes a block: whoever publishes such
/// blocks again learns from it which of them its part has changed of.
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
  /// Whether the two are of the same fragments of a block. Both have as many blocks.
  bool IsSame(const FragmentDigests& other, BlockId id) const
  {
    return this->Digests[id] == other.Digests[id];
  }
  /// What they take of a rank's memory: one, and another while both are compared.
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
