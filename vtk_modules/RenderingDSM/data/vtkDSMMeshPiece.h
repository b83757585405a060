// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshPiece_h
#define vtkDSMMeshPiece_h

#include "DSMBricks/build/TriangleSource.h"
#include "vtkDSMMeshColors.h"
#include "vtkDSMTriangleList.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <vector>

class vtkDataArray;
class vtkPolyData;

/// Requested attributes of a mesh, apart from those of its points and cells, and its colors.
struct vtkDSMMeshWish
{
  bool TextureCoordinates = false;
  bool EdgeFlags = false;
};

/// This rank's part of one mesh: the triangles of several vtkPolyData that have the same attributes,
/// read where they lie.
class vtkDSMMeshPiece final : public bricks::TriangleSource
{
public:
  /// Returns the attributes of a mesh made of the data's polygons; `isSolid`: of its tubes and spheres.
  static bricks::MeshAttributes GetAttributes(
    vtkPolyData* data, const vtkDSMMeshColors& colors, const vtkDSMMeshWish& wish, bool isSolid);

  /// `solids`: for the tubes and spheres of the data instead of the polygons, or null. All that are
  /// added must have the same attributes. Throws dsm::Error for invalid cells, and for a radius array
  /// that cannot be used.
  void Add(vtkPolyData* data, const vtkDSMMeshColors& colors, const vtkDSMMeshWish& wish,
    const vtkDSMTubesAndSpheres* solids);

  bricks::MeshAttributes GetAttributes() const override { return this->Attributes; }
  std::uint64_t GetTriangleCount() const override { return this->Triangles; }
  std::uint64_t GetPointCount() const override { return this->Points; }
  void GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const override;
  void GetPosition(std::uint64_t point, double position[3]) const override;
  void GetNormal(std::uint64_t element, double normal[3]) const override;
  double GetValue(std::uint64_t element) const override;
  void GetColor(std::uint64_t element, std::uint8_t rgba[4]) const override;
  void GetTextureCoordinate(std::uint64_t point, double coordinate[2]) const override;
  unsigned GetEdgeFlags(std::uint64_t triangle) const override;
  double GetRadius(std::uint64_t triangle, int corner) const override;

private:
  struct Part
  {
    vtkSmartPointer<vtkPolyData> Data;
    vtkDSMTriangleList List;
    vtkDSMMeshColors Colors;
    vtkDataArray* Positions;
    vtkDataArray* Normals;            ///< may be null
    vtkDataArray* TextureCoordinates; ///< likewise
    std::uint64_t FirstTriangle;
    std::uint64_t FirstPoint;
  };

  const Part& FindByTriangle(std::uint64_t triangle) const;
  const Part& FindByPoint(std::uint64_t point) const;
  /// The part that has the element, and the point or cell that the element is in it.
  const Part& FindElement(
    bricks::Attachment attachment, std::uint64_t element, vtkIdType& number) const;

  bricks::MeshAttributes Attributes;
  std::vector<Part> Parts;
  std::uint64_t Triangles = 0;
  std::uint64_t Points = 0;
};

#endif
