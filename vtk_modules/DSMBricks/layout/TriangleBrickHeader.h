// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleBrickHeader_h
#define bricks_TriangleBrickHeader_h

#include "DSMBricks/layout/MeshAttributes.h"
#include "DSMCore/base/Block.h"

#include <cstdint>
#include <cstring>

namespace bricks
{

/// Header of a triangle brick's block. The brick is a treelet of a mesh, with all data for
/// intersection and shading. Layout of the block, in this order:
///
///   this header            64 bytes
///   nodes                  80 bytes each (WideBvhNode); the first one is the root
///   vertices               16 bytes each (TriangleBrickVertex)
///   triangles              three 16-bit vertex numbers each, in the order of the tree's leaves;
///                          three more triangles of zeros, so that four can be read from any
///   values                 one float a vertex or a triangle, if the mesh has values
///   colors                 four bytes a vertex or a triangle, red first, if it has colors
///   texture coordinates    two floats a vertex, if it has texture coordinates
///   edge flags             three bits a triangle, ten triangles in a 32-bit word, the first in its
///                          lowest bits, if it has edge flags (AllEdges)
///
/// Every part starts at a multiple of 16 bytes. Offsets are from the start of the block, so it can lie anywhere; an
/// offset of 0 means that the part is missing. Vertices are shared between triangles within the brick and repeated
/// in neighboring bricks, bit for bit. Tubes and spheres lie in the place of triangles; see
/// TriangleSource.
struct TriangleBrickHeader
{
  std::uint32_t BlockBytes;
  std::uint16_t Triangles;
  std::uint16_t Vertices;
  std::uint32_t Nodes;
  std::uint32_t VertexOffset;
  std::uint32_t TriangleOffset;
  std::uint32_t ValueOffset;
  std::uint32_t ColorOffset;
  std::uint32_t TextureOffset;
  std::uint32_t EdgeFlagOffset;
  /// The longest edge along an axis of any triangle's bounds; see TriangleFilter. Infinite for tubes and
  /// spheres, of which it drops none.
  float LargestExtent;
  bool Normals;
  Attachment Values;
  Attachment Colors;
  bool Radii; ///< the triangles are tubes and spheres
  std::uint8_t Unused[20];

  static constexpr std::uint32_t NodeOffset = 64;
  static constexpr std::uint32_t EdgeFlagsPerWord = 10;
  /// Triangles of a brick are numbered with 13 bits in the leaves of its tree.
  static constexpr std::uint32_t LargestTriangles = 8191;
};

static_assert(sizeof(TriangleBrickHeader) == TriangleBrickHeader::NodeOffset, "nodes follow");
static_assert(3 * TriangleBrickHeader::LargestTriangles <= 65535, "16-bit vertex numbers suffice");

/// One vertex of a brick.
struct TriangleBrickVertex
{
  /// Relative to the mesh's origin, not the brick's: the same point has the same bits in all bricks,
  /// so no ray slips between them.
  float Position[3];
  /// OctahedralNormal; or, of tubes and spheres, the bits of the radius.
  std::uint32_t Normal;

  float GetRadius() const
  {
    float radius;
    std::memcpy(&radius, &this->Normal, sizeof(radius));
    return radius;
  }
};

static_assert(sizeof(TriangleBrickVertex) == 16, "read as one vector");

} // namespace bricks

#endif
