// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_TracerBench_h
#define tests_TracerBench_h

#include "DSMRayTracing/volume/VolumeTracer.h"
#include "MemoryStore.h"

/// All that a trace in a test needs.
struct TracerBench
{
  MemoryStore Store;
  MemoryStore::Worker Worker;
  rt::VolumeTracer<MemoryStore> Tracer{ Store, Worker };
};

/// From one point (T = 0) to another (T = 1).
inline rt::Ray CreateRay(const glm::dvec3& from, const glm::dvec3& to)
{
  rt::Ray ray;
  ray.Origin = from;
  ray.Direction = to - from;
  ray.Max = 1.0;
  return ray;
}

#endif
