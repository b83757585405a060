// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameAccumulation.h"

#include "DSMRayTracing/frame/SceneDigest.h"
#include "DSMRayTracing/frame/TileGrid.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace rt
{

namespace
{
/// Part of a frame that is not complete: at most.
constexpr double AlmostAll = 0.999;
}

FrameAccumulation::Offer FrameAccumulation::CreateOffer(dsm::BlockStore& store, const Scene& scene,
  const FrameRequest& request, int wanted, const Pace& pace) const
{
  return { FrameEntry::Create(store, scene, request, &this->Traced), this->Digest, this->Samples,
    this->SamplesUnderWay, this->BegunDigest, this->Begun.Number, wanted, pace.Samples,
    pace.GoesOn };
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

/// Returns whether all ranks have begun the frame that is to be shown.
bool FrameAccumulation::IsBegun(const std::vector<Offer>& offers, std::uint64_t digest) const
{
  return this->Begun.Number > 0 && digest == this->BegunDigest &&
    std::all_of(offers.begin(), offers.end(),
      [&](const Offer& other) {
        return other.BegunDigest == this->BegunDigest && other.BegunNumber == this->Begun.Number;
      });
}

FrameAccumulation::Result FrameAccumulation::Trace(const Ranks& ranks,
  const std::vector<Offer>& offers, const Scene& scene, FrameRequest request, int wanted,
  const Pace& pace, Report report)
{
  const auto isUnlike = [&](const Offer& other)
  {
    const Offer& first = offers.front();
    return other.Wanted != first.Wanted || other.PaceSamples != first.PaceSamples ||
      other.GoesOn != first.GoesOn;
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
      digest = GetSceneDigest(scene, request);
      records.Entries.clear();
      for (const Offer& offer : offers)
      {
        records.Entries.push_back(offer.Entry);
      }
    });
  FrameEntry::Check(records.Entries, request);
  // Who takes all samples at once wants a single one traced again.
  const bool isSame = (wanted > 1 || pace.Samples > 0) && this->IsSame(offers, digest);
  if (!isSame)
  {
    const bool isBegun = this->BegunSamples <= wanted && this->IsBegun(offers, digest);
    Frame begun = std::move(this->Begun);
    this->Restart();
    this->Begun = isBegun ? std::move(begun) : Frame();
  }
  this->Wanted = wanted;
  this->Digest = digest;
  Result result = Result::Nothing;
  while (this->SamplesUnderWay > 0 || this->Samples < wanted)
  {
    request.FirstSample = this->Samples;
    request.Samples = this->SamplesUnderWay > 0 ? this->SamplesUnderWay
      : this->Begun.Number > 0                  ? this->BegunSamples
                                                : this->CountNext(pace);
    result = this->TraceOnce(ranks, scene, request, records);
    records.Entries.clear();
    this->BegunDigest = this->Begun.Number > 0 ? digest : 0;
    if (result == Result::Aborted || (pace.Samples > 0 && !pace.GoesOn))
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
    Frame frame = std::exchange(this->Begun, {}); // unless it succeeds
    if (frame.Number > 0)
    {
      ranks.Renderer.Resume(ranks.Store, scene, request, frame, &this->Traced, records);
    }
    else
    {
      frame = ranks.Renderer.Render(ranks.Store, scene, request, &this->Traced, records);
    }
    if (frame.IsAborted)
    {
      this->Begun = std::move(frame);
      this->BegunSamples = request.Samples;
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
  const bool isForAll = !request.MayStop() || this->Samples <= FrameRequest::SureSamples;
  this->LastSamples = isForAll ? request.Samples : 0;
  return Result::Traced;
}

const Frame& FrameAccumulation::FilterLight(const Ranks& ranks, const glm::dmat4& worldToClip)
{
  // Another number is given to it with other samples.
  if (this->Filtered.Number != this->Traced.Number)
  {
    this->Filtered = {};
    this->Filtered = ranks.Renderer.FilterLight(ranks.Store, worldToClip, this->Traced);
  }
  return this->Filtered;
}

void FrameAccumulation::Restart()
{
  this->Samples = 0;
  this->SamplesUnderWay = 0;
  this->Wanted = 0;
  this->Begun = {};
  this->BegunDigest = 0;
}

void FrameAccumulation::Postpone()
{
  const int wanted = std::max(this->Wanted, 1);
  this->Restart();
  this->Wanted = wanted;
}

int FrameAccumulation::CountNext(const Pace& pace) const
{
  const int missing = this->Wanted - this->Samples;
  const int samples = pace.GoesOn ? std::max(pace.Samples, this->Samples) : pace.Samples;
  return pace.Samples == 0 ? missing : std::min(samples, missing);
}

double FrameAccumulation::CountBegunPixels() const
{
  const Frame& frame = this->Begun;
  const double pixels = static_cast<double>(frame.Width) * frame.Height;
  const double tiles = TileGrid(frame.Width, frame.Height, std::max(frame.TileSize, 1)).GetCount();
  return tiles > 0.0 ? pixels * (1.0 - static_cast<double>(frame.Left.size()) / tiles) : 0.0;
}

double FrameAccumulation::GetSecondsPerPixel(double lastSeconds) const
{
  const double samples =
    static_cast<double>(this->LastSamples) * this->Traced.Width * this->Traced.Height;
  return samples > 0.0 ? lastSeconds / samples : 0.0;
}

double FrameAccumulation::GetPart() const
{
  const double pixels = static_cast<double>(this->Begun.Width) * this->Begun.Height;
  const double begun =
    this->Begun.Number > 0 ? this->BegunSamples * this->CountBegunPixels() / pixels : 0.0;
  // A frame may be aborted when its last tile has just been traced.
  return this->IsComplete()
    ? 1.0
    : std::min((this->Samples + begun) / std::max(this->Wanted, 1), AlmostAll);
}

void FrameAccumulation::Clear()
{
  *this = {};
}

} // namespace rt
