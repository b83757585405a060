// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleRecord_h
#define bricks_TriangleRecord_h

#include "DSMBricks/layout/MeshAttributes.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// How one triangle travels between ranks: a run of 32-bit words.
///
///   nine floats       positions of the three corners, relative to the mesh's origin
///   three words       packed normals of the corners (OctahedralNormal), if the mesh has normals; those
///                     of the triangle three times; or the radii of the corners (float)
///   one or three      values (float): of the triangle, or of the corners
///   one or three      colors (red in the lowest byte): of the triangle, or of the corners
///   six floats        texture coordinates of the corners
///   one word          edge flags, in its lowest three bits, of the corners as they are turned
///
/// A record is a function of the triangle alone, not of the rank or the order in which it came: the
/// corners are turned so that the smallest position comes first, but those of tubes stay in the order
/// of the line, and zeros are positive. Where records are sorted, triangles that differ in any way
/// have a place of their own, and so a brick's bytes do not depend on how the mesh was
/// distributed.
class TriangleRecord
{
public:
  TriangleRecord() = default;
  explicit TriangleRecord(const MeshAttributes& attributes)
  {
    const auto wordsOf = [](Attachment attachment) {
      return attachment == Attachment::Points ? 3 : attachment == Attachment::Triangles ? 1 : 0;
    };
    this->HasNormals = attributes.Normals != Attachment::None || attributes.Radii;
    this->Values = this->Normals + (this->HasNormals ? 3 : 0);
    this->Colors = this->Values + wordsOf(attributes.Values);
    this->TextureCoordinates = this->Colors + wordsOf(attributes.Colors);
    this->EdgeFlags = this->TextureCoordinates + (attributes.TextureCoordinates ? 6 : 0);
    this->Words = this->EdgeFlags + (attributes.EdgeFlags ? 1 : 0);
  }

  /// Offsets in words, and the number of words.
  int Normals = 9;
  int Values = 9;
  int Colors = 9;
  int TextureCoordinates = 9;
  int EdgeFlags = 9;
  int Words = 9;
  /// Also where they are radii.
  bool HasNormals = false;

  std::size_t GetBytes() const { return sizeof(std::uint32_t) * this->Words; }

  static void GetCorners(const std::uint32_t* record, float corners[9])
  {
    std::memcpy(corners, record, 9 * sizeof(float));
  }
};

} // namespace bricks

#endif
