// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SampleWidth_h
#define rt_SampleWidth_h

#include "DSMRayTracing/frame/FrameRequest.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace rt
{

/// How far apart, in pixels, a picture shows two samples of a lattice that are neighbors: at most so far, and about
/// that where they are nearest to the camera of all that the picture shows. 0 where it shows no place of the lattice.
/// `indexToWorld`: the samples are at the whole numbers from 0 to `last`. Deterministic: ranks find the same.
double GetSampleWidth(
  const FrameRequest& request, const glm::dmat4& indexToWorld, const glm::dvec3& last);

} // namespace rt

#endif
