// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleBrickBuilder_h
#define bricks_TriangleBrickBuilder_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/WideBvhBuilder.h"
#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/build/TriangleRecord.h"
#include "DSMBricks/layout/MeshAttributes.h"
#include "DSMBricks/layout/TriangleBrickHeader.h"
#include "DSMBricks/sorted/RecordReader.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// Makes bricks of triangles; see RecordBrickBuilder. A cell becomes several where more than a brickful have one
/// centroid.
class TriangleBrickBuilder final : public RecordBrickBuilder
{
public:
  /// Bricks have at most `largestTriangles`, itself at most TriangleBrickHeader::LargestTriangles.
  TriangleBrickBuilder(
    const MeshAttributes& attributes, const MortonCode& order, std::uint32_t largestTriangles);

  std::vector<RecordBrick> Build(const std::uint32_t* records, std::size_t count) override;

private:
  struct Key
  {
    std::uint64_t Code;
    const std::uint32_t* Record;
  };

  void Sort(const std::uint32_t* records, std::size_t count);
  RecordBrick BuildBrick(const Key* keys, std::uint32_t count);
  void MeasureTriangles(const Key* keys, std::uint32_t count, RecordBrick& brick);
  /// Adds a triangle or tube to its empty box.
  void MeasureTriangle(const std::uint32_t* record, BoundingBox& box) const;
  /// Numbers the vertices in the order in which the leaves use them.
  void CollectVertices(const Key* keys, std::uint32_t count);
  /// The words of a corner as they are compared: position, normal, then what else points have.
  void GetVertex(const std::uint32_t* record, int corner, std::uint32_t* words) const;
  std::uint16_t FindVertex(const std::uint32_t* words);
  TriangleBrickHeader LayOut(std::uint32_t triangles) const;
  void WriteElements(const Key* keys, const TriangleBrickHeader& header, std::byte* block) const;

  static constexpr int LargestVertexWords = 3 + 1 + 1 + 1 + 2;

  MeshAttributes Attributes;
  TriangleRecord Layout;
  MortonCode Order;
  std::uint32_t LargestTriangles;
  int VertexWords = 4;

  std::vector<Key> Keys;
  std::vector<BoundingBox> Boxes;
  WideBvhBuilder<std::uint16_t> Tree;
  float LargestExtent = 0.0f;
  std::vector<std::uint32_t> Vertices; ///< VertexWords each
  std::vector<std::uint16_t> Corners;  ///< three a triangle, in the order of the leaves
  std::vector<std::uint16_t> Table;    ///< vertex numbers plus one, by hash; 0 is free
};

} // namespace bricks

#endif
