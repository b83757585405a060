// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/LoopbackCluster.h"

#include "DSMRayTracing/frame/FrameGather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{

constexpr int TileEdge = 8;

/// A tile beside those of the other ranks: pixels that nothing covers, that are covered, and that are in part.
rt::Frame CreateFrame(int rank, int ranks)
{
  rt::Frame frame;
  frame.Width = TileEdge * ranks;
  frame.Height = frame.TileSize = TileEdge;
  frame.Channels.Value = rt::ChannelSet::All;
  rt::Tile& tile = frame.Tiles.emplace_back();
  tile.Reset(frame.Channels, TileEdge * TileEdge);
  tile.X = TileEdge * rank;
  tile.Width = tile.Height = TileEdge;
  std::mt19937 random(static_cast<unsigned>(rank));
  for (int pixel = 0; pixel < TileEdge * TileEdge; ++pixel)
  {
    const int kind = static_cast<int>(random() % 3);
    const auto alpha = static_cast<std::uint8_t>(kind == 2 ? 1 + random() % 254 : 255 * kind);
    for (int channel = 0; channel < 3; ++channel)
    {
      tile.Color[4 * pixel + channel] = static_cast<std::uint8_t>(random() % (alpha + 1u));
      tile.Albedo[4 * pixel + channel] = static_cast<std::uint8_t>(random() % (alpha + 1u));
      tile.Normal[3 * pixel + channel] = static_cast<float>(random() % 100);
    }
    tile.Color[4 * pixel + 3] = alpha;
    tile.Depth[pixel] = kind == 0 ? 1.0f : static_cast<float>(random() % 1000) / 1000.0f;
    tile.Object[pixel] = static_cast<std::int32_t>(random());
  }
  return frame;
}

TEST(FrameGather, EdgesComeToAllRanks)
{
  constexpr int ranks = 3;
  RunOnCluster(ranks,
    [](dsm::Messenger& messenger)
    {
      const rt::Frame frame = CreateFrame(messenger.GetRank(), ranks);
      const rt::Picture whole = rt::GatherFrame(messenger, frame);
      rt::Picture mine = rt::AssembleTiles(frame);
      rt::AddEdges(messenger, frame, mine);
      ASSERT_EQ(mine.Color.size(), whole.Color.size());
      int edges = 0;
      for (std::size_t pixel = 0; pixel < whole.Depth.size(); ++pixel)
      {
        const std::uint8_t* const color = &whole.Color[4 * pixel];
        const bool isMine = static_cast<int>(pixel) % frame.Width / TileEdge == messenger.GetRank();
        const bool isEdge = color[3] > 0 && color[3] < 255;
        edges += isEdge ? 1 : 0;
        rt::Channels::ForEach(
          mine,
          [&](const auto& values, std::size_t count, auto empty, const auto& all)
          {
            for (std::size_t at = count * pixel; at < count * (pixel + 1); ++at)
            {
              EXPECT_EQ(values[at], isMine || isEdge ? all[at] : empty) << pixel;
            }
          },
          whole);
      }
      EXPECT_GT(edges, TileEdge);
    });
}

} // namespace
