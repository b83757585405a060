// SPDX-License-Identifier: BSD-3-Clause
// Rays of a mesh in packets find what they find alone, bit for bit, with every kind of vectors.
#include "TestTubes.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

namespace
{

using namespace TestMesh;

struct Tally
{
  int Hits = 0;
  int Together = 0; ///< rays that shared a packet with others
};

using Packet = std::vector<rt::Ray>;

/// Rays of a block of pixels: from one point, or parallel, `spread` apart at the target.
std::vector<Packet> CreateBlocks(int count, double spread, unsigned seed,
  const glm::dvec3& center = glm::dvec3(0.0), double radius = 1.0)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Packet> packets;
  for (const rt::Ray& middle : CreateRays(count, seed, center, radius))
  {
    const glm::dvec3 direction = glm::normalize(middle.Direction);
    const glm::dvec3 side = glm::normalize(glm::cross(
      direction, std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 up = glm::cross(side, direction);
    const bool parallel = packets.size() % 2 == 0;
    Packet packet;
    for (int lane = 0; lane < rt::MeshPacket::Size; ++lane)
    {
      const glm::dvec3 shift =
        spread * radius * ((lane % 4 - 1.5) * side + (lane / 4 - 1.5 + 0.1 * uniform(random)) * up);
      rt::Ray ray = middle;
      (parallel ? ray.Origin : ray.Direction) += (parallel ? 1.0 : 0.3) * shift;
      packet.push_back(ray);
    }
    packets.push_back(packet);
  }
  return packets;
}

void ExpectEqual(const rt::MeshHit& hit, const rt::MeshHit& expected)
{
  EXPECT_EQ(hit.T, expected.T);
  EXPECT_EQ(hit.GeometricNormal, expected.GeometricNormal);
  EXPECT_EQ(hit.Normal, expected.Normal);
  EXPECT_EQ(hit.Front, expected.Front);
  EXPECT_EQ(hit.Weights, expected.Weights);
  EXPECT_EQ(hit.Brick, expected.Brick);
  EXPECT_EQ(hit.Triangle, expected.Triangle);
  EXPECT_EQ(hit.Color, expected.Color);
  EXPECT_EQ(hit.TextureCoordinate, expected.TextureCoordinate);
  if (!std::isnan(expected.Value))
  {
    EXPECT_EQ(hit.Value, expected.Value);
    EXPECT_EQ(hit.CornerValues, expected.CornerValues);
  }
}

/// With every kernel, for all rays of a packet and for some.
Tally ComparePackets(const bricks::TriangleSource& mesh, const std::vector<Packet>& packets,
  const glm::dmat4& matrix = glm::dmat4(1.0), const rt::MeshCulling& culling = {},
  std::uint32_t brickBytes = 1024)
{
  Tally tally;
  TraceOnStore(
    mesh,
    [&](dsm::ObjectStore& store, dsm::ObjectStore::Worker& worker,
      const std::shared_ptr<bricks::TriangleMesh>& published)
    {
      rt::MeshInstance instance(published, matrix);
      instance.Culling = culling;
      const Tracer alone(store, worker);
      for (const rt::MeshKernel& kernel : rt::MeshKernel::GetAll())
      {
        SCOPED_TRACE(kernel.Name);
        const Tracer tracer(store, worker, kernel);
        std::mt19937 random(1);
        for (std::size_t number = 0; number < packets.size(); ++number)
        {
          const Packet& rays = packets[number];
          const rt::MeshPacket::Mask wanted = number % 3 == 0 ? 0xffffu : random() & 0xffffu;
          rt::MeshHit hits[rt::MeshPacket::Size];
          const rt::RayMask found = tracer.Intersect(instance, rays.data(), wanted, KeepIn(hits));
          EXPECT_EQ(found & ~wanted, 0u);
          EXPECT_EQ(tracer.FindOccluded(instance, rays.data(), wanted), found);
          for (int lane = 0; lane < rt::MeshPacket::Size; ++lane)
          {
            SCOPED_TRACE(testing::Message() << "packet " << number << ", ray " << lane);
            rt::MeshHit expected;
            const bool isHit =
              (wanted >> lane & 1) != 0 && alone.Intersect(instance, rays[lane], expected);
            EXPECT_EQ((found >> lane & 1) != 0, isHit);
            EXPECT_EQ((wanted >> lane & 1) != 0 && alone.IsOccluded(instance, rays[lane]), isHit);
            if (isHit && (found >> lane & 1) != 0)
            {
              ++tally.Hits;
              ExpectEqual(hits[lane], expected);
            }
            if (testing::Test::HasFailure())
            {
              return;
            }
          }
          rt::MeshPacket packet;
          rt::MeshPacket::Mask single = 0;
          const auto together = kernel.SetRays(packet, instance, rays.data(), 0xffffu, single);
          EXPECT_EQ(together & single, 0u);
          tally.Together += __builtin_popcount(together) > 1 ? __builtin_popcount(together) : 0;
        }
      }
    },
    brickBytes);
  return tally;
}

} // namespace

TEST(MeshPackets, BlocksOfPixels)
{
  for (const double spread : { 0.001, 0.02, 0.2 })
  {
    const Tally tally = ComparePackets(CreateBlob(4), CreateBlocks(150, spread, 21));
    EXPECT_GT(tally.Hits, 1000);
    EXPECT_GT(tally.Together, 1000);
  }
}

TEST(MeshPackets, SoupOfTrianglesOfAllSizes)
{
  EXPECT_GT(ComparePackets(CreateSoup(1500, 3), CreateBlocks(150, 0.03, 22)).Hits, 1000);
}

TEST(MeshPackets, AttributesOfTheTriangleThatIsHit)
{
  const glm::dvec3 center(0.5, 0.5, 0.0);
  EXPECT_GT(ComparePackets(CreateTerrain(30), CreateBlocks(150, 0.02, 23, center, 0.5)).Hits, 1000);
}

TEST(MeshPackets, RaysWithNothingInCommon)
{
  std::vector<Packet> packets;
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    packets.push_back(CreateRays(rt::MeshPacket::Size, 100 + seed));
  }
  EXPECT_GT(ComparePackets(CreateBlob(3), packets).Hits, 1000);
}

