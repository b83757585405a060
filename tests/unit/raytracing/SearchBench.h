// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_SearchBench_h
#define tests_SearchBench_h

#include "DSMRayTracing/field/lattice/IsosurfaceSearch.h"
#include "DSMRayTracing/field/lattice/LatticeSampler.h"
#include "MemoryStore.h"

/// All that a trace in a test needs.
struct SearchBench
{
  MemoryStore Store;
  MemoryStore::Worker Worker;
  rt::IsosurfaceSearch<MemoryStore> Search{ Store, Worker };
  rt::LatticeSampler<MemoryStore> Sampler{ Store, Worker };

  double Sample(const bricks::VoxelField& field, const glm::dvec3& indexPoint) const
  {
    const rt::LatticePlace place{ indexPoint, {}, {} };
    double value;
    this->Sampler.FindValues(field, &place, 1, &value);
    return value;
  }
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
