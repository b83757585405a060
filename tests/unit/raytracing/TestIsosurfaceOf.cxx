// SPDX-License-Identifier: BSD-3-Clause
// What an isosurface says of itself, by its two sides.
#include "DSMRayTracing/scene/SceneObject.h"

#include <gtest/gtest.h>

namespace
{

rt::Material MakeMaterial(float opacity)
{
  rt::Material material;
  material.Opacity = opacity;
  return material;
}

} // namespace

TEST(IsosurfaceOf, BothSidesAreAlikeWithoutABack)
{
  rt::LatticeIsosurface object;
  object.Look.Surface = MakeMaterial(1.0f);
  EXPECT_EQ(object.Look.GetSurface(true), &object.Look.Surface);
  EXPECT_TRUE(object.IsOpaque());
  EXPECT_TRUE(object.Look.IsSeen());
  object.Look.Surface = MakeMaterial(0.0f);
  EXPECT_FALSE(object.IsOpaque());
  EXPECT_FALSE(object.Look.IsSeen());
}

TEST(IsosurfaceOf, ABackCountsForItself)
{
  rt::LatticeIsosurface object;
  object.Look.Surface = MakeMaterial(1.0f);
  object.Look.BackSurface = MakeMaterial(0.5f);
  EXPECT_EQ(object.Look.GetSurface(false), &object.Look.Surface);
  EXPECT_EQ(object.Look.GetSurface(true), &*object.Look.BackSurface);
  EXPECT_FALSE(object.IsOpaque());
  object.Look.Surface = MakeMaterial(0.0f);
  EXPECT_TRUE(object.Look.IsSeen());
  object.Look.BackSurface = MakeMaterial(0.0f);
  EXPECT_FALSE(object.Look.IsSeen());
}

TEST(IsosurfaceOf, LightPassesASideThatIsCulled)
{
  rt::LatticeIsosurface object;
  object.Look.CullsBack = true;
  EXPECT_EQ(object.Look.GetSurface(true), nullptr);
  EXPECT_FALSE(object.IsOpaque());
  EXPECT_TRUE(object.Look.IsSeen());
  object.Look.CullsFront = true;
  EXPECT_FALSE(object.Look.IsSeen());
  object.Look.Blocks = std::make_shared<const rt::BlockLooks>(
    std::vector<rt::BlockLooks::Block>{ { { { 0, 0, 0 }, { 5, 5, 5 } }, { {}, 0.5f } } });
  EXPECT_FALSE(object.Look.IsSeen()) << "whatever the blocks' opacities are";
}
