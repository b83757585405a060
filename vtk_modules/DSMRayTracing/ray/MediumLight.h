// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumLight_h
#define rt_MediumLight_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

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
  /// Red, green and blue that the medium emits there, and its optical depth.
  Lanes Amount;
};

/// What the rays of a batch get from media between two surfaces, from the front: the emission-absorption integral of
/// Max, "Optical models for direct volume rendering" (1995). One medium adds to the sums as it is met; of several,
/// pieces are kept first, and merged.
class MediumLight
{
public:
  /// Rays that let less light through than this are as good as opaque: less than half a step of an 8-bit channel.
  static constexpr double Dark = 0.5 / 255.0;
  /// Optical depth of pieces out of which nearly all gets that they emit.
  static constexpr double Thin = 1e-6;

  /// Of those of the rays that are `wanted`.
  void Begin(const Ray* rays, RayMask wanted)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        this->Length[ray] = glm::length(rays[ray].Direction);
        this->First[ray] = std::numeric_limits<double>::infinity();
        this->Pieces[ray].clear();
      });
    this->ClearSums(wanted);
  }
  void ClearSums(RayMask wanted)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        this->Transmittance[ray] = 1.0;
        this->Sum[ray] = Lanes(0.0);
      });
  }

  /// Adds what a ray meets next.
  void Add(int ray, const MediumPiece& piece)
  {
    const double depth = piece.Amount[3];
    if (depth > 0.0)
    {
      const double passed = std::exp(-depth);
      this->First[ray] = std::min(this->First[ray], piece.Begin);
      if (this->KeepsPieces)
      {
        this->Pieces[ray].push_back(piece);
      }
      this->Blend(
        ray, piece.Amount, passed, depth < Thin ? 1.0 - 0.5 * depth : (1.0 - passed) / depth);
    }
  }

  ///@{
  /// The parts of Add, for those who know the transmittance of a piece, and the part of what it emits that gets out.
  void Keep(int ray, double begin, double end, const Lanes& amount)
  {
    this->Pieces[ray].push_back({ begin, end, amount });
  }
  void Blend(int ray, const Lanes& amount, double passed, double seen)
  {
    double& transmittance = this->Transmittance[ray];
    this->Sum[ray] = this->Sum[ray] + amount * Lanes(transmittance * seen);
    transmittance *= passed;
  }
  ///@}

  bool IsDark(int ray) const { return this->Transmittance[ray] < Dark; }
  /// What arrives at the ray's begin.
  glm::dvec3 GetColor(int ray) const
  {
    return { this->Sum[ray][0], this->Sum[ray][1], this->Sum[ray][2] };
  }

  /// For each ray:
  double Length[MaxRays];        ///< world length of a unit of T
  double Transmittance[MaxRays]; ///< what gets through what was met so far
  double First[MaxRays];         ///< T where there is anything first; infinite: nowhere

  /// Whether pieces are kept, too.
  bool KeepsPieces = false;
  std::vector<MediumPiece> Pieces[MaxRays];

private:
  Lanes Sum[MaxRays]; ///< red, green and blue
};

} // namespace rt

#endif
