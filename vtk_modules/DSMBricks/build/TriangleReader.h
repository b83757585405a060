// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleReader_h
#define bricks_TriangleReader_h

#include "DSMBricks/build/TriangleRecord.h"
#include "DSMBricks/build/TriangleSource.h"
#include "DSMBricks/sorted/RecordReader.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace bricks
{

/// Makes records out of the triangles of a source. May be used by several threads at a time.
class TriangleReader final : public RecordReader
{
public:
  TriangleReader(const TriangleSource& source, const MeshAttributes& attributes);

  RecordKind GetKind() const override;
  std::uint64_t GetCount() const override { return this->Source.GetTriangleCount(); }
  /// Throws dsm::Error when a triangle has a point that the source does not.
  PositionBounds FindBounds(int threads) const override;
  void SetSpace(const BrickSpace& space, int threads) override;
  void FindCodes(std::uint64_t begin, std::uint64_t end, const MortonCode& order,
    std::uint64_t* codes) const override;
  /// The code of the triangle's centroid, or NoCode.
  std::uint64_t FindCode(std::uint64_t triangle, const MortonCode& order) const;
  /// A TriangleRecord.
  void ReadRecord(std::uint64_t triangle, std::uint32_t* record) const;
  void ReadRecords(
    const std::uint64_t* triangles, std::size_t count, std::uint32_t* records) const override;
  std::unique_ptr<RecordBrickBuilder> CreateBuilder(
    const MortonCode& order, std::uint32_t largestCount) const override;

private:
  double EstimateBrickBytes() const;
  /// Three positions in the mesh's space. False when one is not finite.
  bool ReadPositions(std::uint64_t triangle, double positions[9]) const;
  /// Three radii in the mesh's space, 0 for triangles. False when one is not finite or all of a tube's are 0.
  bool ReadRadii(std::uint64_t triangle, double radii[3]) const;
  /// The record's corners; order[i] is the corner of the source that comes to the i-th place. False for a triangle that
  /// no ray can hit.
  bool ReadCorners(std::uint64_t triangle, float corners[9], int order[3]) const;
  /// Writes as many words as the attachment asks for.
  template <class GetWord>
  static void WriteElements(Attachment attachment, std::uint64_t triangle,
    const std::uint64_t points[3], std::uint32_t* words, GetWord&& getWord);

  const TriangleSource& Source;
  MeshAttributes Attributes;
  TriangleRecord Layout;
  BrickSpace Space;
};

} // namespace bricks

#endif
