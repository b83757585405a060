// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/TileGrid.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

void ExpectEveryPixelOnce(int width, int height, int tileSize)
{
  const rt::TileGrid grid(width, height, tileSize);
  std::vector<int> times(static_cast<std::size_t>(width) * height, 0);
  for (int index = 0; index < grid.GetCount(); ++index)
  {
    const rt::Tile tile = grid.CreateTile(index);
    EXPECT_EQ(tile.Index, index);
    ASSERT_GT(tile.Width, 0);
    ASSERT_GT(tile.Height, 0);
    for (int y = tile.Y; y < tile.Y + tile.Height; ++y)
    {
      for (int x = tile.X; x < tile.X + tile.Width; ++x)
      {
        ++times.at(static_cast<std::size_t>(y) * width + x);
      }
    }
  }
  for (const int count : times)
  {
    ASSERT_EQ(count, 1) << width << " x " << height << " in tiles of " << tileSize;
  }
}

} // namespace

TEST(TileGrid, ImageOfWholeTiles)
{
  ExpectEveryPixelOnce(64, 32, 16);
  EXPECT_EQ(rt::TileGrid(64, 32, 16).GetCount(), 8);
}

TEST(TileGrid, OddImageSize)
{
  ExpectEveryPixelOnce(97, 61, 16);
  ExpectEveryPixelOnce(1, 1, 16);
  ExpectEveryPixelOnce(17, 1, 16);
  ExpectEveryPixelOnce(5, 33, 7);
}
