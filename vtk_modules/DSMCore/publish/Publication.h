// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Publication_h
#define dsm_Publication_h

#include "DSMCore/base/Block.h"

#include <cstddef>
#include <vector>

namespace dsm
{

/// Contribution of this rank to one block. Source and sink define the meaning of the bytes.
struct Fragment
{
  BlockId Block = 0;
  std::vector<std::byte> Bytes;
};

/// Yields this rank's fragments, one at a time, so that no more than a bounded batch is in memory.
class FragmentSource
{
public:
  virtual ~FragmentSource() = default;
  /// Fills `fragment` (reusing its storage) with the next one; false when there is none left.
  virtual bool Next(Fragment& fragment) = 0;
  /// Part of the way gone, in [0, 1]; for progress display.
  virtual double GetProgress() const = 0;
};

/// Puts fragments into the blocks that this rank owns. Called by the communication thread.
class FragmentSink
{
public:
  virtual ~FragmentSink() = default;
  /// Before any fragment: `block` is zeroed memory of the directory's size.
  virtual void Begin(BlockId id, std::byte* block, std::size_t bytes) = 0;
  /// Throws Error when the fragment does not fit the block. Order between ranks is not defined.
  virtual void Absorb(BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) = 0;
  /// After the last fragment of every rank (Seal): derive what the block keeps about itself.
  virtual void Finish(BlockId id, std::byte* block, std::size_t bytes) = 0;
};

} // namespace dsm

#endif
