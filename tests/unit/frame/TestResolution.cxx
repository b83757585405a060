// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/Resolution.h"
#include "DSMRayTracing/frame/SampleWidth.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace
{

/// A picture of a million pixels that takes so many seconds at edge 1.
struct Costs
{
  double Seconds;
  rt::FrameRequest Request;

  explicit Costs(double seconds)
    : Seconds(seconds)
  {
    this->Request.Width = 1000;
    this->Request.Height = 1000;
  }
  rt::Resolution::Shown Show(std::uint64_t content, int edge) const
  {
    return { content, edge, 1e-6 * this->Seconds, true };
  }
  std::vector<int> TryAfter(const rt::Resolution::Shown& shown, std::uint64_t content) const
  {
    std::vector<int> edges;
    for (const auto& next : rt::Resolution::GetTries(shown, content, this->Request))
    {
      edges.push_back(next.Edge);
    }
    return edges;
  }
};

using Edges = std::vector<int>;

TEST(Resolution, DrawsDraftsOfWhatIsNewAndSlow)
{
  EXPECT_EQ(Costs(0.0).TryAfter({}, 1), Edges({ 8 })) << "nothing is known";
  EXPECT_EQ(Costs(0.15).TryAfter(Costs(0.15).Show(1, 1), 2), Edges({ 1, 8 }));
  EXPECT_EQ(Costs(0.35).TryAfter(Costs(0.35).Show(1, 1), 2), Edges({ 2, 8 }));
  EXPECT_EQ(Costs(1.5).TryAfter(Costs(1.5).Show(1, 1), 2), Edges({ 4, 8 }));
  EXPECT_EQ(Costs(5.0).TryAfter(Costs(5.0).Show(1, 1), 2), Edges({ 8 }));
  EXPECT_EQ(Costs(20.0).TryAfter(Costs(20.0).Show(1, 1), 2), Edges({ 16 }));
  rt::Resolution::Shown step = Costs(20.0).Show(1, 1);
  step.MayDraft = false;
  EXPECT_EQ(Costs(20.0).TryAfter(step, 2), Edges({ 1 })) << "of an animation";
  const Costs quick(0.15);
  const auto tries = rt::Resolution::GetTries(quick.Show(1, 1), 2, quick.Request);
  EXPECT_LT(tries.front().Seconds, 0.5) << "what is new may be slower than what was shown";
  EXPECT_TRUE(std::isinf(tries.back().Seconds));
}

TEST(Resolution, RefinesWhatIsShown)
{
  EXPECT_EQ(Costs(1.0).TryAfter(Costs(1.0).Show(1, 8), 1), Edges({ 1 }));
  EXPECT_EQ(Costs(5.0).TryAfter(Costs(5.0).Show(1, 8), 1), Edges({ 4 }));
  EXPECT_EQ(Costs(5.0).TryAfter(Costs(5.0).Show(1, 3), 1), Edges({ 1 }));
  EXPECT_EQ(Costs(5.0).TryAfter(Costs(5.0).Show(1, 4), 1), Edges({ 1 }));
  rt::Resolution::Shown begun = Costs(5.0).Show(1, 1);
  begun.Begun = 2;
  begun.BegunEdge = 8;
  EXPECT_EQ(Costs(5.0).TryAfter(begun, 2), Edges({ 8 })) << "it goes on with what was aborted";
  EXPECT_EQ(Costs(5.0).TryAfter(begun, 1), Edges({ 1 }));
  EXPECT_EQ(Costs(5.0).TryAfter(Costs(5.0).Show(1, 1), 1), Edges({ 1 }));
}

TEST(Resolution, FollowsTheTimeWhileTheCameraMoves)
{
  const auto find = [](double seconds, int least)
  { return rt::Resolution::GetMovingEdge(Costs(seconds).Request, 1e-6 * seconds, least); };
  EXPECT_EQ(find(0.05, 1), 1);
  EXPECT_EQ(find(0.05, 3), 3);
  EXPECT_EQ(find(0.3, 1), 2);
  EXPECT_EQ(find(30.0, 1), 16);
}

TEST(Resolution, KnowsTheContentAtRestAndInMotion)
{
  rt::Scene scene;
  const rt::FrameRequest request = Costs(1.0).Request;
  const std::uint64_t content = rt::Resolution::GetContent(scene, request);
  scene.Transport.FaintShadows = true;
  scene.Transport.MediumErrors = rt::Resolution::MediumErrors;
  EXPECT_EQ(rt::Resolution::GetContent(scene, request), content);
  EXPECT_TRUE(scene.Transport.FaintShadows);
  EXPECT_EQ(scene.Transport.MediumErrors, rt::Resolution::MediumErrors);
  scene.Transport.Shadows = true;
  EXPECT_NE(rt::Resolution::GetContent(scene, request), content);
  const rt::FrameRequest reduced = rt::Resolution::Reduce(request, 3);
  EXPECT_EQ(std::pair(reduced.Width, reduced.Height), std::pair(334, 334));
  EXPECT_EQ(reduced.PixelSize, 3);
}

} // namespace

