// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneDigest_h
#define rt_SceneDigest_h

#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <cstdint>

namespace rt
{

/// A number that two pictures to trace share if, for all practical purposes, they are the same but
/// for the samples asked for: 64-bit FNV-1a over camera, lights, objects and the segments that hold
/// their data. Valid within one process.
std::uint64_t GetSceneDigest(const Scene& scene, const FrameRequest& request);

/// The same of the shapes of a scene's objects alone.
std::uint64_t GetShapeDigest(const Scene& scene);

} // namespace rt

#endif
