// SPDX-License-Identifier: BSD-3-Clause
#ifndef EmbreeMesh_h
#define EmbreeMesh_h

#include "tests/support/MeshFile.h"

#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <memory>

/// The same mesh in Intel's Embree, for comparison; benchmarks only.
class EmbreeMesh
{
public:
  /// Builds with so many threads. Throws dsm::Error.
  EmbreeMesh(const MeshFile::Mesh& mesh, int threads);
  ~EmbreeMesh();

  double GetBuildSeconds() const { return this->BuildSeconds; }
  static const char* GetVersion();

  /// One ray at a time. May be called by several threads at a time. `t` is set where it hits.
  bool Intersect(const rt::Ray& ray, double& t) const;

  /// The same for those of a batch of rays that are `wanted`, 16 at a time. Returns those that hit something.
  rt::RayMask IntersectPackets(const rt::Ray* rays, rt::RayMask wanted, double* t) const;

private:
  struct Handles;
  std::unique_ptr<Handles> Scene;
  double BuildSeconds = 0.0;
};

#endif
