// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshData_h
#define vtkDSMMeshData_h

#include "DSMBricks/layout/TriangleMesh.h"
#include "vtkDSMMeshBlock.h"
#include "vtkDSMMeshColors.h"
#include "vtkDSMMeshContent.h"
#include "vtkDSMMeshInput.h"
#include "vtkDSMRankGroup.h"
#include "vtkDSMTubesAndSpheres.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkPolyData;

/// A dataset of surfaces that is spread over the ranks, as meshes in bricks: one for each block and
/// set of arrays, or where there are many blocks for each look that blocks have. Keeps nothing of the
/// dataset.
class vtkDSMMeshData
{
public:
  /// Key by which meshes are separated; plain, for messages between ranks.
  struct Key
  {
    std::uint32_t Group = 0; ///< group of blocks
    std::uint32_t Normals = 0;
    std::uint32_t Values = 0;
    std::uint32_t Colors = 0;
    std::uint32_t TextureCoordinates = 0;
    std::uint32_t Solid = 0; ///< tubes and spheres

    bool operator<(const Key& other) const;
  };
  struct Part
  {
    vtkDSMMeshBlock::Look Appearance;
    /// Leaves the store when its last user releases it, which must happen in the same order on every rank.
    std::shared_ptr<const bricks::TriangleMesh> Mesh;
    Key Kind;
    /// Describes what this rank's part of the mesh was made of.
    std::vector<std::uint64_t> Source;
  };

  /// Collective; a rank without data takes part. The requests of the input are the same on every rank. `content`:
  /// of the input now. `old`: what was made of the mapper's data before, or null; its meshes are taken over where
  /// they would be the same, also those of blocks that are hidden now, and else leave the store first, since there
  /// may not be room for both. Meshes that others made of the same data are shared. Failures are dsm::Error, the
  /// same on every rank.
  vtkDSMMeshData(std::shared_ptr<vtkDSMRankGroup> group, vtkDSMMeshInput input,
    const vtkDSMMeshContent& content, std::unique_ptr<vtkDSMMeshData> old);

  const std::vector<Part>& GetParts() const { return this->Parts; }
  /// Without edge flags, the meshes may yet have them: those that were taken over.
  const vtkDSMMeshWish& GetWish() const { return this->Input.Wish; }
  /// Returns the bounds of all ranks' visible blocks; uninitialized bounds (min > max) if there are
  /// none.
  const double* GetBounds() const { return this->Bounds; }
  /// Returns a warning about data that are not shown as requested; empty if there is none. The same on every rank.
  const std::string& GetMessage() const { return this->Message; }
  /// Empty but where there is no such color array. The same on every rank.
  const std::string& GetWarning() const { return this->Warning; }

private:
  struct Surface
  {
    Key Kind;
    vtkSmartPointer<vtkPolyData> Data;
    vtkDSMMeshColors Colors;
  };
  struct ColorReport;

  void FormGroups();
  /// The group that an old part would be of; one that does not exist if there is none.
  std::uint32_t FindGroup(const Part& part) const;
  void DescribeSources(const vtkDSMMeshContent& content);
  void TakeOver(std::vector<Part>&& old);
  void FindBounds();
  /// Tubes and spheres reach beyond the points.
  void AddSolidsToBounds();
  void CollectSurfaces(std::vector<ColorReport>& reports);
  /// Adds the polygons of the data, or its tubes and spheres.
  void AddSurface(std::uint32_t group, vtkPolyData* data, bool isSolid);
  void CheckColors(const std::vector<ColorReport>& mine);
  std::string ListArrays() const;
  void Publish();
  std::shared_ptr<const bricks::TriangleMesh> PublishMesh(
    const Key& kind, const std::function<void(double)>& progress);
  std::uint64_t HashSource(const Key& kind, const vtkDSMMeshWish& wish) const;

  std::shared_ptr<vtkDSMRankGroup> Group;
  vtkDSMMeshInput Input;
  // Valid on this rank, while its data are read:
  std::vector<vtkDSMMeshBlock> Blocks;
  std::vector<std::uint32_t> Groups; ///< group of each block
  std::vector<Surface> Surfaces;
  vtkDSMTubesAndSpheres Solids;
  std::map<std::uint32_t, std::vector<std::uint64_t>> Sources; ///< for each group

  /// Groups are blocks, and not looks.
  bool OwnMeshes = true;
  std::map<std::uint32_t, vtkDSMMeshBlock::Look> Looks; ///< of each group, on all ranks
  /// Groups in which edge flags are wanted, and not all would be bricks::AllEdges.
  std::set<std::uint32_t> Flagged;
  std::vector<Part> Parts;
  double Bounds[6];
  double Diagonal = 0.0;
  std::string Message;
  std::string Warning;
};

#endif
