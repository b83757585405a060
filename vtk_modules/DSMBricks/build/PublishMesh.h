// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PublishMesh_h
#define bricks_PublishMesh_h

#include "DSMBricks/build/TriangleReader.h"
#include "DSMBricks/build/TriangleSource.h"
#include "DSMBricks/layout/TriangleMesh.h"
#include "DSMBricks/sorted/SortedBrickBuilder.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <memory>
#include <string_view>

namespace bricks
{

using TriangleMeshSettings = SortedBrickSettings;

/// Collective: returns the attributes of all pieces that have triangles. Throws the same dsm::Error on every rank if
/// they differ.
MeshAttributes AgreeOnAttributes(
  std::string_view what, const TriangleSource& source, dsm::Messenger& messenger);

/// Collective, between frames: publishes the mesh in bricks. Every rank gives its own triangles; nothing is kept of
/// the source. Throws the same dsm::Error on every rank. At its peak a rank holds, beside its piece, 32 bytes for each
/// of its own triangles. A mesh with normals and a value also takes about 25 bytes for each triangle that the rank will
/// own, and 60 more for one that comes from another rank.
template <class Store>
std::shared_ptr<TriangleMesh> PublishMesh(std::string_view what, const TriangleSource& source,
  const TriangleMeshSettings& settings, Store& store, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress = {})
{
  const MeshAttributes attributes = AgreeOnAttributes(what, source, messenger);
  TriangleReader reader(source, attributes);
  SortedBrickBuilder builder(what, reader, settings, messenger, progress);
  std::shared_ptr<TriangleMesh> mesh;
  messenger.RunTogether(what, [&] { mesh = std::make_shared<TriangleMesh>(); });
  static_cast<BrickSpace&>(*mesh) = builder.GetSpace();
  mesh->Attributes = attributes;
  mesh->Triangles = builder.GetCount();
  mesh->Dropped = builder.GetGivenCount() - builder.GetCount();
  mesh->Segment = builder.Publish(store, mesh->Bricks, progress);
  return mesh;
}

} // namespace bricks

#endif
