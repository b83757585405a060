// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SampleWidth_h
#define rt_SampleWidth_h

#include "DSMRayTracing/frame/FrameRequest.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <optional>
#include <vector>

namespace rt
{

/// How far apart, in pixels, a picture shows two samples of a lattice that are neighbors: at most so far, and about
/// that where they are nearest to the camera of all that the picture shows. 0 where it shows no place of the lattice.
/// `indexToWorld`: the samples are at the whole numbers from 0 to `last`. Deterministic: ranks find the same.
double GetSampleWidth(
  const FrameRequest& request, const glm::dmat4& indexToWorld, const glm::dvec3& last);

/// The part of a lattice that a picture shows: a convex body. Depths are w in clip space, to which widths in pixels are
/// inverse. Deterministic: ranks find the same.
class SeenPart
{
public:
  /// Bounds in index space, and depths.
  struct Bounds
  {
    glm::dvec3 Lower;
    glm::dvec3 Upper;
    double Nearest;
    double Farthest;
  };

  /// As GetSampleWidth.
  SeenPart(const FrameRequest& request, const glm::dmat4& indexToWorld, const glm::dvec3& last);

  /// Bounds of what is seen at depths up to `depth`; none where nothing is.
  std::optional<Bounds> Find(double depth) const;
  /// Returns how far apart, in pixels, the picture shows two places of depth 1 that are `step` apart on any of the
  /// axes; at most so far.
  double GetWidth(const glm::dvec3& step) const;

private:
  FrameRequest Request;
  glm::dmat4 IndexToClip;
  glm::dvec3 Last;
};

} // namespace rt

#endif
