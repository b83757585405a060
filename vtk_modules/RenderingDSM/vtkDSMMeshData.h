// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshData_h
#define vtkDSMMeshData_h

#include "DSMRayTracing/accel/TriangleMesh.h"
#include "vtkDSMMeshBlock.h"
#include "vtkDSMMeshColors.h"
#include "vtkDSMMeshPiece.h"
#include "vtkDSMRankGroup.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkAbstractArray;
class vtkDSMPolyDataMapper;
class vtkDSMTubesAndSpheres;
class vtkPolyData;

/// A dataset of surfaces that is spread over the ranks, as meshes in bricks: one for each look that
/// blocks have, and for each set of arrays. Keeps nothing of the dataset.
class vtkDSMMeshData
{
public:
  struct Part
  {
    vtkDSMMeshBlock::Look Appearance;
    /// Leaves the store when its last user lets go, which must happen in the same order on every
    /// rank.
    std::shared_ptr<const rt::TriangleMesh> Mesh;
  };

  /// Collective; a rank without data takes part. `textured`: texture coordinates are wanted. Failures are dsm::Error, the same on every rank.
  vtkDSMMeshData(
    std::shared_ptr<vtkDSMRankGroup> group, vtkDSMPolyDataMapper* mapper, bool textured);

  const std::vector<Part>& GetParts() const { return this->Parts; }
  /// Of all ranks' visible blocks; uninitialised bounds (min > max) without any.
  const double* GetBounds() const { return this->Bounds; }
  /// What is wrong, but can be shown in another way; empty when nothing is. The same on every rank.
  const std::string& GetMessage() const { return this->Message; }

  /// Local, quick: numbers that are others when anything may be.
  static std::vector<std::uint64_t> GetStamp(vtkDSMPolyDataMapper* mapper, bool textured);

  /// Local, reads the data: numbers that are others when, and only when, this rank's data or what is
  /// read of them are.
  static std::vector<std::uint64_t> HashContent(
    vtkDSMPolyDataMapper* mapper, bool textured, int threads);

private:
  /// What tells meshes apart; plain, so that ranks can exchange it.
  struct Key
  {
    vtkDSMMeshBlock::Look Appearance;
    std::uint32_t Normals = 0;
    std::uint32_t Values = 0;
    std::uint32_t Colors = 0;
    std::uint32_t TextureCoordinates = 0;

    bool operator<(const Key& other) const;
  };
  struct Surface
  {
    Key Kind;
    vtkSmartPointer<vtkPolyData> Data;
    vtkDSMMeshColors Colors;
  };
  struct ColorReport;

  void FindBounds(const std::vector<vtkPolyData*>& mine);
  void CheckSolids(const vtkDSMTubesAndSpheres& solids) const;
  void CollectSurfaces(const vtkDSMTubesAndSpheres& solids, std::vector<ColorReport>& reports);
  void AddSurface(const vtkDSMMeshBlock& block, vtkPolyData* data, const vtkDSMMeshColors& colors);
  void CheckColors(const std::vector<ColorReport>& mine);
  std::string ListArrays() const;
  static std::vector<std::uint64_t> Describe(vtkDSMPolyDataMapper* mapper, bool textured,
    const std::function<std::uint64_t(vtkAbstractArray*)>& identify);
  void Publish();

  std::shared_ptr<vtkDSMRankGroup> Group;
  vtkDSMPolyDataMapper* Mapper;
  bool Textured;
  std::vector<vtkDSMMeshBlock> Blocks; ///< of this rank, while its data are read
  std::vector<Surface> Surfaces;       ///< likewise
  std::vector<Part> Parts;
  double Bounds[6];
  double Diagonal = 0.0;
  std::string Message;
};

#endif