/// Samples are a tenth of the world's unit apart, along each axis, in a cube of edge 1 around the origin.
TEST(SampleWidth, IsThatOfTheNearestSamplesInThePicture)
{
  const glm::dmat4 indexToWorld =
    glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5)), glm::dvec3(0.1));
  rt::FrameRequest request;
  request.Width = 200;
  request.Height = 100;
  const auto getWidth = [&] { return rt::GetSampleWidth(request, indexToWorld, glm::dvec3(10.0)); };

  // A world unit is 100 pixels on each axis.
  request.WorldToClip = glm::ortho(-1.0, 1.0, -0.5, 0.5, 1.0, 9.0) *
    glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  EXPECT_NEAR(getWidth(), 10.0, 1e-9);

  const auto look = [&](double distance, double x)
  {
    request.WorldToClip = glm::perspective(0.5, 2.0, 0.01, 100.0) *
      glm::lookAt(glm::dvec3(x, 0.0, distance), glm::dvec3(x, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0));
  };
  const auto getExact = [](double depth) { return 0.1 * 50.0 / (std::tan(0.25) * depth); };
  for (const double distance : { 2.0, 5.0, 20.0 })
  {
    look(distance, 0.0);
    EXPECT_GE(getWidth(), 0.99 * getExact(distance - 0.5));
    EXPECT_LE(getWidth(), 1.2 * getExact(distance - 0.5));
  }
  // The nearest corner of the cube is beside the picture, but the middle of its face is in it.
  look(0.6, 0.0);
  EXPECT_NEAR(getWidth(), getExact(0.1), 0.2 * getExact(0.1));
  // The whole cube is.
  look(2.0, 50.0);
  EXPECT_EQ(getWidth(), 0.0);
  request.WorldToClip = glm::perspective(0.5, 2.0, 0.01, 100.0) *
    glm::lookAt(glm::dvec3(0.0, 0.0, 2.0), glm::dvec3(0.0, 0.0, 9.0), glm::dvec3(0.0, 1.0, 0.0));
  EXPECT_EQ(getWidth(), 0.0);
  // A camera among the samples has some at its near plane, about.
  look(0.2, 0.0);
  EXPECT_GT(getWidth(), getExact(0.1));
}

/// The bounds of what is seen are those of the samples that a picture shows, one by one.
TEST(SeenPart, HasTheBoundsOfWhatIsSeen)
{
  const glm::dvec3 last(40.0, 30.0, 50.0);
  const glm::dmat4 indexToWorld = glm::scale(
    glm::translate(glm::dmat4(1.0), glm::dvec3(-2.0, 1.0, 3.0)), glm::dvec3(0.1, 0.2, 0.1));
  rt::FrameRequest request;
  request.Width = 300;
  request.Height = 200;
  const glm::dvec3 middle(indexToWorld * glm::dvec4(0.5 * last, 1.0));
  const auto check = [&](const glm::dmat4& worldToClip, double depth)
  {
    request.WorldToClip = worldToClip;
    std::optional<rt::SeenPart::Bounds> expected;
    for (double z = 0.0; z <= last.z; z += 0.5)
    {
      for (double y = 0.0; y <= last.y; y += 0.5)
      {
        for (double x = 0.0; x <= last.x; x += 0.5)
        {
          const glm::dvec3 place(x, y, z);
          const glm::dvec4 clip = worldToClip * indexToWorld * glm::dvec4(place, 1.0);
          if (std::max({ std::abs(clip.x), std::abs(clip.y), std::abs(clip.z) }) > clip.w ||
            clip.w > depth)
          {
            continue;
          }
          expected = expected ? rt::SeenPart::Bounds{ glm::min(expected->Lower, place),
            glm::max(expected->Upper, place), std::min(expected->Nearest, clip.w),
            std::max(expected->Farthest, clip.w) }
                              : rt::SeenPart::Bounds{ place, place, clip.w, clip.w };
        }
      }
    }
    const auto found = rt::SeenPart(request, indexToWorld, last).Find(depth);
    ASSERT_TRUE(found || !expected);
    if (found && !expected) // it is between the places
    {
      EXPECT_LT(glm::length(found->Upper - found->Lower), 1.5);
    }
    if (expected)
    {
      constexpr double most = 2.0; // corners of what is seen may be sharp
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_LE(found->Lower[axis], expected->Lower[axis] + 1e-6);
        EXPECT_GE(found->Lower[axis], expected->Lower[axis] - most);
        EXPECT_GE(found->Upper[axis], expected->Upper[axis] - 1e-6);
        EXPECT_LE(found->Upper[axis], expected->Upper[axis] + most);
      }
      EXPECT_NEAR(found->Nearest, expected->Nearest, 0.3);
      EXPECT_NEAR(found->Farthest, expected->Farthest, 0.3);
    }
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double depth : { infinity, 6.0, 3.0, 0.1 })
  {
    for (const glm::dvec3& from :
      { glm::dvec3(6.0, 5.0, 9.0), glm::dvec3(1.5, 0.7, 2.0), glm::dvec3(-4.0, 0.1, 0.2) })
    {
      const glm::dmat4 look = glm::lookAt(middle + from, middle, glm::dvec3(0.0, 1.0, 0.0));
      check(glm::perspective(0.5, 1.5, 0.01, 100.0) * look, depth);
      check(glm::ortho(-1.5, 1.5, -1.0, 1.0, 1.0, 90.0) * look, depth);
    }
    // It looks away.
    check(glm::perspective(0.5, 1.5, 0.01, 100.0) *
        glm::lookAt(middle + glm::dvec3(9.0), middle + glm::dvec3(18.0), glm::dvec3(0.0, 1.0, 0.0)),
      depth);
  }
}
