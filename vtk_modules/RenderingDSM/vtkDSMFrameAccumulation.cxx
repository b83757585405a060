// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameAccumulation.h"

#include "DSMRayTracing/frame/SceneDigest.h"
#include "vtkDSMRankGroup.h"

#include <algorithm>

bool vtkDSMFrameAccumulation::Trace(
  vtkDSMRankGroup& group, const rt::Scene& scene, rt::FrameRequest request, int wanted, int atOnce)
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
  const int missing = wanted - this->Samples;
  if (missing <= 0)
  {
    return false;
  }
  request.FirstSample = this->Samples;
  request.Samples = atOnce > 0 ? std::min(atOnce, missing) : missing;
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
  this->Digest = digest;
  return true;
}

void vtkDSMFrameAccumulation::Clear()
{
  this->Frame = {};
  this->Samples = 0;
}
