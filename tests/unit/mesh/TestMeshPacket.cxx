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
        spread * radius * ((lane % 8 - 3.5) * side + (lane / 8 - 3.5 + 0.1 * uniform(random)) * up);
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

/// Rays from all sides through points of triangles: corners, places on edges, and just beside them.
std::vector<Packet> AimAtEdges(const Mesh& mesh, int count, unsigned seed, double size)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Packet> packets;
  const std::uint64_t triangles = mesh.GetTriangleCount();
  for (const rt::Ray& from : CreateRays(count, seed))
  {
    Packet packet;
    const std::uint64_t first = random() % triangles;
    for (int lane = 0; lane < rt::MeshPacket::Size; ++lane)
    {
      // Neighbors, so that rays share nodes.
      const std::uint64_t triangle = (first + random() % 8) % triangles;
      const glm::dvec3 a = GetPoint(mesh, triangle, lane % 3);
      const glm::dvec3 b = GetPoint(mesh, triangle, (lane + 1) % 3);
      const double place = lane % 4 == 0 ? 0.0 : lane % 4 == 1 ? 0.5 : uniform(random);
      glm::dvec3 target = a + place * (b - a);
      if (lane % 4 == 3)
      {
        target += 1e-7 * uniform(random) * (b - a);
      }
      rt::Ray ray;
      ray.Origin = size * from.Origin;
      ray.Direction = target - ray.Origin;
      ray.Max = 1e30;
      packet.push_back(ray);
    }
    packets.push_back(packet);
  }
  return packets;
}

/// Triangles that share edges, most of them much longer than wide.
Mesh CreateSlivers(int count, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto addPoint = [](Mesh& mesh, const glm::dvec3& point)
  {
    mesh.Positions.insert(mesh.Positions.end(),
      { static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z) });
  };
  Mesh mesh;
  for (int fan = 0; fan < count; ++fan)
  {
    // A fan around an edge.
    const std::uint64_t start = mesh.GetPointCount();
    const glm::dvec3 a(uniform(random), uniform(random), uniform(random));
    const glm::dvec3 along(uniform(random), uniform(random), uniform(random));
    addPoint(mesh, a);
    addPoint(mesh, a + along);
    for (std::uint64_t blade = 0; blade < 4; ++blade)
    {
      const double width = std::pow(10.0, 3.5 * uniform(random) - 3.5);
      const glm::dvec3 aside(uniform(random), uniform(random), uniform(random));
      addPoint(mesh, a + std::abs(uniform(random)) * along + width * aside);
      mesh.Triangles.insert(mesh.Triangles.end(), { start, start + 1, start + 2 + blade });
    }
  }
  return mesh;
}

/// The same mesh elsewhere.
Mesh Move(Mesh mesh, double scale, const glm::dvec3& shift)
{
  for (std::size_t place = 0; place < mesh.Positions.size(); ++place)
  {
    mesh.Positions[place] = scale * mesh.Positions[place] + shift[static_cast<int>(place % 3)];
  }
  return mesh;
}

std::vector<Packet> Move(std::vector<Packet> packets, double scale, const glm::dvec3& shift)
{
  for (Packet& packet : packets)
  {
    for (rt::Ray& ray : packet)
    {
      ray.Origin = scale * ray.Origin + shift;
      ray.Direction *= scale;
    }
  }
  return packets;
}

/// The hit that the test in double precision finds, tried on all triangles of all bricks.
rt::NearestTriangle TryAll(dsm::ObjectStore& store, dsm::ObjectStore::Worker& worker,
  const rt::MeshInstance& instance, const rt::Ray& ray)
{
  rt::NearestTriangle nearest;
  rt::ShearedRay line;
  if (instance.GetMeshRay(ray, line))
  {
    const auto& segment = *instance.GetMesh().Segment;
    for (std::uint32_t number = 0; number < segment.GetDirectory().GetCount(); ++number)
    {
      const dsm::ObjectStore::Pin pin = store.Acquire(worker, segment, number);
      const bricks::TriangleBrick brick(pin.GetData());
      for (std::uint32_t triangle = 0; triangle < brick.GetHeader().Triangles; ++triangle)
      {
        if (nearest.Try(line.Triangles, instance.Culling, brick, number, triangle))
        {
          line.Shorten(nearest.Hit.T);
        }
      }
    }
  }
  return nearest;
}

