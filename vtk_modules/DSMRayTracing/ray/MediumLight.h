// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumLight_h
#define rt_MediumLight_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace rt
{

struct MediumLook;
struct MediumShading;

/// A part of a ray within a medium. Amounts of the same part in several media add up, but for the depths of a group.
struct MediumPiece
{
  double Begin; ///< T
  double End;
  /// Red, green and blue that the medium emits there, and its optical depth.
  Lanes Amount;
  /// Opacity that the piece adds to the ray if its medium is the only one. Until a piece of late extinction is
  /// described: its own opacity, which is an upper bound.
  double Share = 0.0;
  /// Which light makes it shine; null: it shines by itself.
  const MediumLook* Look = nullptr;
  /// Unit, in world space, against the gradient of the values; 0: there is none.
  glm::dvec3 Normal{ 0.0 };
  int Group = 0; ///< MediumTracer::GetGroup
  /// The values at its begin, in the middle and at its end, in places of the medium's function, if the march keeps
  /// them (MediumLight::KeepsValues).
  float Values[3] = {};

  double GetMiddle() const { return 0.5 * (this->Begin + this->End); }
};

/// Light that the rays of a batch receive from media between two surfaces, front to back: the
/// emission-absorption integral of Max, "Optical models for direct volume rendering" (1995). A
/// single medium that emits light by itself adds to the sums directly. For other media, pieces are
/// kept first, lit, and merged.
class MediumLight
{
public:
  /// Rays that let less light through than this are as good as opaque: less than half a step of an 8-bit channel.
  static constexpr double Dark = 0.5 / 255.0;
  /// The same of one medium in a group of up to four: the group has at least 2 / 3 of its depth.
  static constexpr double DarkInGroup = 8e-5;
  /// Optical depth of pieces out of which nearly all gets that they emit.
  static constexpr double Thin = 1e-6;
  /// Optical depth of pieces that are joined, at most.
  static constexpr double JoinedDepth = 1.0 / 32.0;
  /// Pieces that add so little to what is seen are joined when they are up to so many times as long.
  static constexpr double FaintShare = 1.0 / 512.0;
  static constexpr double FaintLength = 4.0;
  /// Pieces that add less need no description.
  static constexpr double LeastShare = 1.0 / 65536.0;

  /// Begins with the `wanted` rays of `rays`.
  void Begin(const Ray* rays, RayMask wanted)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        this->First[ray] = std::numeric_limits<double>::infinity();
        this->Pieces[ray].clear();
      });
    this->SetSpace(rays, wanted, glm::dmat3(1.0));
    this->ClearSums(wanted);
  }
  /// Sets the space in which the current medium measures lengths: the linear part of the way from world space to there.
  void SetSpace(const Ray* rays, RayMask wanted, const glm::dmat3& worldToSpace)
  {
    this->WorldToSpace = worldToSpace;
    ForEachRay(wanted,
      [&](int ray)
      {
        this->Length[ray] = glm::length(worldToSpace * rays[ray].Direction);
        const glm::dvec3 toViewer = -glm::normalize(rays[ray].Direction);
        for (int axis = 0; axis < 3; ++axis)
        {
          this->ToViewer[axis][ray] = static_cast<float>(toViewer[axis]);
        }
      });
  }
  void ClearSums(RayMask wanted)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        this->Transmittance[ray] = 1.0;
        this->Middle[ray] = std::numeric_limits<double>::infinity();
        for (auto& place : this->Place)
        {
          place[ray] = std::numeric_limits<double>::infinity();
        }
        this->Sum[0][ray] = 0.0;
        this->Sum[1][ray] = 0.0;
        this->Sum[2][ray] = 0.0;
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
      this->Last[ray] = piece.End;
      if (this->KeepsPieces)
      {
        this->Keep(ray, piece, passed);
      }
      this->Locate(ray, piece.Begin, piece.End, passed);
      this->Blend(
        ray, piece.Amount, passed, depth < Thin ? 1.0 - 0.5 * depth : (1.0 - passed) / depth);
    }
  }

  ///@{
  /// The parts of Add, for callers that have the transmittance of a piece already, and the share of its emission
  /// that leaves it.
  void Keep(int ray, const MediumPiece& piece, double passed)
  {
    std::vector<MediumPiece>& pieces = this->Pieces[ray];
    const double share =
      (this->HasLateExtinction ? 1.0 : this->Transmittance[ray]) * (1.0 - passed);
    if (!this->KeepsValues && pieces.size() > this->FirstPiece[ray] &&
      this->IsJoined(ray, pieces.back(), piece.End, piece.Amount, share) &&
      piece.Begin <= pieces.back().End + 1e-6 * (piece.End - piece.Begin))
    {
      MediumPiece& last = pieces.back();
      last.End = piece.End;
      last.Amount = last.Amount + piece.Amount;
      last.Share += share;
      return;
    }
    pieces.push_back(piece);
    pieces.back().Share = share;
  }
  void Blend(int ray, const Lanes& amount, double passed, double seen)
  {
    double& transmittance = this->Transmittance[ray];
    for (int channel = 0; channel < 3; ++channel)
    {
      this->Sum[channel][ray] += amount[channel] * (transmittance * seen);
    }
    transmittance *= passed;
  }
  /// Before Blend: tells where the piece is.
  void Locate(int ray, double begin, double end, double passed)
  {
    const double before = this->Transmittance[ray];
    const double after = before * passed;
    if (before > 0.5 && after <= 0.5)
    {
      this->Middle[ray] = begin + (before - 0.5) / (before - after) * (end - begin);
    }
  }
  ///@}
  /// T of the place that stands for all that a ray meets: where half of the light is gone; else, where there is
  /// anything.
  double GetPlace(int ray) const
  {
    return std::isinf(this->Middle[ray]) ? this->First[ray] : this->Middle[ray];
  }
  /// T of a place with as much of the way through all that a ray meets before it as behind it.
  double GetHalfWay(int ray) const { return 0.5 * (this->First[ray] + this->Last[ray]); }
  bool IsDark(int ray) const { return this->Transmittance[ray] < this->DarkBelow; }
  /// Returns the color that arrives at the ray's origin.
  glm::dvec3 GetColor(int ray) const
  {
    return { this->Sum[0][ray], this->Sum[1][ray], this->Sum[2][ray] };
  }

  /// For each ray:
  double Length[MaxRays];        ///< length of a unit of T, in the current medium's space
  float ToViewer[3][MaxRays];    ///< unit, in world space
  double Transmittance[MaxRays]; ///< transmittance of all pieces so far
  double First[MaxRays];         ///< T where there is anything first; infinite: nowhere
  double Last[MaxRays];          ///< T where the last of it ends, where there is anything
  double Middle[MaxRays];        ///< T where half of the light is gone; infinite: nowhere
  double Sum[3][MaxRays];        ///< red, green and blue

  /// True if pieces are kept in addition to the sums.
  bool KeepsPieces = false;
  std::vector<MediumPiece> Pieces[MaxRays];
  std::size_t FirstPiece[MaxRays]; ///< index of the first piece of the current medium
  glm::dmat3 WorldToSpace{ 1.0 };  ///< SetSpace
  /// Length up to which thin pieces that follow one another are joined into one, in that space.
  double JoinedLength = 0.0;
  /// MediumTracer::HasLateExtinction of the current medium.
  bool HasLateExtinction = false;
  /// True if pieces keep the values of the current medium. Then none are joined.
  bool KeepsValues = false;
  /// Errors that are as small as MediumTolerance says when they are multiplied by this: 1 for what a pixel shows.
  double ErrorFactor = 1.0;
  /// True: finds Place.
  bool LocatesPlaces = false;
  /// T where the opacity of what a ray has met reaches (place + 1/2) / Places; infinite: nowhere.
  static constexpr int Places = 4;
  double Place[Places][MaxRays];
  /// The part of a lamp's light that arrives at these, for MediumShading::HasShadows: GetArriving.
  std::vector<float> Arriving;
  static std::size_t GetArriving(std::size_t lamp, int channel, int place, int ray)
  {
    return ((lamp * 3 + static_cast<std::size_t>(channel)) * Places +
             static_cast<std::size_t>(place)) *
      MaxRays +
      static_cast<std::size_t>(ray);
  }
  /// Null: pieces are not shaded while rays march, or later.
  const MediumShading* Shading = nullptr;
  ///@{
  /// MediumLook of the current medium.
  bool IsExact = false;
  bool Nearest = false;
  ///@}
  /// Rays with less transmittance than this end in the current medium.
  double DarkBelow = Dark;

private:
  bool IsJoined(
    int ray, const MediumPiece& last, double end, const Lanes& amount, double share) const
  {
    const double most = this->JoinedLength * (last.Share + share <= FaintShare ? FaintLength : 1.0);
    return (end - last.Begin) * this->Length[ray] <= most &&
      last.Amount[3] + amount[3] <= JoinedDepth;
  }
};

} // namespace rt

#endif
