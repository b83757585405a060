// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameAccumulation.h"

#include "DSMRayTracing/frame/SceneDigest.h"
#include "vtkDSMRankGroup.h"

#include <algorithm>
#include <cmath>

bool vtkDSMFrameAccumulation::Trace(vtkDSMRankGroup& group, const rt::Scene& scene,
  rt::FrameRequest request, int wanted, const Pace& pace, double lastSeconds)
{
  std::uint64_t digest = 0;
  this->Wanted = wanted;
  if (wanted > 1)
  {
    digest = rt::GetSceneDigest(scene, request);
    // A rank may have seen a change that the others have not.
    const std::uint8_t same = this->Samples > 0 && digest == this->Digest;
    const auto all = group.GetMessenger().AllGatherValue(same);
    if (std::count(all.begin(), all.end(), 0) > 0)
    {
      this->Samples = 0;
    }
  }
  else
  {
    this->Samples = 0;
  }
  if (this->Samples >= wanted)
  {
    return false;
  }
  request.FirstSample = this->Samples;
  request.Samples = this->CountNext(pace, lastSeconds);
  this->Samples = 0;
  rt::FrameRenderer& renderer = group.GetFrameRenderer();
  if (request.FirstSample == 0)
  {
    this->Frame = renderer.Render(group.GetStore(), scene, request, &this->Frame);
  }
  else
  {
    renderer.Refine(group.GetStore(), scene, request, this->Frame);
  }
  this->Samples = request.FirstSample + request.Samples;
  this->LastSamples = request.Samples;
  this->Digest = digest;
  return true;
}

int vtkDSMFrameAccumulation::CountNext(const Pace& pace, double lastSeconds) const
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

double vtkDSMFrameAccumulation::GetSecondsPerPixel(double lastSeconds) const
{
  const double samples =
    static_cast<double>(this->LastSamples) * this->Frame.Width * this->Frame.Height;
  return samples > 0.0 ? lastSeconds / samples : 0.0;
}

void vtkDSMFrameAccumulation::Clear()
{
  *this = {};
}
