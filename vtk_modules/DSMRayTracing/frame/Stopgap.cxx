// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/Stopgap.h"

#include "DSMRayTracing/frame/TileGrid.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

namespace
{

/// A pixel without a surface is a gap if so many of its eight neighbors have one.
constexpr int NeighborsOfGap = 5;
/// How often gaps are closed: the first time leaves the middle of wide ones.
constexpr int Closings = 2;

void Copy(const Picture& from, std::size_t source, Picture& to, std::size_t target)
{
  std::copy_n(&from.Color[4 * source], 4, &to.Color[4 * target]);
  to.Depth[target] = from.Depth[source];
}

/// For the same camera.
Picture Resize(const Picture& earlier, const FrameRequest& request)
{
  Picture picture = Picture::Create(request.Width, request.Height, earlier.Layers);
  for (int row = 0; row < picture.Layers * picture.Height; ++row)
  {
    const int layer = row / picture.Height;
    const double y = (row % picture.Height + 0.5) * earlier.Height / picture.Height;
    const std::size_t first =
      (static_cast<std::size_t>(layer) * earlier.Height + static_cast<std::size_t>(y)) *
      static_cast<std::size_t>(earlier.Width);
    for (int x = 0; x < picture.Width; ++x)
    {
      const auto column = static_cast<std::size_t>((x + 0.5) * earlier.Width / picture.Width);
      Copy(earlier, first + column, picture, static_cast<std::size_t>(row) * picture.Width + x);
    }
  }
  return picture;
}

/// Gives each gap in a layer the mean color of its neighbors, and the depth of the farthest.
void CloseGaps(Picture& picture, std::size_t first)
{
  const Picture before = picture;
  for (int y = 1; y + 1 < picture.Height; ++y)
  {
    for (int x = 1; x + 1 < picture.Width; ++x)
    {
      const std::size_t pixel = first + static_cast<std::size_t>(y) * picture.Width + x;
      if (before.Color[4 * pixel + 3] != 0)
      {
        continue;
      }
      int count = 0;
      int sum[4] = { 0, 0, 0, 0 };
      float depth = 0.0f;
      for (int neighbor = 0; neighbor < 9; ++neighbor)
      {
        const std::size_t other = pixel + static_cast<std::size_t>(neighbor / 3) * picture.Width +
          static_cast<std::size_t>(neighbor % 3) - static_cast<std::size_t>(picture.Width) - 1;
        if (before.Color[4 * other + 3] != 0)
        {
          ++count;
          depth = std::max(depth, before.Depth[other]);
          for (int channel = 0; channel < 4; ++channel)
          {
            sum[channel] += before.Color[4 * other + channel];
          }
        }
      }
      if (count >= NeighborsOfGap)
      {
        for (int channel = 0; channel < 4; ++channel)
        {
          picture.Color[4 * pixel + channel] = static_cast<std::uint8_t>(sum[channel] / count);
        }
        picture.Depth[pixel] = depth;
      }
    }
  }
}

/// Moves the pixels of one layer, of which the nearest is seen.
void MoveLayer(
  const Picture& earlier, const glm::dmat4& change, float depthWithout, int layer, Picture& picture)
{
  const std::size_t first = static_cast<std::size_t>(layer) * picture.Width * picture.Height;
  const int edge = std::max({ 1, (picture.Width + earlier.Width / 2) / earlier.Width,
    (picture.Height + earlier.Height / 2) / earlier.Height });
  for (int y = 0; y < earlier.Height; ++y)
  {
    for (int x = 0; x < earlier.Width; ++x)
    {
      const std::size_t source =
        (static_cast<std::size_t>(layer) * earlier.Height + y) * earlier.Width + x;
      if (earlier.Color[4 * source + 3] == 0)
      {
        continue;
      }
      const float depth = earlier.Depth[source] < 1.0f ? earlier.Depth[source] : depthWithout;
      const glm::dvec4 clip = change *
        glm::dvec4(2.0 * (x + 0.5) / earlier.Width - 1.0, 2.0 * (y + 0.5) / earlier.Height - 1.0,
          2.0 * static_cast<double>(depth) - 1.0, 1.0);
      if (clip.w <= 0.0 || std::abs(clip.z) > clip.w)
      {
        continue;
      }
      const double left = 0.5 * (clip.x / clip.w + 1.0) * picture.Width - 0.5 * edge;
      const double lower = 0.5 * (clip.y / clip.w + 1.0) * picture.Height - 0.5 * edge;
      if (!(std::abs(left) <= picture.Width) || !(std::abs(lower) <= picture.Height))
      {
        continue;
      }
      const auto moved = static_cast<float>(0.5 * (clip.z / clip.w + 1.0));
      for (int part = 0; part < edge * edge; ++part)
      {
        const int column = static_cast<int>(std::lround(left)) + part % edge;
        const int row = static_cast<int>(std::lround(lower)) + part / edge;
        if (column < 0 || row < 0 || column >= picture.Width || row >= picture.Height)
        {
          continue;
        }
        const std::size_t target = first + static_cast<std::size_t>(row) * picture.Width + column;
        if (picture.Color[4 * target + 3] == 0 || moved < picture.Depth[target])
        {
          Copy(earlier, source, picture, target);
          picture.Depth[target] = moved;
        }
      }
    }
  }
  for (int closing = 0; closing < Closings; ++closing)
  {
    CloseGaps(picture, first);
  }
}

} // namespace

Picture Stopgap::Move(const Picture& earlier, const glm::dmat4& from, const FrameRequest& request,
  const glm::dvec3& middle)
{
  if (earlier.Width < 1 || earlier.Height < 1)
  {
    return Picture::Create(request.Width, request.Height);
  }
  if (from == request.WorldToClip)
  {
    return Resize(earlier, request);
  }
  Picture picture = Picture::Create(request.Width, request.Height, earlier.Layers);
  const glm::dmat4 change = request.WorldToClip * glm::inverse(from);
  const glm::dvec4 there = from * glm::dvec4(middle, 1.0);
  const double depth = there.w > 0.0 ? 0.5 * (there.z / there.w + 1.0) : 1.0;
  for (int layer = 0; layer < earlier.Layers; ++layer)
  {
    MoveLayer(earlier, change, static_cast<float>(std::clamp(depth, 0.0, 1.0)), layer, picture);
  }
  return picture;
}

void Stopgap::Cover(const Frame& frame, const Picture& traced, Picture& stopgap)
{
  const TileGrid grid(frame.Width, frame.Height, frame.TileSize);
  const std::size_t pixels = static_cast<std::size_t>(frame.Width) * frame.Height;
  stopgap.Layers = std::max(stopgap.Layers, traced.Layers);
  stopgap.Resize(pixels * stopgap.Layers);
  const Picture empty = Picture::Create(1, 1);
  for (int index = 0; index < grid.GetCount(); ++index)
  {
    if (std::binary_search(frame.Left.begin(), frame.Left.end(), index))
    {
      continue;
    }
    const Tile tile = grid.CreateTile(index);
    for (int layer = 0; layer < stopgap.Layers; ++layer)
    {
      for (int pixel = 0; pixel < tile.Width * tile.Height; ++pixel)
      {
        const std::size_t place = layer * pixels +
          static_cast<std::size_t>(tile.Y + pixel / tile.Width) * frame.Width + tile.X +
          pixel % tile.Width;
        const bool isThere = layer < traced.Layers;
        Copy(isThere ? traced : empty, isThere ? place : 0, stopgap, place);
      }
    }
  }
}

} // namespace rt
