// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkMesh_h
#define BenchmarkMesh_h

#include "tests/support/MeshFile.h"

#include "DSMBricks/layout/TriangleMesh.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <memory>
#include <string>

/// A mesh for benchmarks, whole on every rank, with normals and one value a point; and its bricks,
/// in the orders that the paper compares.
class BenchmarkMesh
{
public:
  /// How triangles come to share a brick.
  enum class Order
  {
    Sorted,   ///< by place (the paper, section 4.3); what the tracer always does
    Original, ///< as they follow one another in the file
    Random
  };

  /// `description` is grid:N (2 N^2 triangles of a wavy sheet) or a file in the format PLY or OBJ;
  /// every triangle is cut into four `subdivisions` times. Throws dsm::Error.
  BenchmarkMesh(const std::string& description, int subdivisions);

  const MeshFile::Mesh& GetTriangles() const { return this->Triangles; }

  /// Collective. `seconds` is how long the building took. Bricks of all orders have as many triangles
  /// as the sorted ones have on the average.
  std::shared_ptr<bricks::TriangleMesh> Publish(
    Order order, int threads, dsm::BlockStore& store, dsm::Messenger& messenger, double& seconds);

private:
  std::shared_ptr<bricks::TriangleMesh> PublishSorted(
    int threads, dsm::BlockStore& store, dsm::Messenger& messenger) const;
  std::shared_ptr<bricks::TriangleMesh> PublishRuns(
    bool shuffled, dsm::BlockStore& store, dsm::Messenger& messenger) const;

  MeshFile::Mesh Triangles;
  std::uint64_t TrianglesPerBrick = 0;
};

#endif
