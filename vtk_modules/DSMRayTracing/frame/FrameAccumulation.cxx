// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAccumulation.h"

#include "DSMRayTracing/frame/SceneDigest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace rt
{

FrameAccumulation::Offer FrameAccumulation::CreateOffer(dsm::BlockStore& store, const Scene& scene,
  const FrameRequest& request, int wanted, const Pace& pace) const
{
  return { FrameEntry::Create(store, scene, request, &this->Traced), this->Digest, this->Samples,
    this->SamplesUnderWay, wanted, pace.Samples, pace.Seconds };
}

/// Returns whether all ranks have samples of the frame that is to be shown, and equally many.
bool FrameAccumulation::IsSame(const std::vector<Offer>& offers, std::uint64_t digest) const
{
  return this->Samples > 0 && digest == this->Digest &&
    std::all_of(offers.begin(), offers.end(),
      [&](const Offer& other)
      {
        return other.Digest == this->Digest && other.Samples == this->Samples &&
          other.SamplesUnderWay == this->SamplesUnderWay;
      });
}

FrameAccumulation::Result FrameAccumulation::Trace(const Ranks& ranks,
  const std::vector<Offer>& offers, const Scene& scene, FrameRequest request, int wanted,
  const Pace& pace, double lastSeconds, Report report)
{
  const auto isUnlike = [&](const Offer& other)
  {
    const Offer& first = offers.front();
    return other.Wanted != first.Wanted || other.PaceSamples != first.PaceSamples ||
      other.PaceSeconds != first.PaceSeconds;
  };
  const auto unlike = std::find_if(offers.begin(), offers.end(), isUnlike);
  if (unlike != offers.end())
  {
    FrameEntry::Refuse(static_cast<std::size_t>(unlike - offers.begin()));
  }
  FrameRenderer::Records records{ {}, report };
  std::uint64_t digest = 0;
  // The ranks count on one another from here on.
  ranks.Messenger.Insist(
    [&]
    {
      digest = wanted > 1 ? GetSceneDigest(scene, request) : 0;
      records.Entries.clear();
      for (const Offer& offer : offers)
      {
        records.Entries.push_back(offer.Entry);
      }
    });
  FrameEntry::Check(records.Entries, request);
  if (wanted == 1 || !this->IsSame(offers, digest))
  {
    this->Restart();
  }
  this->Digest = digest;
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
    result = this->TraceOnce(ranks, scene, request, records);
    records.Entries.clear();
    if (result == Result::Aborted || pace.Samples > 0)
    {
      break;
    }
  }
  return result;
}

FrameAccumulation::Result FrameAccumulation::TraceOnce(const Ranks& ranks, const Scene& scene,
  FrameRequest request, const FrameRenderer::Records& records)
{
  this->Samples = 0; // unless it succeeds
  this->SamplesUnderWay = 0;
  if (request.FirstSample == 0)
  {
    Frame frame = ranks.Renderer.Render(ranks.Store, scene, request, &this->Traced, records);
    if (frame.IsAborted)
    {
      return Result::Aborted;
    }
    this->Traced = std::move(frame);
  }
  else
  {
    ranks.Renderer.Refine(ranks.Store, scene, request, this->Traced, records);
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
  const int wanted = std::max(this->Wanted, 1);
  this->Restart();
  this->Wanted = wanted;
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
