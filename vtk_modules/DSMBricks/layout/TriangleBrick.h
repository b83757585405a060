// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleBrick_h
#define bricks_TriangleBrick_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/layout/TriangleBrickHeader.h"

#include <cstddef>
#include <cstdint>

namespace bricks
{

/// The bytes of a triangle brick. A view: valid as long as the block is. See TriangleBrickHeader
/// for the layout.
class TriangleBrick
{
public:
  using Node = WideBvhNode<std::uint16_t>;

  /// Triangles that a leaf of the tree refers to.
  struct Leaf
  {
    explicit Leaf(std::uint16_t reference)
      : First(reference & 0x1fffu)
      , Count((reference >> 13 & 3u) + 1)
    {
    }
    /// A bit for each.
    unsigned GetMask() const { return (1u << this->Count) - 1u; }

    std::uint32_t First;
    std::uint32_t Count;
  };

  explicit TriangleBrick(const std::byte* block)
    : Block(block)
  {
  }

  const TriangleBrickHeader& GetHeader() const
  {
    return *reinterpret_cast<const TriangleBrickHeader*>(this->Block);
  }
  const Node* GetNodes() const
  {
    return reinterpret_cast<const Node*>(this->Block + TriangleBrickHeader::NodeOffset);
  }
  const TriangleBrickVertex* GetVertices() const
  {
    return this->Get<TriangleBrickVertex>(this->GetHeader().VertexOffset);
  }
  /// Three vertex numbers.
  const std::uint16_t* GetTriangle(std::uint32_t triangle) const
  {
    return this->Get<std::uint16_t>(this->GetHeader().TriangleOffset) + 3 * triangle;
  }
  const float* GetValues() const { return this->Get<float>(this->GetHeader().ValueOffset); }
  const std::uint8_t* GetColors() const
  {
    return this->Get<std::uint8_t>(this->GetHeader().ColorOffset);
  }
  const float* GetTextureCoordinates() const
  {
    return this->Get<float>(this->GetHeader().TextureOffset);
  }
  /// AllEdges where the brick has no flags.
  unsigned GetEdgeFlags(std::uint32_t triangle) const
  {
    const std::uint32_t offset = this->GetHeader().EdgeFlagOffset;
    constexpr std::uint32_t perWord = TriangleBrickHeader::EdgeFlagsPerWord;
    return offset == 0
      ? AllEdges
      : this->Get<std::uint32_t>(offset)[triangle / perWord] >> 3 * (triangle % perWord) & AllEdges;
  }

private:
  template <class T>
  const T* Get(std::uint32_t offset) const
  {
    return reinterpret_cast<const T*>(this->Block + offset);
  }

  const std::byte* Block;
};

} // namespace bricks

#endif
