// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/PixelRays.h"

#include "DSMCore/base/Error.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace
{

rt::FrameRequest CreateRequest(const glm::dmat4& worldToClip)
{
  rt::FrameRequest request;
  request.Width = 101;
  request.Height = 51;
  request.WorldToClip = worldToClip;
  return request;
}

const glm::dvec3 Eye(3.0, -2.0, 7.0);
const glm::dvec3 Focus(0.5, 0.25, -1.0);

glm::dmat4 LookAtFocus()
{
  return glm::lookAt(Eye, Focus, glm::dvec3(0.0, 1.0, 0.0));
}

} // namespace

TEST(PixelRays, PerspectiveRaysComeFromTheEye)
{
  const rt::PixelRays rays(
    CreateRequest(glm::perspective(0.6, 101.0 / 51.0, 0.5, 40.0) * LookAtFocus()));
  for (const auto& pixel : { glm::ivec2(0, 0), glm::ivec2(100, 50), glm::ivec2(13, 40) })
  {
    const rt::Ray ray = rays.GetRay(pixel.x, pixel.y);
    const glm::dvec3 direction = glm::normalize(ray.Direction);
    EXPECT_LT(glm::length(glm::cross(direction, Eye - ray.Origin)), 1e-9);
  }
  const rt::Ray center = rays.GetRay(50, 25);
  EXPECT_NEAR(
    glm::length(glm::normalize(center.Direction) - glm::normalize(Focus - Eye)), 0.0, 1e-9);
  EXPECT_NEAR(glm::length(center.Origin - Eye), 0.5, 1e-9);
  EXPECT_NEAR(glm::length(center.Origin + center.Direction - Eye), 40.0, 1e-7);
}

TEST(PixelRays, ParallelRaysAreParallel)
{
  const rt::PixelRays rays(
    CreateRequest(glm::ortho(-2.0, 2.0, -1.0, 1.0, 0.5, 40.0) * LookAtFocus()));
  const glm::dvec3 expected = glm::normalize(Focus - Eye);
  for (const auto& pixel : { glm::ivec2(0, 0), glm::ivec2(100, 50) })
  {
    const glm::dvec3 direction = glm::normalize(rays.GetRay(pixel.x, pixel.y).Direction);
    EXPECT_NEAR(glm::length(direction - expected), 0.0, 1e-9);
  }
}

TEST(PixelRays, DepthIsThatOfTheDepthBuffer)
{
  const double nearPlane = 0.5;
  const double farPlane = 40.0;
  const rt::PixelRays rays(
    CreateRequest(glm::perspective(0.6, 101.0 / 51.0, nearPlane, farPlane) * LookAtFocus()));
  const glm::dvec3 direction = glm::normalize(Focus - Eye);
  EXPECT_NEAR(rays.GetDepth(Eye + nearPlane * direction), 0.0, 1e-6);
  EXPECT_NEAR(rays.GetDepth(Eye + farPlane * direction), 1.0, 1e-6);
  const double distance = 3.0;
  const double expected = farPlane * (distance - nearPlane) / (distance * (farPlane - nearPlane));
  EXPECT_NEAR(rays.GetDepth(Eye + distance * direction), expected, 1e-6);
}

TEST(PixelRays, SingularMatrixIsRefused)
{
  EXPECT_THROW(rt::PixelRays{ CreateRequest(glm::dmat4(0.0)) }, dsm::Error);
}
