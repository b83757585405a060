// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Stopgap_h
#define rt_Stopgap_h

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRequest.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace rt
{

/// An earlier picture stands in for the tiles of a frame that are not traced yet. Local: each rank has its own part of
/// both pictures.
namespace Stopgap
{

/// Returns the color and depth of an earlier picture, seen by the camera of another one: each pixel goes to where its
/// depth says; what shows no surface goes with `middle`, a place in world space. Small gaps between pixels are closed.
/// With the same camera, each pixel has the color of the earlier one that covers its middle. `from`: world to clip
/// space of the earlier picture, as in FrameRequest.
Picture Move(const Picture& earlier, const glm::dmat4& from, const FrameRequest& request,
  const glm::dvec3& middle);

/// Puts the tiles that were traced of a frame over the stopgap: all of its pixels of these tiles give way, on every
/// rank. `traced`: this rank's part of the frame, or the whole.
void Cover(const Frame& frame, const Picture& traced, Picture& stopgap);

} // namespace Stopgap

} // namespace rt

#endif
