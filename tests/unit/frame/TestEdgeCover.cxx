// SPDX-License-Identifier: BSD-3-Clause
// The lines along the sides of triangles, in pixels.
#include "DSMBricks/layout/MeshAttributes.h"
#include "DSMRayTracing/frame/PixelRays.h"
#include "DSMRayTracing/mesh/EdgeCover.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <initializer_list>

namespace
{

/// A camera at z = 5 that looks down the z axis, on a picture of 200 x 100 pixels.
rt::FrameRequest CreateEdgeRequest(const glm::dmat4& projection)
{
  rt::FrameRequest request;
  request.Width = 200;
  request.Height = 100;
  request.WorldToClip =
    projection * glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  return request;
}

/// A tenth of a world unit is a pixel.
glm::dmat4x3 GetParallelView()
{
  return rt::PixelRays(CreateEdgeRequest(glm::ortho(-10.0, 10.0, -5.0, 5.0, 0.0, 20.0)))
    .GetView()
    .WorldToPixels;
}

constexpr unsigned FirstSide = 1;

} // namespace

TEST(EdgeCover, IsWholeOnTheLineAndFallsOffWithinAPixel)
{
  const glm::dmat4x3 view = GetParallelView();
  // A triangle on a slant, which makes no difference to what is seen.
  const glm::dvec3 corners[3] = { { -4.0, 0.0, 0.0 }, { 4.0, 0.0, 2.0 }, { 0.0, 6.0, 3.0 } };
  for (double pixels = 0.05; pixels < 4.0; pixels += 0.1)
  {
    const glm::dvec3 place(0.3, 0.1 * pixels, 1.4);
    for (const float width : { 1.1f, 3.0f, 5.0f })
    {
      const double expected = std::clamp(0.5 + 0.5 * width - pixels, 0.0, 1.0);
      EXPECT_NEAR(rt::GetEdgeCover(place, corners, FirstSide, width, view), expected, 1e-9);
    }
  }
}

TEST(EdgeCover, OnlySidesThatAreEdgesCount)
{
  const glm::dmat4x3 view = GetParallelView();
  const glm::dvec3 corners[3] = { { -4.0, -3.0, 0.0 }, { 4.0, -3.0, 0.0 }, { 0.0, 5.0, 0.0 } };
  const glm::dvec3 middles[3] = { { 0.0, -2.99, 0.0 }, { 1.99, 1.0, 0.0 }, { -1.99, 1.0, 0.0 } };
  for (int side = 0; side < 3; ++side)
  {
    for (unsigned flags = 0; flags <= bricks::AllEdges; ++flags)
    {
      EXPECT_EQ(rt::GetEdgeCover(middles[side], corners, flags, 2.0f, view),
        (flags >> side & 1u) != 0 ? 1.0 : 0.0)
        << side << ", " << flags;
    }
  }
}

TEST(EdgeCover, AsManyPixelsNearAndFarAlsoFarFromTheWorldsOrigin)
{
  for (const double away : { 0.0, 1e6 })
  {
    const glm::dvec3 center(away, -away, away);
    rt::FrameRequest request;
    request.Width = request.Height = 100;
    // Half the height is the distance; 50 pixels.
    request.WorldToClip = glm::perspective(2.0 * std::atan(1.0), 1.0, 0.1, 100.0) *
      glm::lookAt(center, center - glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 1.0, 0.0));
    const glm::dmat4x3 view = rt::PixelRays(request).GetView().WorldToPixels;
    for (const double distance : { 1.0, 5.0, 40.0 })
    {
      const glm::dvec3 corners[3] = { center + distance * glm::dvec3(-0.5, 0.0, -1.0),
        center + distance * glm::dvec3(0.5, 0.0, -1.0),
        center + distance * glm::dvec3(0.0, 0.7, -1.0) };
      const glm::dvec3 place = center + distance * glm::dvec3(0.1, 1.5 / 50.0, -1.0);
      EXPECT_NEAR(rt::GetEdgeCover(place, corners, FirstSide, 3.0f, view), 0.5, 1e-4) << distance;
    }
  }
}

TEST(EdgeCover, CornersBehindTheCamera)
{
  const glm::dmat4x3 view = rt::PixelRays(CreateEdgeRequest(glm::perspective(1.0, 2.0, 0.1, 100.0)))
                              .GetView()
                              .WorldToPixels;
  // The same line, by a far end before the camera or behind it; the other sides are out of view.
  const glm::dvec3 before[3] = { { 1.0, -1.0, -30.0 }, { 1.0, -1.0, 4.0 }, { -30.0, -1.0, -10.0 } };
  const glm::dvec3 behind[3] = { before[0], { 1.0, -1.0, 20.0 }, before[2] };
  for (double x = 0.5; x < 1.0; x += 0.05)
  {
    const glm::dvec3 place(x, -1.0, -2.0);
    EXPECT_NEAR(rt::GetEdgeCover(place, behind, FirstSide, 4.0f, view),
      rt::GetEdgeCover(place, before, FirstSide, 4.0f, view), 1e-9);
  }
  EXPECT_EQ(rt::GetEdgeCover({ 0.99, -1.0, -2.0 }, behind, FirstSide, 4.0f, view), 1.0);
  EXPECT_EQ(rt::GetEdgeCover({ 0.5, -1.0, -2.0 }, behind, FirstSide, 4.0f, view), 0.0);
}

TEST(EdgeCover, AMirrorShowsWhatIsBehindItsPlane)
{
  const rt::PictureView view =
    rt::PixelRays(CreateEdgeRequest(glm::perspective(1.0, 2.0, 0.1, 100.0))).GetView();
  const glm::dvec3 position(0.3, -0.2, -1.0);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 0.7, 0.5));
  const glm::dmat4x3 mirrored = view.GetMirrored(position, normal).WorldToPixels;
  for (const glm::dvec3& point : { glm::dvec3(1.0, 2.0, 0.5), glm::dvec3(-2.0, 0.3, 1.5) })
  {
    const glm::dvec3 image = position + glm::reflect(point - position, normal);
    const glm::dvec3 expected = view.WorldToPixels * glm::dvec4(image, 1.0);
    const glm::dvec3 found = mirrored * glm::dvec4(point, 1.0);
    EXPECT_NEAR(glm::distance(found, expected), 0.0, 1e-9);
  }
}
