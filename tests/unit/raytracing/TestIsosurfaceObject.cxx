// SPDX-License-Identifier: BSD-3-Clause
// What an isosurface says of itself, by its two sides.
#include "DSMRayTracing/volume/IsosurfaceObject.h"

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

TEST(IsosurfaceObject, BothSidesAreAlikeWithoutABack)
{
  rt::IsosurfaceObject object;
  object.Surface = MakeMaterial(1.0f);
  EXPECT_EQ(object.GetSurface(true), &object.Surface);
  EXPECT_TRUE(object.IsOpaque());
  EXPECT_TRUE(object.IsSeen());
  object.Surface = MakeMaterial(0.0f);
  EXPECT_FALSE(object.IsOpaque());
  EXPECT_FALSE(object.IsSeen());
}

TEST(IsosurfaceObject, ABackCountsForItself)
{
  rt::IsosurfaceObject object;
  object.Surface = MakeMaterial(1.0f);
  object.BackSurface = MakeMaterial(0.5f);
  EXPECT_EQ(object.GetSurface(false), &object.Surface);
  EXPECT_EQ(object.GetSurface(true), &*object.BackSurface);
  EXPECT_FALSE(object.IsOpaque());
  object.Surface = MakeMaterial(0.0f);
  EXPECT_TRUE(object.IsSeen());
  object.BackSurface = MakeMaterial(0.0f);
  EXPECT_FALSE(object.IsSeen());
}

TEST(IsosurfaceObject, LightPassesASideThatIsCulled)
{
  rt::IsosurfaceObject object;
  object.CullsBack = true;
  EXPECT_EQ(object.GetSurface(true), nullptr);
  EXPECT_FALSE(object.IsOpaque());
  EXPECT_TRUE(object.IsSeen());
  object.CullsFront = true;
  EXPECT_FALSE(object.IsSeen());
  object.Blocks = std::make_shared<const rt::BlockLooks>(
    std::vector<rt::BlockLooks::Block>{ { { { 0, 0, 0 }, { 5, 5, 5 } }, { {}, 0.5f } } });
  EXPECT_FALSE(object.IsSeen()) << "whatever the blocks' opacities are";
}
