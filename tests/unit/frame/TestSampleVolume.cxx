// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sample/SampleVolume.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace
{

std::vector<std::byte> Fill(
  const bricks::SampleVolume& volume, const bricks::Box& box, bricks::ScalarType type)
{
  std::vector<std::byte> bytes(box.GetCount() * bricks::GetBytes(type));
  volume.Fill(box, type, bytes.data());
  return bytes;
}

} // namespace

TEST(SampleVolume, PiecesAreThePartsOfTheWhole)
{
  for (const auto kind :
    { bricks::SampleVolume::Kind::Sphere, bricks::SampleVolume::Kind::MixingLayer })
  {
    const bricks::SampleVolume volume(kind, { 20, 17, 23 });
    const auto whole = Fill(volume, { { 0, 0, 0 }, { 20, 17, 23 } }, bricks::ScalarType::Float32);
    const bricks::Box box{ { 3, 5, 7 }, { 11, 6, 20 } };
    const auto piece = Fill(volume, box, bricks::ScalarType::Float32);
    std::size_t at = 0;
    for (auto k = box.Min.z; k < box.Max.z; ++k)
    {
      for (auto i = box.Min.x; i < box.Max.x; ++i, ++at)
      {
        const std::size_t inWhole = i + 20 * (5 + 17 * k);
        EXPECT_EQ(std::memcmp(&piece[4 * at], &whole[4 * inWhole], 4), 0);
      }
    }
  }
}

TEST(SampleVolume, SphereIsARadiusWithNoise)
{
  const bricks::SampleVolume volume(bricks::SampleVolume::Kind::Sphere, bricks::Index3(64));
  EXPECT_NEAR(volume.GetSpacing(), 2.0 / 64.0, 1e-15);
  double largest = 0.0;
  for (std::int64_t at = 0; at < 64; ++at)
  {
    const glm::dvec3 p = volume.GetOrigin() + volume.GetSpacing() * glm::dvec3(at);
    largest = std::max(largest, std::fabs(volume.Evaluate(at, at, at) - glm::dot(p, p)));
  }
  // Noise of amplitude 0.22 with a gain of one half stays below 0.44.
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(largest, 0.44);
}

TEST(SampleVolume, IntegersAreScaledAndRounded)
{
  const bricks::SampleVolume volume(bricks::SampleVolume::Kind::Sphere, bricks::Index3(8));
  const bricks::Box box{ { 0, 0, 0 }, { 8, 8, 8 } };
  const auto bytes = Fill(volume, box, bricks::ScalarType::UInt8);
  const auto shorts = Fill(volume, box, bricks::ScalarType::Int16);
  for (std::int64_t at = 0; at < 8; ++at)
  {
    const std::size_t index = at + 8 * (at + 8 * at);
    const double expected = std::floor(64.0 * std::max(volume.Evaluate(at, at, at), 0.0) + 0.5);
    EXPECT_EQ(std::to_integer<int>(bytes[index]), expected);
    std::int16_t value;
    std::memcpy(&value, &shorts[2 * index], 2);
    EXPECT_EQ(value, expected);
  }
}
