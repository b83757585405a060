// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/IsosurfacePacketSearch.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace
{

/// A packet of rays between four corners, as those of a tile are.
class Beam
{
public:
  static constexpr int RayCount = rt::RayPacket::Size;

  /// `spread`: how far apart the rays are at the volume, in parts of its size.
  Beam(const bricks::Index3& cells, unsigned seed, double spread, const Planes& planes = nullptr)
    : Random(seed)
  {
    const glm::dvec3 size(cells);
    const double largest = std::max({ size.x, size.y, size.z });
    glm::dvec3 target = size * glm::dvec3(this->Get(), this->Get(), this->Get());
    if (planes)
    {
      target = planes->ToPlace(target);
    }
    const glm::dvec3 eye =
      target + largest * glm::dvec3(this->Get() - 0.5, this->Get() - 0.5, this->Get() - 0.5) * 6.0;
    const glm::dvec3 right = spread * largest * glm::dvec3(this->Get(), -this->Get(), 0.3);
    const glm::dvec3 up = spread * largest * glm::dvec3(0.2, this->Get(), this->Get());
    const bool parallel = seed % 3 == 0;
    const auto create = [&](double u, double v)
    {
      const glm::dvec3 at = target + (u - 0.5) * right + (v - 0.5) * up;
      rt::Ray ray;
      ray.Origin = parallel ? eye + at - target : eye;
      ray.Direction = 2.0 * (at - ray.Origin);
      ray.Max = 1.0;
      return ray;
    };
    const double places[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    for (int corner = 0; corner < 4; ++corner)
    {
      this->Corners[corner] = create(places[corner][0], places[corner][1]);
    }
    for (rt::Ray& ray : this->Rays)
    {
      ray = create(this->Get(), this->Get());
      ray.Min = this->Get() < 0.1 ? 0.5 : 0.0;
    }
  }

  rt::Ray Corners[4];
  rt::Ray Rays[RayCount];

private:
  double Get() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }

  std::mt19937 Random;
};

struct Tally
{
  int Hits = 0;
  int Shared = 0; ///< beams whose rays could be treated alike
};

/// Every ray finds in its packet what it finds alone, bit for bit.
template <class T>
Tally ComparePackets(const TestVolume<T>& volume, const std::vector<double>& isovalues, int edge,
  const Planes& planes = nullptr)
{
  MemoryStore store;
  MemoryStore::Worker worker;
  const rt::LatticeIsosurface object = CreateObject(store, volume, isovalues, edge, planes);
  const rt::IsosurfaceSearch<MemoryStore> alone(store, worker);
  Tally tally;
  for (const rt::PacketKernel& kernel : rt::PacketKernel::GetAll())
  {
    SCOPED_TRACE(kernel.Name);
    const rt::IsosurfacePacketSearch<MemoryStore> tracer(store, worker, kernel);
    for (unsigned seed = 0; seed < 60; ++seed)
    {
      const Beam beam(volume.GetCells(), seed, seed % 2 == 0 ? 0.05 : 0.6, planes);
      rt::BeamBricks bricks = tracer.FindBricks(object, beam.Corners);
      tally.Shared += bricks.Usable;
      rt::LatticeHit hits[Beam::RayCount];
      const rt::RayMask wanted = seed % 5 == 0 ? 0x00009137ffffu
        : seed % 5 == 1                        ? ~std::uint64_t{ 0 }
                                               : 0x80019137ffffu;
      const rt::RayMask found = tracer.Intersect(
        object, bricks, beam.Rays, wanted, [&](int index, double) { return &hits[index]; });
      for (int index = 0; index < Beam::RayCount; ++index)
      {
        const rt::RayMask bit = rt::RayMask{ 1 } << index;
        rt::LatticeHit expected;
        const bool hit = (wanted & bit) != 0 && alone.Intersect(object, beam.Rays[index], expected);
        EXPECT_EQ((found & bit) != 0, hit) << "beam " << seed << ", ray " << index;
        if (hit && (found & bit) != 0)
        {
          ++tally.Hits;
          EXPECT_EQ(hits[index].T, expected.T) << "beam " << seed << ", ray " << index;
          EXPECT_EQ(hits[index].Normal, expected.Normal);
          EXPECT_EQ(hits[index].At.IndexPoint, expected.At.IndexPoint);
          EXPECT_EQ(hits[index].At.Cell, expected.At.Cell);
          EXPECT_EQ(hits[index].Isovalue, expected.Isovalue);
          EXPECT_EQ(hits[index].FromInside, expected.FromInside);
        }
        if (testing::Test::HasFailure())
        {
          return tally;
        }
      }
    }
  }
  return tally;
}

/// Rays from a place in the volume: to one side, as to a lamp, or to all, as ambient occlusion's.
std::vector<rt::Ray> CreateLightRays(const bricks::Index3& cells, unsigned seed, bool toOneSide)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto create = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  const glm::dvec3 size(cells);
  const glm::dvec3 start = size * (0.5 + 0.4 * create());
  const glm::dvec3 side = create();
  std::vector<rt::Ray> rays(64);
  for (rt::Ray& ray : rays)
  {
    ray.Origin = start + 2.0 * create();
    ray.Direction = toOneSide ? side + 0.01 * (seed % 2) * create() : create();
    ray.Min = 1e-4;
    ray.Max = seed % 3 == 0 ? std::numeric_limits<double>::infinity() : 0.3 * size.x;
  }
  // Rays that are like no other.
  rays[seed % 64].Direction = glm::dvec3(0.0, 0.0, -1.0);
  rays[(seed + 5) % 64].Direction = glm::dvec3(0.0);
  rays[(seed + 9) % 64].Origin = 3.0 * size;
  return rays;
}

