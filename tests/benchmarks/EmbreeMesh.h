// SPDX-License-Identifier: BSD-3-Clause
#ifndef EmbreeMesh_h
#define EmbreeMesh_h

#include "tests/support/MeshFile.h"

#include "DSMRayTracing/ray/Ray.h"

#include <cstdint>
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

  /// The same for those of 16 rays that are `wanted`, together. Returns those that hit something.
  std::uint32_t Intersect16(const rt::Ray* rays, std::uint32_t wanted, double* t) const;

private:
  struct Handles;
  std::unique_ptr<Handles> Scene;
  double BuildSeconds = 0.0;
};

#endif
