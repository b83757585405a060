// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/PublishMesh.h"

#include "DSMCore/base/Error.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace bricks
{

namespace
{

/// Summary of a rank's piece, for all ranks.
struct PieceSummary
{
  std::uint64_t Triangles = 0;
  MeshAttributes Attributes;
};

} // namespace

MeshAttributes AgreeOnAttributes(
  std::string_view what, const TriangleSource& source, dsm::Messenger& messenger)
{
  const auto pieces = messenger.GatherValueTogether(what,
    [&] {
      return PieceSummary{ source.GetTriangleCount(), source.GetAttributes() };
    });
  const PieceSummary* first = nullptr;
  for (const PieceSummary& piece : pieces)
  {
    first = first || piece.Triangles == 0 ? first : &piece;
    if (piece.Triangles != 0 && piece.Attributes != first->Attributes)
    {
      throw dsm::Error(std::string(what) + ": The pieces of the mesh on ranks " +
        std::to_string(first - pieces.data()) + " and " + std::to_string(&piece - pieces.data()) +
        " differ in their normals, values, colors, texture coordinates, edge flags or radii. All "
        "pieces must have the same arrays.");
    }
  }
  return first ? first->Attributes : MeshAttributes();
}

} // namespace bricks