TEST(MeshPackets, RaysAlongTheAxes)
{
  std::vector<Packet> packets = CreateBlocks(120, 0.1, 24);
  for (std::size_t number = 0; number < packets.size(); ++number)
  {
    const int axis = static_cast<int>(number % 3);
    for (std::size_t lane = 0; lane < packets[number].size(); ++lane)
    {
      rt::Ray& ray = packets[number][lane];
      const double sign = number % 2 == 0 ? 1.0 : -1.0;
      ray.Direction = glm::dvec3(0.0);
      ray.Direction[axis] = sign;
      // Some of a packet lean to one side, some to the other.
      ray.Direction[(axis + 1) % 3] =
        number % 4 == 0 ? 0.01 * (static_cast<int>(lane % 4) - 2) : 0.0;
      ray.Origin *= 0.2;
      ray.Origin[axis] = -4.0 * sign;
    }
  }
  EXPECT_GT(ComparePackets(CreateBlob(3), packets).Hits, 1000);
}

TEST(MeshPackets, RaysThroughEdgesAndCorners)
{
  // Every ray meets a point of the terrain, where six triangles meet.
  std::vector<Packet> packets;
  for (int block = 0; block < 40; ++block)
  {
    Packet packet(rt::MeshPacket::Size);
    for (int lane = 0; lane < rt::MeshPacket::Size; ++lane)
    {
      packet[lane].Origin = { (block % 7 + lane % 4) / 10.0, (block % 6 + lane / 4) / 10.0, 3.0 };
      packet[lane].Direction = { 0.0, 0.0, -1.0 };
      packet[lane].Max = 10.0;
    }
    packets.push_back(packet);
  }
  EXPECT_GT(ComparePackets(CreateTerrain(10), packets).Hits, 1000);
}

