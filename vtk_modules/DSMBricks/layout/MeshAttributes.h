// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_MeshAttributes_h
#define bricks_MeshAttributes_h

#include <cstdint>

namespace bricks
{

/// Element that the values of an attribute belong to.
enum class Attachment : std::uint8_t
{
  None,     ///< the mesh does not have the attribute
  Points,   ///< one for every point; interpolated in a triangle
  Triangles ///< one for every triangle
};

/// Edge flags of a triangle, all of whose sides are edges. Bit i is of the side from corner i to the
/// next one: whether it is an edge of the dataset's polygons, or a cut through one.
constexpr unsigned AllEdges = 7;

/// Attributes of a mesh beside the positions; the same for all its pieces.
struct MeshAttributes
{
  Attachment Normals = Attachment::None;
  Attachment Values = Attachment::None;
  Attachment Colors = Attachment::None;
  bool TextureCoordinates = false; ///< at the points
  bool EdgeFlags = false;          ///< of the triangles; without them, all triangles have AllEdges
  /// The primitives are tubes and spheres (TriangleSource), whose corners have radii and no normals.
  bool Radii = false;

  bool operator==(const MeshAttributes& other) const
  {
    return this->Normals == other.Normals && this->Values == other.Values &&
      this->Colors == other.Colors && this->TextureCoordinates == other.TextureCoordinates &&
      this->EdgeFlags == other.EdgeFlags && this->Radii == other.Radii;
  }
  bool operator!=(const MeshAttributes& other) const { return !(*this == other); }
};

} // namespace bricks

#endif