/// The product over all hits of a ray, one after the other.
double GetTransmittance(const rt::IsosurfaceSearch<MemoryStore>& search,
  const rt::LatticeIsosurface& object, rt::Ray ray, const std::vector<glm::dvec3>& sheets)
{
  double transmittance = 1.0;
  rt::LatticeHit hit;
  while (search.Intersect(object, ray, hit))
  {
    transmittance *= sheets[hit.Isovalue].x;
    ray.Min = hit.T + 1e-6;
  }
  return transmittance;
}

/// Rays are occluded together exactly where they are alone, and where there is a hit. They are attenuated together
/// exactly as alone, and by each of their hits.
template <class T>
void CompareOcclusion(const TestVolume<T>& volume, const std::vector<double>& isovalues, int edge,
  const Planes& planes = nullptr)
{
  MemoryStore store;
  MemoryStore::Worker worker;
  const rt::LatticeIsosurface object = CreateObject(store, volume, isovalues, edge, planes);
  const rt::IsosurfaceSearch<MemoryStore> alone(store, worker);
  std::vector<glm::dvec3> sheets = { { 0.9, 0.8, 0.7 }, { 0.6, 0.5, 0.9 } };
  sheets.resize(isovalues.size());
  int counts[2] = { 0, 0 };
  int apart = 0;
  for (const rt::PacketKernel& kernel : rt::PacketKernel::GetAll())
  {
    SCOPED_TRACE(kernel.Name);
    const rt::IsosurfacePacketSearch<MemoryStore> tracer(store, worker, kernel);
    for (unsigned seed = 0; seed < 60; ++seed)
    {
      const auto rays = CreateLightRays(volume.GetCells(), seed, seed % 4 < 2);
      const std::uint64_t wanted = seed % 5 == 0 ? 0x8421fffe7373abcdull : ~std::uint64_t{ 0 };
      const std::uint64_t occluded = tracer.FindOccluded(object, rays.data(), wanted);
      std::vector<glm::dvec3> transmittances(64, glm::dvec3(1.0));
      const std::uint64_t dark =
        tracer.Attenuate(object, sheets, rays.data(), wanted, transmittances.data());
      for (int index = 0; index < 64; ++index)
      {
        SCOPED_TRACE(testing::Message() << "rays " << seed << ", ray " << index);
        const bool isWanted = (wanted >> index & 1) != 0;
        rt::LatticeHit hit;
        const bool isOccluded = alone.IsOccluded(object, rays[index]);
        EXPECT_EQ(isOccluded, alone.Intersect(object, rays[index], hit));
        EXPECT_EQ((occluded >> index & 1) != 0, isWanted && isOccluded);
        ++counts[isOccluded ? 1 : 0];
        glm::dvec3 transmittance(1.0);
        const bool isDark = alone.Attenuate(object, sheets, rays[index], transmittance);
        EXPECT_EQ((dark >> index & 1) != 0, isWanted && isDark);
        EXPECT_EQ(transmittances[index], isWanted ? transmittance : glm::dvec3(1.0));
        EXPECT_EQ(isOccluded, transmittance.x < 1.0);
        const double expected = GetTransmittance(alone, object, rays[index], sheets);
        // Two hits may be nearer than the step from one to the next.
        apart += !isDark && std::fabs(transmittance.x / expected - 1.0) > 1e-9;
        if (testing::Test::HasFailure())
        {
          return;
        }
      }
    }
  }
  EXPECT_GT(counts[0], 500);
  EXPECT_GT(counts[1], 500);
  // More often in thin cells.
  EXPECT_LT(apart, counts[1] / (planes ? 10 : 500));
}

template <class T>
TestVolume<T> CreateWaves(const bricks::Index3& points)
{
  return TestVolume<T>(points,
    [](int x, int y, int z)
    {
      const double wave = std::sin(0.4 * x + 1) + std::sin(0.5 * y) + std::sin(0.3 * z + 0.2 * x);
      return static_cast<T>(std::is_signed_v<T> ? 40.0 * wave : 128.0 + 40.0 * wave);
    });
}

template <class T>
TestVolume<T> CreateNoise(const bricks::Index3& points)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 100.0);
  return TestVolume<T>(points, [&](int, int, int) { return static_cast<T>(uniform(random)); });
}

template <class T>
double GetMiddle()
{
  return std::is_signed_v<T> ? 3.0 : 131.0;
}

} // namespace

