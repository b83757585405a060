// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BlockLooks_h
#define rt_BlockLooks_h

#include "DSMBricks/base/Box.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace rt
{

class ObjectDigest;

/// Appearance of the blocks of a volume that look different from the rest of it. Any number of
/// threads may call it.
class BlockLooks
{
public:
  struct Look
  {
    std::optional<glm::vec4> Color; ///< in place of the material's and of the color array's
    std::optional<float> Opacity;   ///< in place of the material's
  };
  struct Block
  {
    bricks::Box Cells; ///< in lattice indices
    Look Appearance;
  };

  /// Omits blocks without cells. If blocks overlap, either may be found.
  explicit BlockLooks(std::vector<Block> blocks);

  /// Null: as the rest.
  const Look* Find(const bricks::Index3& cell) const;
  /// Returns whether no block lets more light through than the rest.
  bool AreOpaque() const;
  /// Returns whether any block is visible even where the rest is not.
  bool AnyIsSeen() const;
  void AddTo(ObjectDigest& digest) const;

private:
  /// Node of a hierarchy: a box around some of the blocks, with two children, or with the blocks.
  struct Node
  {
    bricks::Box Cells;
    std::size_t First = 0; ///< index of the first block
    std::size_t Last = 0;  ///< behind them
    std::size_t Second =
      0; ///< the node of the other half (the one half's follows); 0: the blocks are to be asked
  };

  void Build(std::size_t first, std::size_t last);

  std::vector<Block> Blocks;
  std::vector<Node> Nodes;
};

} // namespace rt

#endif
