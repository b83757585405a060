// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/Stopgap.h"

#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace
{

constexpr int Size = 64;

/// From the middle of a square, whose distance decides its depth.
glm::dmat4 Look(double azimuth)
{
  const glm::dvec3 eye(4.0 * std::sin(azimuth), 0.0, 4.0 * std::cos(azimuth));
  return glm::perspective(0.6, 1.0, 1.0, 10.0) *
    glm::lookAt(eye, glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
}

rt::FrameRequest CreateRequest(const glm::dmat4& worldToClip, int size)
{
  rt::FrameRequest request;
  request.Width = request.Height = size;
  request.WorldToClip = worldToClip;
  return request;
}

float GetDepth(const glm::dmat4& worldToClip, const glm::dvec3& place)
{
  const glm::dvec4 clip = worldToClip * glm::dvec4(place, 1.0);
  return static_cast<float>(0.5 * clip.z / clip.w + 0.5);
}

/// A square of `half` pixels around the middle, at the depth of the origin; red on its left.
rt::Picture DrawSquare(const glm::dmat4& worldToClip, int half)
{
  rt::Picture picture = rt::Picture::Create(Size, Size);
  for (int y = Size / 2 - half; y < Size / 2 + half; ++y)
  {
    for (int x = Size / 2 - half; x < Size / 2 + half; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * Size + x;
      picture.Color[4 * pixel] = x < Size / 2 ? 255 : 0;
      picture.Color[4 * pixel + 3] = 255;
      picture.Depth[pixel] = GetDepth(worldToClip, glm::dvec3(0.0));
    }
  }
  return picture;
}

int CountCovered(const rt::Picture& picture)
{
  int count = 0;
  for (std::size_t pixel = 0; pixel < picture.Depth.size(); ++pixel)
  {
    count += picture.Color[4 * pixel + 3] != 0 ? 1 : 0;
  }
  return count;
}

TEST(Stopgap, KeepsAPictureOfTheSameCamera)
{
  const rt::Picture picture = DrawSquare(Look(0.0), 16);
  const auto larger =
    rt::Stopgap::Move(picture, Look(0.0), CreateRequest(Look(0.0), 2 * Size), glm::dvec3(0.0));
  EXPECT_EQ(CountCovered(larger), 4 * CountCovered(picture));
  EXPECT_EQ(larger.Color[4 * (static_cast<std::size_t>(Size) * 2 * Size + Size - 1)], 255);
  EXPECT_EQ(larger.Color[4 * (static_cast<std::size_t>(Size) * 2 * Size + Size)], 0);
  const auto same =
    rt::Stopgap::Move(picture, Look(0.0), CreateRequest(Look(0.0), Size), glm::dvec3(0.0));
  EXPECT_EQ(same.Color, picture.Color);
  EXPECT_EQ(same.Depth, picture.Depth);
}

TEST(Stopgap, MovesSurfacesByTheirDepth)
{
  const rt::Picture picture = DrawSquare(Look(0.0), 16);
  for (const int size : { Size, Size / 2, 2 * Size })
  {
    const rt::FrameRequest request = CreateRequest(Look(0.1), size);
    const auto moved = rt::Stopgap::Move(picture, Look(0.0), request, glm::dvec3(5.0));
    const double scale = static_cast<double>(size) / Size;
    EXPECT_NEAR(CountCovered(moved), scale * scale * CountCovered(picture),
      0.12 * scale * scale * CountCovered(picture));
    // Both pictures have the origin in the middle, without a gap around it.
    for (int y = size / 2 - size / 8; y < size / 2 + size / 8; ++y)
    {
      for (int x = size / 2 - size / 8; x < size / 2 + size / 8; ++x)
      {
        EXPECT_EQ(moved.Color[4 * (static_cast<std::size_t>(y) * size + x) + 3], 255);
      }
    }
    const std::size_t middle = static_cast<std::size_t>(size / 2) * size + size / 2;
    EXPECT_NEAR(moved.Depth[middle], GetDepth(Look(0.1), glm::dvec3(0.0)), 0.02);
  }
}

TEST(Stopgap, MovesWhatHasNoDepthWithAPlace)
{
  rt::Picture picture = DrawSquare(Look(0.0), 4);
  std::fill(picture.Depth.begin(), picture.Depth.end(), 1.0f);
  const auto moved =
    rt::Stopgap::Move(picture, Look(0.0), CreateRequest(Look(0.2), Size), glm::dvec3(0.0));
  EXPECT_EQ(moved.Color[4 * (Size / 2 * Size + Size / 2) + 3], 255) << "the place stays";
  EXPECT_EQ(CountCovered(rt::Stopgap::Move(
              picture, Look(0.0), CreateRequest(Look(3.1), Size), glm::dvec3(0.0, 0.0, 20.0))),
    0)
    << "a place behind the camera";
}

TEST(Stopgap, GivesWayToTilesOnEveryRank)
{
  rt::Frame frame;
  frame.Width = frame.Height = Size;
  frame.TileSize = 16;
  frame.Left = { 0, 5, 6 };
  const rt::Picture traced = rt::Picture::Create(Size, Size); // another rank has the tiles
  rt::Picture stopgap = DrawSquare(Look(0.0), 32);
  rt::Stopgap::Cover(frame, traced, stopgap);
  EXPECT_EQ(CountCovered(stopgap), 3 * 16 * 16);
  EXPECT_EQ(stopgap.Color[3], 255);
  EXPECT_EQ(stopgap.Depth[16], 1.0f);
  rt::Stopgap::Cover(frame, DrawSquare(Look(0.0), 32), stopgap);
  EXPECT_EQ(CountCovered(stopgap), Size * Size);
}

} // namespace