template <class T>
class TestRayPacket : public testing::Test
{
};

using PacketScalarTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(TestRayPacket, PacketScalarTypes);

TYPED_TEST(TestRayPacket, EqualsSingleRaysInWaves)
{
  using T = TypeParam;
  const Tally tally = ComparePackets(CreateWaves<T>({ 37, 41, 34 }), { GetMiddle<T>() }, 0);
  EXPECT_GT(tally.Hits, 1000);
  EXPECT_GT(tally.Shared, 100);
}

TYPED_TEST(TestRayPacket, EqualsSingleRaysInNoise)
{
  using T = TypeParam;
  for (const int edge : { 3, 4, 8, 13 })
  {
    EXPECT_GT(ComparePackets(CreateNoise<T>({ 14, 15, 13 }), { 50.0 }, edge).Hits, 1000);
  }
}

TYPED_TEST(TestRayPacket, OcclusionEqualsSingleRays)
{
  using T = TypeParam;
  CompareOcclusion(CreateWaves<T>({ 37, 41, 34 }), { GetMiddle<T>() }, 0);
  CompareOcclusion(CreateNoise<T>({ 14, 15, 13 }), { 80.0 }, 4);
}

TEST(TestRayPacketCases, OcclusionBySeveralIsovaluesAndAcrossManyBricks)
{
  CompareOcclusion(CreateWaves<float>({ 35, 36, 37 }), { -60.0, 95.0 }, 5);
  TestVolume<float> volume = CreateWaves<float>({ 70, 60, 67 });
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i)
  {
    volume.Blank(random() % 69, random() % 59, random() % 66);
    volume.At(random() % 70, random() % 60, random() % 67) =
      std::numeric_limits<float>::quiet_NaN();
  }
  CompareOcclusion(volume, { 90.0 }, 16);
}

TEST(TestRayPacketCases, SeveralIsovalues)
{
  const Tally tally =
    ComparePackets(CreateWaves<float>({ 35, 36, 37 }), { -60.0, -1.0, 5.0, 80.0 }, 16);
  EXPECT_GT(tally.Hits, 1000);
}

TEST(TestRayPacketCases, BlankedCellsAndMissingSamples)
{
  TestVolume<float> volume = CreateWaves<float>({ 33, 34, 35 });
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i)
  {
    volume.Blank(random() % 32, random() % 33, random() % 34);
    volume.At(random() % 33, random() % 34, random() % 35) =
      i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
  }
  EXPECT_GT(ComparePackets(volume, { 3.0 }, 16).Hits, 1000);
}

TEST(TestRayPacketCases, BricksOfManyMacrocells)
{
  EXPECT_GT(ComparePackets(CreateWaves<float>({ 70, 40, 67 }), { 3.0 }, 65).Hits, 1000);
}

TEST(TestRayPacketCases, TheUnitOfTheValuesDoesNotMatter)
{
  const TestVolume<double> volume = CreateNoise<double>({ 14, 15, 13 });
  const int hits = ComparePackets(volume, { 80.0 }, 4).Hits;
  EXPECT_GT(hits, 1000);
  for (const double unit : { 0x1p-600, 0x1p600 })
  {
    TestVolume<double> other = volume;
    for (double& sample : other.Samples)
    {
      sample *= unit;
    }
    EXPECT_EQ(ComparePackets(other, { 80.0 * unit }, 4).Hits, hits) << unit;
    CompareOcclusion(other, { 80.0 * unit }, 4);
  }
}

TEST(TestRayPacketCases, RectilinearGridsEqualSingleRays)
{
  for (const double ratio : { 3.0, 1e6 })
  {
    const TestVolume<float> noise = CreateNoise<float>({ 14, 25, 13 });
    const Planes few = CreatePlanes(noise.GetCells(), ratio, 3);
    for (const int edge : { 3, 4, 13 })
    {
      EXPECT_GT(ComparePackets(noise, { 50.0 }, edge, few).Hits, 1000);
    }
    CompareOcclusion(noise, { 60.0 }, 4, few);
    const TestVolume<std::uint8_t> waves = CreateWaves<std::uint8_t>({ 70, 40, 67 });
    const Planes many = CreatePlanes(waves.GetCells(), ratio, 4);
    const Tally tally = ComparePackets(waves, { 131.0 }, 0, many);
    EXPECT_GT(tally.Hits, 1000);
    EXPECT_GT(tally.Shared, 100);
    CompareOcclusion(waves, { 120.0, 131.0 }, 16, many);
  }
}

TEST(TestRayPacketCases, EveryWidthIsThere)
{
  const std::vector<rt::PacketKernel> kernels = rt::PacketKernel::GetAll();
  ASSERT_GE(kernels.size(), 2u);
  EXPECT_EQ(kernels.front().Width, 1);
  EXPECT_GT(rt::PacketKernel::GetBest().Width, 1);
  for (const rt::PacketKernel& kernel : kernels)
  {
    EXPECT_LE(kernel.Width, rt::PacketKernel::GetBest().Width) << kernel.Name;
  }
}
