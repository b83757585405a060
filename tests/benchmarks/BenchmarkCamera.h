// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkCamera_h
#define BenchmarkCamera_h

#include "VolumeOptions.h"

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
std::vector<Position> GetPositions(const VolumeOptions& options);

struct Camera
{
  glm::dmat4 WorldToClip;
  glm::dvec3 ViewDirection;
};

/// Looks at the volume's center, view angle 30 degrees.
Camera GetCamera(const rt::LatticeField& field, double aspect, const Position& position);
Camera GetCamera(
  const glm::dvec3& center, const glm::dvec3& halfExtents, double aspect, const Position& position);

/// The picture that a camera takes, and the light in it. Shadows come from a lamp beside the camera, else the lamp is
/// at the camera.
rt::FrameRequest CreateRequest(const VolumeOptions& options, const Camera& camera);
rt::LightTransport CreateTransport(const VolumeOptions& options, const rt::LatticeField& field);
rt::Light CreateLamp(const VolumeOptions& options, const Camera& camera);

#endif
