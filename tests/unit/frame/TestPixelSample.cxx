// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/PixelSample.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

constexpr float Opacity = 0.15f;

/// A sample of so many equal sheets at equal distances.
rt::PixelSample AddSheets(int sheets)
{
  rt::PixelSample sample;
  float left = 1.0f;
  for (int sheet = 0; sheet < sheets; ++sheet)
  {
    sample.AddLayer(
      glm::vec4(Opacity * left), static_cast<float>(sheet + 1) / static_cast<float>(sheets + 1));
    left *= 1.0f - Opacity;
  }
  return sample;
}

/// The part of an object at this depth that is seen.
float GetSeen(const rt::PixelSample& sample, float depth)
{
  float seen = 1.0f;
  for (int layer = 0; layer < sample.Layers; ++layer)
  {
    seen -= sample.LayerDepths[layer] < depth ? sample.LayerColors[layer].w : 0.0f;
  }
  return seen;
}

} // namespace

TEST(TestPixelSample, ObjectsAmidManySheetsAreSeen)
{
  for (const int sheets : { 3, 8, 9, 20, 60 })
  {
    const rt::PixelSample sample = AddSheets(sheets);
    float all = 0.0f;
    for (int layer = 0; layer < sample.Layers; ++layer)
    {
      all += sample.LayerColors[layer].w;
      EXPECT_TRUE(layer == 0 || sample.LayerDepths[layer - 1] <= sample.LayerDepths[layer]);
    }
    EXPECT_NEAR(all, 1.0f - std::pow(1.0f - Opacity, static_cast<float>(sheets)), 1e-5f);
    for (int before = 0; before <= sheets; ++before)
    {
      const float depth = (static_cast<float>(before) + 0.5f) / static_cast<float>(sheets + 1);
      const float right = std::pow(1.0f - Opacity, static_cast<float>(before));
      EXPECT_NEAR(
        GetSeen(sample, depth), right, sheets > rt::PixelSample::MaxLayers ? 0.13f : 1e-5f)
        << before << " of " << sheets << " sheets in front";
    }
  }
}
