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

/// What the blocks that make up a volume look like, where they are not to look like the rest of it. Any number of
/// threads may ask.
class BlockLooks
{
public:
  struct Look
  {
    std::optional<glm::vec4> Color; ///< in place of the material's and of the colour array's
    std::optional<float> Opacity;   ///< in place of the material's
  };
  struct Block
  {
    bricks::Box Cells; ///< of the lattice
    Look Appearance;
  };

  /// Blocks without cells are left out. Of those that overlap, either may be found.
  explicit BlockLooks(std::vector<Block> blocks);

  /// Null: as the rest.
  const Look* Find(const bricks::Index3& cell) const;
  /// Whether none lets more light through than the rest.
  bool AreOpaque() const;
  /// Whether one is to be seen even where the rest is not.
  bool AnyIsSeen() const;
  void AddTo(ObjectDigest& digest) const;

private:
  /// A box around some of the blocks, and how to go on: half of them each, or the blocks.
  struct Node
  {
    bricks::Box Cells;
    std::size_t First = 0; ///< of the blocks
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