/// Rays alone, every one of them, beside TryAll.
void CompareWithAll(dsm::ObjectStore& store, dsm::ObjectStore::Worker& worker,
  const rt::MeshInstance& instance, const std::vector<Packet>& packets)
{
  const Tracer alone(store, worker);
  for (const Packet& rays : packets)
  {
    for (const rt::Ray& ray : rays)
    {
      const rt::NearestTriangle expected = TryAll(store, worker, instance, ray);
      rt::MeshHit hit;
      ASSERT_EQ(alone.Intersect(instance, ray, hit), expected.Found);
      if (expected.Found)
      {
        ASSERT_EQ(hit.T, expected.Hit.T);
        ASSERT_EQ(hit.Front, expected.Hit.Front);
        ASSERT_EQ(hit.Brick, expected.Hit.Brick);
        ASSERT_EQ(hit.Triangle, expected.Hit.Triangle);
      }
    }
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
      if (published->Triangles < 3000)
      {
        CompareWithAll(store, worker, instance, packets);
      }
      const Tracer alone(store, worker);
      for (const rt::MeshKernel& kernel : rt::MeshKernel::GetAll())
      {
        SCOPED_TRACE(kernel.Name);
        const Tracer tracer(store, worker, kernel);
        std::mt19937_64 random(1);
        for (std::size_t number = 0; number < packets.size(); ++number)
        {
          const Packet& rays = packets[number];
          // All, half of them, or a few.
          const rt::RayMask wanted = number % 3 == 0 ? ~rt::RayMask{ 0 }
            : number % 3 == 1                        ? random()
                                                     : random() & random() & random() & random();
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
          const int together =
            rt::GetCount(kernel.SetRays(packet, instance, rays.data(), ~rt::RayMask{ 0 }));
          tally.Together += together > 1 ? together : 0;
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
      packet[lane].Origin = { (block % 4 + lane % 8) / 10.0, (block % 3 + lane / 8) / 10.0, 3.0 };
      packet[lane].Direction = { 0.0, 0.0, -1.0 };
      packet[lane].Max = 10.0;
    }
    packets.push_back(packet);
  }
  EXPECT_GT(ComparePackets(CreateTerrain(10), packets).Hits, 1000);
}

TEST(MeshPackets, SliversAndTheirSharedEdges)
{
  const Mesh slivers = CreateSlivers(200, 41);
  EXPECT_GT(ComparePackets(slivers, AimAtEdges(slivers, 60, 42, 1.0)).Hits, 1000);
  // From within, so that rays of a packet leave in all directions.
  EXPECT_GT(ComparePackets(slivers, AimAtEdges(slivers, 60, 43, 0.1)).Hits, 1000);
}

TEST(MeshPackets, HugeTinyAndFarFromTheOrigin)
{
  const Mesh slivers = CreateSlivers(100, 44);
  const Mesh blob = CreateBlob(3);
  for (const double scale : { 1e-18, 1e-6, 1e6, 1e18 })
  {
    SCOPED_TRACE(scale);
    for (const glm::dvec3& shift : { glm::dvec3(0.0), scale * glm::dvec3(3e4, -5e5, 7.0) })
    {
      EXPECT_GT(ComparePackets(
                  Move(slivers, scale, shift), Move(AimAtEdges(slivers, 20, 45, 1.0), scale, shift))
                  .Hits,
        200);
      EXPECT_GT(
        ComparePackets(Move(blob, scale, shift), Move(CreateBlocks(20, 0.02, 46), scale, shift))
          .Hits,
        200);
    }
  }
}

TEST(MeshPackets, RaysFromOnePlaceInAllDirections)
{
  std::vector<Packet> packets;
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    Packet packet = CreateRays(rt::MeshPacket::Size, 200 + seed);
    for (rt::Ray& ray : packet)
    {
      ray.Direction = ray.Origin;
      ray.Origin = 0.01 * packet.front().Direction;
    }
    packets.push_back(packet);
  }
  EXPECT_GT(ComparePackets(CreateBlob(3), packets).Hits, 1000);
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
    packet[number % 64].Direction = glm::dvec3(0.0);
    packet[(number + 13) % 64].Origin.y = nan;
    packet[(number + 27) % 64].Direction.z = std::numeric_limits<double>::infinity();
    packet[(number + 41) % 64].Max = -1.0;
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
