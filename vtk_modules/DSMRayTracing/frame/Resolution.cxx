// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/Resolution.h"

#include "DSMRayTracing/frame/SceneDigest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rt
{

namespace
{

constexpr double MovingSeconds = 0.05;
/// A picture that takes longer has a draft before it.
constexpr double SoonSeconds = 0.2;
constexpr double DraftSeconds = 0.1;
/// A picture is abandoned when it takes so many times as long as the last one.
constexpr double Doubt = 1.25;
/// The edge of a draft of what may take any time.
constexpr int UnknownEdge = 8;
/// Between the coarsest drafts and a picture that takes longer, there is another draft.
constexpr double LongSeconds = 2.0;
constexpr int SecondEdge = 4;

constexpr double Unlimited = std::numeric_limits<double>::infinity();

double CountPixels(const FrameRequest& request)
{
  return static_cast<double>(request.Width) * request.Height;
}

} // namespace

std::uint64_t Resolution::GetContent(Scene& scene, const FrameRequest& request)
{
  LightTransport& transport = scene.Transport;
  const bool faintShadows = std::exchange(transport.FaintShadows, false);
  const double mediumErrors = std::exchange(transport.MediumErrors, 1.0);
  const std::uint64_t content = GetSceneDigest(scene, request);
  transport.FaintShadows = faintShadows;
  transport.MediumErrors = mediumErrors;
  return content;
}

int Resolution::GetMovingEdge(const FrameRequest& request, double secondsPerPixel, int least)
{
  const double edge = std::sqrt(CountPixels(request) * secondsPerPixel / MovingSeconds);
  return std::clamp(static_cast<int>(std::lround(edge)), least, std::max(least, CoarsestEdge));
}

std::vector<Resolution::Try> Resolution::GetTries(
  const Shown& shown, std::uint64_t content, const FrameRequest& request)
{
  const double seconds = CountPixels(request) * shown.SecondsPerPixel;
  if (content == shown.Begun)
  {
    return { { static_cast<int>(shown.BegunEdge), Unlimited } };
  }
  if (content == shown.Content)
  {
    const bool isNext = shown.Edge <= SecondEdge || seconds <= LongSeconds;
    return { { isNext ? 1 : SecondEdge, Unlimited } };
  }
  if (!shown.MayDraft)
  {
    return { { 1, Unlimited } };
  }
  int edge = UnknownEdge;
  if (seconds > 0.0)
  {
    edge = seconds <= SoonSeconds ? 1 : 2;
    while (edge > 1 && edge < CoarsestEdge && seconds > DraftSeconds * edge * edge)
    {
      edge *= 2;
    }
  }
  std::vector<Try> tries;
  if (edge < UnknownEdge)
  {
    // What is new may take longer than what was shown.
    tries.push_back({ edge, std::max(DraftSeconds, Doubt * seconds / (edge * edge)) });
  }
  tries.push_back({ std::max(edge, UnknownEdge), Unlimited });
  return tries;
}

FrameRequest Resolution::Reduce(const FrameRequest& request, int edge)
{
  FrameRequest reduced = request;
  reduced.PixelSize = edge;
  reduced.Width = (request.Width + edge - 1) / edge;
  reduced.Height = (request.Height + edge - 1) / edge;
  return reduced;
}

} // namespace rt
