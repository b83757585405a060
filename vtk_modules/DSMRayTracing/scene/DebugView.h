// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_DebugView_h
#define rt_DebugView_h

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>

namespace rt
{

/// Diagnostic quantity that colors the surfaces instead of their material. Images of TracingRank
/// and TileTime depend on the frame and on the number of ranks, because the quantities do; so do
/// NewTiles and Misses.
enum class DebugView
{
  Off,
  Owner,       ///< which rank owns the brick (the paper's Fig. 2)
  TracingRank, ///< which rank traced the pixel (the paper's Fig. 1)
  Brick,       ///< which brick, or treelet, it is
  TileTime,    ///< how long the tile took: black, red, yellow, white at LongTileSeconds
  Normal,      ///< x, y, z of the world as red, green, blue
  Depth,       ///< near is bright, far is dark
  NewTiles,    ///< red: another rank traced the tile in the last frame (the paper's Fig. 9)
  Misses,      ///< how many bricks the tile waited for: black, red, yellow, white at ManyMisses
  Level        ///< level of detail of a volume file
};

/// Returns whether a view shows a number of each brick.
inline bool IsOfBricks(DebugView view)
{
  return view == DebugView::Owner || view == DebugView::Brick || view == DebugView::Level;
}

/// A tile that takes as long, or longer, is white.
constexpr double LongTileSeconds = 0.002;

/// A tile that waited for as many bricks, or more, is white.
constexpr std::uint64_t ManyMisses = 16;

/// Color of a tile that another rank traced in the last frame.
inline glm::vec3 GetNewTileColor()
{
  return { 1.0f, 0.2f, 0.1f };
}

/// Colors of numbers: neighboring numbers differ much (hues at steps of the golden ratio).
inline glm::vec3 GetNumberColor(std::uint64_t number)
{
  const double hue = std::fmod(0.61803398874989484 * static_cast<double>(number), 1.0);
  const glm::vec3 phase = glm::vec3(0.0f, 4.0f, 2.0f) + static_cast<float>(6.0 * hue);
  return glm::clamp(
    glm::abs(glm::mod(phase, 6.0f) - 3.0f) - 1.0f, glm::vec3(0.15f), glm::vec3(1.0f));
}

/// Black, red, yellow, white.
inline glm::vec3 GetHeatColor(double part)
{
  const float heat = static_cast<float>(3.0 * part);
  return glm::clamp(glm::vec3(heat, heat - 1.0f, heat - 2.0f), 0.0f, 1.0f);
}

} // namespace rt

#endif
