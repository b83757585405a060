// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_SearchBench_h
#define tests_SearchBench_h

#include "DSMRayTracing/volume/FieldSampler.h"
#include "DSMRayTracing/volume/IsosurfaceSearch.h"
#include "MemoryStore.h"

/// All that a trace in a test needs.
struct SearchBench
{
  MemoryStore Store;
  MemoryStore::Worker Worker;
  rt::IsosurfaceSearch<MemoryStore> Search{ Store, Worker };
  rt::FieldSampler<MemoryStore> Fields{ Store, Worker };
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
