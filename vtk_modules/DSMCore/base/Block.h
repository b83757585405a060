// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Block_h
#define dsm_Block_h

#include <cstddef>
#include <cstdint>

namespace dsm
{

/// Numbers the blocks of one segment, from 0.
using BlockId = std::uint64_t;

/// Every block starts at a multiple of this many bytes, wherever it lies.
constexpr std::size_t BlockAlignment = 64;

/// Rounded up to a multiple of BlockAlignment.
constexpr std::size_t AlignBlock(std::size_t bytes)
{
  return (bytes + BlockAlignment - 1) / BlockAlignment * BlockAlignment;
}

/// Memory that a block occupies, in bytes: at least one unit of BlockAlignment.
constexpr std::size_t GetBlockFootprint(std::size_t bytes)
{
  return AlignBlock(bytes > 0 ? bytes : 1);
}

/// Block *n* belongs to rank *n mod N* (the paper, section 3).
class RoundRobinAssigner
{
public:
  explicit RoundRobinAssigner(int ranks)
    : Ranks(ranks)
  {
  }
  int GetOwner(BlockId id) const
  {
    return static_cast<int>(id % static_cast<BlockId>(this->Ranks));
  }

private:
  int Ranks;
};

} // namespace dsm

#endif
