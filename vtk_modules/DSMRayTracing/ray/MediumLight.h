// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumLight_h
#define rt_MediumLight_h

#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rt
{

/// A part of a ray within a medium. Amounts of the same part in several media add up.
struct MediumPiece
{
  double Begin; ///< T
  double End;
  /// Red, green and blue that the medium emits there, and its optical depth (w).
  glm::dvec4 Amount;
};

/// What the rays of a batch get from media between two surfaces, from the front: the emission-absorption integral of
/// Max, "Optical models for direct volume rendering" (1995). One medium adds to the sums as it is met; of several,
/// pieces are kept first, and merged.
class MediumLight
{
public:
  /// Rays that let less light through than this are as good as opaque: less than half a step of an 8-bit channel.
  static constexpr double Dark = 0.5 / 255.0;

  /// Of those of the rays that are `wanted`.
  void Begin(const Ray* rays, RayMask wanted)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        this->Length[ray] = glm::length(rays[ray].Direction);
        this->Transmittance[ray] = 1.0;
        this->Color[ray] = glm::dvec3(0.0);
        this->First[ray] = std::numeric_limits<double>::infinity();
        this->Pieces[ray].clear();
      });
  }

  /// Adds what a ray meets next.
  void Add(int ray, const MediumPiece& piece)
  {
    const double depth = piece.Amount.w;
    if (depth > 0.0)
    {
      const double passed = std::exp(-depth);
      const double seen = depth < Thin ? 1.0 - 0.5 * depth : (1.0 - passed) / depth;
      this->Add(ray, piece, passed, seen);
    }
  }
  /// The same where the transmittance of the piece, and the part of what it emits that gets out of it, are known.
  void Add(int ray, const MediumPiece& piece, double passed, double seen)
  {
    this->First[ray] = std::min(this->First[ray], piece.Begin);
    if (this->KeepsPieces)
    {
      this->Pieces[ray].push_back(piece);
    }
    this->Color[ray] += this->Transmittance[ray] * seen * glm::dvec3(piece.Amount);
    this->Transmittance[ray] *= passed;
  }
  bool IsDark(int ray) const { return this->Transmittance[ray] < Dark; }

  /// Optical depth of pieces that emit nearly all that they emit.
  static constexpr double Thin = 1e-6;

  /// For each ray:
  double Length[MaxRays];        ///< world length of a unit of T
  double Transmittance[MaxRays]; ///< what gets through what was met so far
  glm::dvec3 Color[MaxRays];     ///< what arrives at the ray's begin
  double First[MaxRays];         ///< T where there is anything first; infinite: nowhere

  /// Whether pieces are kept, and not added to the sums.
  bool KeepsPieces = false;
  std::vector<MediumPiece> Pieces[MaxRays];
};

} // namespace rt

#endif
