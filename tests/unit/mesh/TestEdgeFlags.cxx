// SPDX-License-Identifier: BSD-3-Clause
// Which sides of triangles are edges of polygons, from the source to the hit.
#include "TestMesh.h"

#include "DSMBricks/layout/TriangleBrick.h"

#include <gtest/gtest.h>

namespace
{

using namespace TestMesh;

/// The terrain as squares that were cut in two.
Mesh CreateSquares(int n)
{
  Mesh mesh = CreateTerrain(n);
  for (int square = 0; square < n * n; ++square)
  {
    mesh.EdgeFlags.insert(mesh.EdgeFlags.end(), { 0b011, 0b110 });
  }
  return mesh;
}

void CheckHit(const rt::MeshHit& hit, bool flagged)
{
  for (int side = 0; side < 3; ++side)
  {
    const glm::vec3 along = hit.Corners[(side + 1) % 3] - hit.Corners[side];
    const bool isCut = along.x != 0.0f && along.y != 0.0f;
    EXPECT_EQ((hit.EdgeFlags >> side & 1u) != 0, !flagged || !isCut) << side;
  }
}

/// A packet of rays straight down on neighboring places.
std::vector<rt::Ray> CreatePacket()
{
  std::vector<rt::Ray> rays(rt::MeshPacket::Size);
  for (int index = 0; index < rt::MeshPacket::Size; ++index)
  {
    rays[index].Origin = { 0.31 + 0.013 * (index % 4), 0.57 + 0.011 * (index / 4), 2.0 };
    rays[index].Direction = { 0.0, 0.0, -1.0 };
    rays[index].Max = 10.0;
  }
  return rays;
}

/// Of all bricks of a mesh.
struct Sizes
{
  double Bytes = 0.0;
  std::uint64_t Triangles = 0;
};

Sizes Measure(const Mesh& mesh, std::uint32_t brickBytes)
{
  Sizes sizes;
  TraceOnStore(
    mesh,
    [&](dsm::ObjectStore&, dsm::ObjectStore::Worker&,
      const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      sizes.Triangles = published->Triangles;
      published->Segment->ForEachResident([&](dsm::BlockId, const std::byte*, std::size_t bytes)
        { sizes.Bytes += static_cast<double>(bytes); });
    },
    brickBytes);
  return sizes;
}

} // namespace

TEST(EdgeFlags, TurnWithTheCorners)
{
  for (const bool flagged : { true, false })
  {
    Mesh mesh = CreateSquares(20);
    if (!flagged)
    {
      mesh.EdgeFlags.clear();
    }
    TraceAlone(mesh,
      [&](const Tracer& tracer, const std::shared_ptr<bricks::TriangleMesh>& published)
      {
        EXPECT_EQ(published->Attributes.EdgeFlags, flagged);
        const rt::MeshInstance instance(published, glm::dmat4(1.0));
        for (const rt::Ray& ray : CreateRays(500, 61, { 0.5, 0.5, 0.0 }, 0.5))
        {
          rt::MeshHit hit;
          if (tracer.Intersect(instance, ray, hit))
          {
            CheckHit(hit, flagged);
          }
        }
        const std::vector<rt::Ray> rays = CreatePacket();
        rt::MeshHit hits[rt::MeshPacket::Size];
        constexpr rt::RayMask all = ~rt::RayMask{ 0 };
        EXPECT_EQ(tracer.Intersect(instance, rays.data(), all, KeepIn(hits)), all);
        for (int index = 0; index < rt::MeshPacket::Size; ++index)
        {
          CheckHit(hits[index], flagged);
          rt::MeshHit alone;
          EXPECT_TRUE(tracer.Intersect(instance, rays[index], alone));
          EXPECT_EQ(alone.EdgeFlags, hits[index].EdgeFlags);
        }
      });
  }
}

TEST(EdgeFlags, TakeThreeBitsATriangleAndNothingWhereThereAreNone)
{
  Mesh mesh = CreateSquares(120);
  mesh.Colors.clear();
  mesh.TextureCoordinates.clear();
  const std::uint32_t brickBytes = bricks::TriangleMeshSettings().BrickBytes;
  const Sizes with = Measure(mesh, brickBytes);
  mesh.EdgeFlags.clear();
  const Sizes without = Measure(mesh, brickBytes);
  ASSERT_EQ(with.Triangles, without.Triangles);
  const auto triangles = static_cast<double>(with.Triangles);
  EXPECT_GT(with.Bytes - without.Bytes, 3.0 / 8.0 * triangles);
  EXPECT_LT(with.Bytes - without.Bytes, 0.5 * triangles);
  // With positions, normals and a value of the points.
  EXPECT_LT(with.Bytes / triangles, 90.0);
}
