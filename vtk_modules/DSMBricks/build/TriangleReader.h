// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleReader_h
#define bricks_TriangleReader_h

#include "DSMBricks/build/TriangleRecord.h"
#include "DSMBricks/build/TriangleSource.h"
#include "DSMBricks/sorted/RecordReader.h"

#include <cstdint>

namespace bricks
{

/// Makes records out of the triangles of a source. May be used by several threads at a time.
class TriangleReader final : public RecordReader
{
public:
  /// `origin` and `scale` are those of TriangleMesh.
  TriangleReader(const TriangleSource& source, const MeshAttributes& attributes,
    const double origin[3], double scale = 1.0);

  const char* GetNames() const override { return "triangles"; }
  std::uint64_t GetCount() const override { return this->Source.GetTriangleCount(); }
  std::size_t GetRecordBytes() const override { return this->Layout.GetBytes(); }
  /// The code is that of the triangle's centroid.
  bool FindCode(
    std::uint64_t triangle, const MortonCode& order, std::uint64_t& code) const override;
  /// A TriangleRecord.
  void ReadRecord(std::uint64_t triangle, std::uint32_t* record) const override;

  /// Three positions in the mesh's space. False when one is not finite. Throws dsm::Error when the
  /// triangle has a point that the source does not.
  static bool ReadPositions(
    const TriangleSource& source, std::uint64_t triangle, double positions[9]);

private:
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
  double Origin[3];
  double InverseScale;
};

} // namespace bricks

#endif
