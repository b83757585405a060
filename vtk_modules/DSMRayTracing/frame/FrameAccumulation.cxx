// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAccumulation.h"

#include "DSMRayTracing/frame/SceneDigest.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rt
{

FrameAccumulation::Result FrameAccumulation::Trace(const Ranks& ranks, const Scene& scene,
  FrameRequest request, int wanted, const Pace& pace, double lastSeconds)
{
  bool isSame = false;
  if (wanted > 1)
  {
    const std::uint64_t digest = GetSceneDigest(scene, request);
    // A rank may have seen a change that the others have not.
    const std::uint8_t same = this->Samples > 0 && digest == this->Digest;
    const auto all = ranks.Messenger.AllGatherValue(same);
    isSame = std::count(all.begin(), all.end(), 0) == 0;
    this->Digest = digest;
  }
  if (!isSame)
  {
    this->Restart();
  }
  this->Wanted = wanted;
  // A single sample is traced anew at rest; a last one of several stays.
  const bool isPreview = request.IsPreview && wanted == 1;
  Result result = Result::Nothing;
  while (this->SamplesUnderWay > 0 || this->Samples < wanted)
  {
    request.FirstSample = this->Samples;
    request.Samples =
      this->SamplesUnderWay > 0 ? this->SamplesUnderWay : this->CountNext(pace, lastSeconds);
    request.IsPreview = isPreview || request.FirstSample + request.Samples < wanted;
    result = this->TraceOnce(ranks, scene, request);
    if (result == Result::Aborted || pace.Samples > 0)
    {
      break;
    }
  }
  return result;
}

FrameAccumulation::Result FrameAccumulation::TraceOnce(
  const Ranks& ranks, const Scene& scene, FrameRequest request)
{
  this->Samples = 0; // unless it succeeds
  this->SamplesUnderWay = 0;
  if (request.FirstSample == 0)
  {
    Frame frame = ranks.Renderer.Render(ranks.Store, scene, request, &this->Traced);
    if (frame.IsAborted)
    {
      return Result::Aborted;
    }
    this->Traced = std::move(frame);
  }
  else
  {
    ranks.Renderer.Refine(ranks.Store, scene, request, this->Traced);
    if (this->Traced.IsAborted)
    {
      this->Samples = request.FirstSample;
      this->SamplesUnderWay = request.Samples;
      return Result::Aborted;
    }
  }
  this->Samples = request.FirstSample + request.Samples;
  this->LastSamples = request.Samples;
  return Result::Traced;
}

void FrameAccumulation::Restart()
{
  this->Samples = 0;
  this->SamplesUnderWay = 0;
  this->Wanted = 0;
}

void FrameAccumulation::Postpone()
{
  this->Restart();
  this->Wanted = 1;
}

int FrameAccumulation::CountNext(const Pace& pace, double lastSeconds) const
{
  const int missing = this->Wanted - this->Samples;
  if (pace.Samples == 0)
  {
    return missing;
  }
  double samples = pace.Samples;
  if (this->Samples > 0 && lastSeconds > 0.0)
  {
    samples = std::max(samples, std::floor(pace.Seconds * this->LastSamples / lastSeconds));
  }
  return static_cast<int>(std::min<double>(samples, missing));
}

double FrameAccumulation::GetSecondsPerPixel(double lastSeconds) const
{
  const double samples =
    static_cast<double>(this->LastSamples) * this->Traced.Width * this->Traced.Height;
  return samples > 0.0 ? lastSeconds / samples : 0.0;
}

void FrameAccumulation::Clear()
{
  *this = {};
}

} // namespace rt
