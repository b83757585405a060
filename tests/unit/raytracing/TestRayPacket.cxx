// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/kernel/PacketTracer.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace
{

/// Packets of rays between four corners, as those of a tile are.
class Beam
{
public:
  static constexpr int Packets = 3;
  static constexpr int RayCount = Packets * rt::RayPacket::Size;

  /// `spread`: how far apart the rays are at the volume, in parts of its size.
  Beam(const rt::Index3& cells, unsigned seed, double spread)
    : Random(seed)
  {
    const glm::dvec3 size(cells);
    const double largest = std::max({ size.x, size.y, size.z });
    const glm::dvec3 target = size * glm::dvec3(this->Get(), this->Get(), this->Get());
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
Tally ComparePackets(const TestVolume<T>& volume, const std::vector<double>& isovalues, int edge)
{
  MemoryStore store;
  MemoryStore::Worker worker;
  const rt::IsosurfaceObject object = CreateObject(store, volume, isovalues, edge);
  const rt::VolumeTracer<MemoryStore> alone(store, worker);
  Tally tally;
  for (const rt::PacketKernel& kernel : rt::PacketKernel::GetAll())
  {
    SCOPED_TRACE(kernel.Name);
    const rt::PacketTracer<MemoryStore> tracer(store, worker, kernel);
    for (unsigned seed = 0; seed < 60; ++seed)
    {
      const Beam beam(volume.GetCells(), seed, seed % 2 == 0 ? 0.05 : 0.6);
      const rt::BeamBricks bricks = tracer.FindBricks(object, beam.Corners);
      tally.Shared += bricks.Usable;
      rt::SurfaceHit hits[Beam::RayCount];
      rt::RayPacket::Mask wanted[Beam::Packets] = { 0xffffu, 0x9137u, seed % 5 == 0 ? 0u : 1u };
      rt::RayPacket::Mask found[Beam::Packets];
      tracer.Intersect(object, bricks, Beam::Packets, beam.Rays, wanted, hits, found);
      for (int index = 0; index < Beam::RayCount; ++index)
      {
        const int packet = index / rt::RayPacket::Size;
        const rt::RayPacket::Mask bit = 1u << index % rt::RayPacket::Size;
        rt::SurfaceHit expected;
        const bool hit =
          (wanted[packet] & bit) != 0 && alone.Intersect(object, beam.Rays[index], expected);
        EXPECT_EQ((found[packet] & bit) != 0, hit) << "beam " << seed << ", ray " << index;
        if (hit && (found[packet] & bit) != 0)
        {
          ++tally.Hits;
          EXPECT_EQ(hits[index].T, expected.T) << "beam " << seed << ", ray " << index;
          EXPECT_EQ(hits[index].Normal, expected.Normal);
          EXPECT_EQ(hits[index].IndexPoint, expected.IndexPoint);
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

template <class T>
TestVolume<T> CreateWaves(const rt::Index3& points)
{
  return TestVolume<T>(points,
    [](int x, int y, int z)
    {
      const double wave = std::sin(0.4 * x + 1) + std::sin(0.5 * y) + std::sin(0.3 * z + 0.2 * x);
      return static_cast<T>(std::is_signed_v<T> ? 40.0 * wave : 128.0 + 40.0 * wave);
    });
}

template <class T>
TestVolume<T> CreateNoise(const rt::Index3& points)
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