TEST(MeshPackets, TrianglesThatAreThereTwice)
{
  // They differ in their values, so it shows which one is hit.
  Mesh mesh = CreateTerrain(12);
  const std::size_t triangles = mesh.Triangles.size() / 3;
  mesh.Triangles.insert(mesh.Triangles.end(), mesh.Triangles.begin(), mesh.Triangles.end());
  mesh.Values.clear();
  for (std::size_t triangle = 0; triangle < 2 * triangles; ++triangle)
  {
    mesh.Values.push_back(static_cast<double>(triangle));
  }
  mesh.ValuesOf = bricks::Attachment::Triangles;
  const auto blocks = CreateBlocks(150, 0.05, 25, glm::dvec3(0.5, 0.5, 0.0), 0.5);
  EXPECT_GT(ComparePackets(mesh, blocks).Hits, 1000);
  EXPECT_GT(ComparePackets(mesh, blocks, glm::dmat4(1.0), {}, 1).Hits, 1000);
}

TEST(MeshPackets, RaysFromWithinAndOfBoundedLength)
{
  std::vector<Packet> packets = CreateBlocks(150, 0.05, 26);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(0.0, 8.0);
  for (Packet& packet : packets)
  {
    for (rt::Ray& ray : packet)
    {
      ray.Min = uniform(random);
      ray.Max = ray.Min + uniform(random);
    }
  }
  EXPECT_GT(ComparePackets(CreateSoup(800, 9), packets).Hits, 1000);
}

TEST(MeshPackets, MovedMirroredCulledAndFarAway)
{
  glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, -20.0, 3.0));
  matrix = glm::rotate(matrix, 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -1.0)));
  matrix = glm::scale(matrix, glm::dvec3(-2.0, 0.5, 3.0));
  std::vector<Packet> packets = CreateBlocks(100, 0.02, 27);
  for (Packet& packet : packets)
  {
    for (rt::Ray& ray : packet)
    {
      ray.Origin = glm::dvec3(matrix * glm::dvec4(ray.Origin, 1.0));
      ray.Direction = glm::dmat3(matrix) * ray.Direction;
    }
  }
  for (const bool back : { false, true })
  {
    const rt::MeshCulling culling{ back, !back };
    EXPECT_GT(ComparePackets(CreateBlob(4), packets, matrix, culling).Hits, 1000);
  }
}

TEST(MeshPackets, RaysThatCannotHitDisturbNoOther)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Packet> packets = CreateBlocks(60, 0.02, 28);
  for (std::size_t number = 0; number < packets.size(); ++number)
  {
    Packet& packet = packets[number];
    packet[number % 16].Direction = glm::dvec3(0.0);
    packet[(number + 3) % 16].Origin.y = nan;
    packet[(number + 7) % 16].Direction.z = std::numeric_limits<double>::infinity();
    packet[(number + 11) % 16].Max = -1.0;
  }
  EXPECT_GT(ComparePackets(CreateBlob(4), packets).Hits, 1000);
}

TEST(MeshPackets, TubesAndSpheres)
{
  const Mesh mesh = TestTubes::CreateTubes(150, 100, 30);
  for (const bool back : { false, true })
  {
    const rt::MeshCulling culling{ back, false };
    EXPECT_GT(
      ComparePackets(mesh, CreateBlocks(100, 0.02, 31), glm::dmat4(1.0), culling).Hits, 1000);
  }
}

TEST(MeshPackets, EmptyMesh)
{
  EXPECT_EQ(ComparePackets(Mesh(), CreateBlocks(3, 0.02, 29)).Hits, 0);
}

TEST(MeshPackets, EveryWidthIsThere)
{
  const std::vector<rt::MeshKernel> kernels = rt::MeshKernel::GetAll();
  ASSERT_GE(kernels.size(), 2u);
  EXPECT_EQ(kernels.front().Width, 1);
  EXPECT_GT(rt::MeshKernel::GetBest().Width, 1);
  for (const rt::MeshKernel& kernel : kernels)
  {
    EXPECT_LE(kernel.Width, rt::MeshKernel::GetBest().Width) << kernel.Name;
  }
}
