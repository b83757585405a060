// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkCamera_h
#define BenchmarkCamera_h

#include "BenchmarkOptions.h"

#include "DSMRayTracing/scene/Scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <vector>

/// A position of the camera, and what the isovalues are multiplied with.
struct Position
{
  double Azimuth = 0.0; ///< degrees
  double Elevation = 20.0;
  double Distance = 4.0; ///< in half-extents of the longest axis
  double IsovalueFactor = 1.0;
};

/// An orbit, or what the session's file says. Every rank reads it. Throws dsm::Error.
std::vector<Position> GetPositions(const BenchmarkOptions& options);

struct Camera
{
  glm::dmat4 WorldToClip;
  glm::dvec3 ViewDirection;
};

/// Looks at the volume's center, view angle 30 degrees.
Camera GetCamera(const rt::LatticeIsosurface& object, double aspect, const Position& position);

#endif
