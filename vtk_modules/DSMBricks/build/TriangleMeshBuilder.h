// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleMeshBuilder_h
#define bricks_TriangleMeshBuilder_h

#include "DSMBricks/build/TriangleBrickBuilder.h"
#include "DSMBricks/build/TriangleReader.h"
#include "DSMBricks/build/TriangleSource.h"
#include "DSMBricks/layout/TriangleMesh.h"
#include "DSMBricks/sorted/RecordExchange.h"
#include "DSMBricks/sorted/SortedCells.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace bricks
{

struct TriangleMeshSettings
{
  /// Average size of a brick in bytes, approximately.
  std::uint32_t BrickBytes = std::uint32_t(32) << 10;
  /// Threads on this rank that sort and build, the calling one included.
  int Threads = 1;
  /// Memory limit in bytes on this rank while the mesh is built; 0: this rank's part of the host's
  /// memory.
  std::uint64_t MemoryBytes = 0;
};

/// The steps from the triangles of all ranks to bricks and the hierarchy over them; PublishMesh runs
/// them with a store. All are collective and throw the same dsm::Error on every rank. The mesh that
/// comes out, bricks included, is bit for bit the same however the triangles were distributed over
/// ranks, in whatever order they were.
class TriangleMeshBuilder
{
public:
  /// Finds the mesh's bounds, origin and cells. `what` and `source` must live as long as the builder.
  TriangleMeshBuilder(std::string_view what, const TriangleSource& source,
    const TriangleMeshSettings& settings, dsm::Messenger& messenger);

  /// Sends every triangle to the owner of its cell, which builds the cell's bricks, and builds the
  /// hierarchy over the bricks of all. `progress` may be empty.
  void BuildBricks(dsm::FunctionRef<void(double)> progress);

  /// Directory of the bricks of all ranks. It can be taken once; so can the results below.
  dsm::BlockDirectory TakeBrickDirectory();
  /// This rank's bricks.
  std::unique_ptr<dsm::FragmentSource> TakeBrickSource() { return std::move(this->Bricks); }

  /// All but the segment.
  std::shared_ptr<TriangleMesh> TakeMesh() { return std::move(this->Mesh); }

private:
  /// Summary of a brick, for messages between ranks.
  struct BrickSummary
  {
    float Lower[3];
    float Upper[3];
    std::uint32_t Bytes;
    /// How many more bricks the same cell has behind this one.
    std::uint32_t Following;
  };

  void AgreeOnPieces();
  void CheckMemory();
  void FindBounds();
  void SetOrigin(const glm::dvec3& lower, const glm::dvec3& upper);
  double EstimateBrickBytesPerTriangle() const;
  /// In order of GetOwnCells.
  using BricksOfCells = std::vector<std::vector<TriangleBrickBuilder::Brick>>;
  std::unique_ptr<dsm::FragmentSource> CreateRecordSource() const;
  BricksOfCells BuildOwnBricks(const RecordBlocks& records);
  void GatherBricks(BricksOfCells bricksOfCells);

  std::string_view What;
  const TriangleSource& Source;
  TriangleMeshSettings Settings;
  dsm::Messenger& Messages;
  std::shared_ptr<TriangleMesh> Mesh;
  MortonCode Order;
  std::uint32_t LargestTriangles = 0;
  std::optional<TriangleReader> Reader;
  std::optional<SortedCells> Cells;
  std::vector<std::uint32_t> BrickBytes; ///< for the bricks of all ranks
  std::unique_ptr<BlockSource> Bricks;   ///< this rank's
};

/// Collective, between frames: publishes the mesh in bricks. Every rank gives its own triangles; nothing is kept of
/// the source. Throws the same dsm::Error on every rank. At its peak a rank holds, beside its piece, 32 bytes for
/// each of its own triangles and about 85 for each that it will own, of a mesh with normals and a value.
template <class Store>
std::shared_ptr<TriangleMesh> PublishMesh(std::string_view what, const TriangleSource& source,
  const TriangleMeshSettings& settings, Store& store, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress = {})
{
  using Progress = dsm::FunctionRef<void(double)>;
  // Approximate shares of the time: reading, building, copying.
  const auto ofBuilding = [&](double done) { progress(0.2 + 0.3 * done); };
  const auto ofCopying = [&](double done) { progress(0.9 + 0.1 * done); };
  TriangleMeshBuilder builder(what, source, settings, messenger);
  builder.BuildBricks(progress ? Progress(ofBuilding) : Progress());
  const auto brickSource = builder.TakeBrickSource();
  BlockSink sink;
  const auto segment = store.Publish(what, builder.TakeBrickDirectory(), *brickSource, sink,
    progress ? Progress(ofCopying) : Progress());
  std::shared_ptr<TriangleMesh> mesh = builder.TakeMesh();
  mesh->Segment = segment;
  return mesh;
}

} // namespace bricks

#endif
