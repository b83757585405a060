// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumOf_h
#define rt_MediumOf_h

#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/look/MediumLook.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/look/TransferFunction2D.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace rt
{

template <class FieldType, class Store>
class FieldMediumTracer;

/// A medium whose emission and extinction are a function of a field's values: a kind of medium for each kind of field
/// (Field.h).
template <class FieldType>
struct MediumOf
{
  template <class Store>
  using Tracer = FieldMediumTracer<FieldType, Store>;

  FieldType Field;
  std::shared_ptr<const TransferFunction> Function; ///< not null
  MediumLook Look;
  ClipRegion Clipping;
  /// Values that define the colors: by `Colors` or, without it, directly (PackedColor, whose
  /// opacities are ignored). The function then defines only the density of the medium. Null: the
  /// function defines the colors, too.
  std::shared_ptr<const typename FieldType::Values> ColorValues = nullptr;
  std::shared_ptr<const ColorMap> Colors = nullptr;
  ///@{
  /// Null: `Function` is all. Else the emission and extinction, as a function of the values and of a second number,
  /// and `Function` is its envelope. Then color values and gradient opacity have no effect. The second number is a
  /// value of `SecondValues` or, without any, the length of the gradient (FieldType::GetGrowth).
  std::shared_ptr<const TransferFunction2D> Function2D = nullptr;
  std::shared_ptr<const typename FieldType::Values> SecondValues = nullptr;
  ///@}
  int Group = 0; ///< MediumTracer::GetGroup; of up to four media
  /// From world space to that in which the function measures lengths; the linear part.
  glm::dmat3 WorldToSpace{ 1.0 };

  /// See HasLayers.
  static constexpr bool IsLayered() { return true; }

  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.Add(this->Function->GetDigest());
    digest.Add(this->WorldToSpace);
    digest.Add(this->Look);
    digest.Add(this->Clipping);
    digest.Add(this->ColorValues != nullptr);
    if (this->ColorValues)
    {
      FieldType::AddTo(digest, *this->ColorValues);
    }
    digest.AddIf(this->Colors.get());
    digest.Add(this->Function2D ? this->Function2D->GetDigest() : 0);
    digest.Add(this->SecondValues != nullptr);
    if (this->SecondValues)
    {
      FieldType::AddTo(digest, *this->SecondValues);
    }
    digest.Add(this->Group);
  }
};

/// Such a medium for rays.
template <class FieldType, class Store>
class FieldMediumTracer final : public MediumTracer
{
public:
  /// Keeps references.
  FieldMediumTracer(Store& store, typename Store::Worker& worker, const MediumOf<FieldType>& medium)
    : Medium(medium)
    , Media(store, worker)
    , Sampler(store, worker)
  {
  }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return this->Media.FindBeam(this->Medium.Field, *this->Medium.Function, corners);
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    return this->Media.Prefetch(this->Medium.Field, beam, count);
  }

  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const override
  {
    return this->Medium.Field.FindBrick(place);
  }

  RayMask March(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light) const override
  {
    if (!this->Medium.Function->IsSeenAtAll())
    {
      return 0;
    }
    light.SetSpace(rays, wanted, this->Medium.WorldToSpace);
    light.Nearest = this->Medium.Look.Nearest;
    light.IsExact = this->Medium.Look.Exact;
    light.KeepsValues = this->Medium.Function2D != nullptr;
    const RayMask dark = this->Medium.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        return this->Media.March(
          this->Medium.Field, *this->Medium.Function, beam, parts, some, light);
      });
    light.KeepsValues = false;
    return dark;
  }

  int GetGroup() const override { return this->Medium.Group; }

  bool IsDescribed() const override
  {
    return this->IsLit() || this->HasLateExtinction() || this->Medium.ColorValues;
  }
  bool IsLit() const override { return this->Medium.Look.IsLit(); }
  bool HasLateExtinction() const override
  {
    return this->Medium.Look.Gradients != nullptr || this->Medium.Function2D != nullptr;
  }

  const MediumLook* GetMarchedLook() const override
  {
    const MediumLook& look = this->Medium.Look;
    const bool isPlain = look.Shade && !look.Gradients && !look.Nearest;
    return isPlain && !this->Medium.ColorValues && !this->Medium.Function2D &&
        this->Media.CanShade(this->Medium.Field)
      ? &look
      : nullptr;
  }

  /// Gradients hardly change within. Where they choose the look, they are found more often.
  double GetJoinedLength() const override
  {
    const double part = !this->Medium.Function2D ? 1.0 : this->Medium.Look.Exact ? 0.25 : 0.5;
    return part * this->Medium.Field.GetFinestLength(this->Medium.WorldToSpace);
  }

  void Describe(const Ray* rays, RayMask wanted, MediumLight& light) const override
  {
    std::size_t next[MaxRays];
    double left[MaxRays]; // by the pieces before the next
    ForEachRay(wanted,
      [&](int ray)
      {
        next[ray] = light.FirstPiece[ray];
        left[ray] = 1.0;
      });
    // Pieces of an envelope may hold nothing at all.
    const double least = this->Medium.Function2D ? 0.0 : MediumLight::LeastShare;
    std::vector<Asked> asked;
    for (RayMask open = wanted; open != 0;)
    {
      asked.clear();
      ForEachRay(open,
        [&](int ray)
        {
          const std::size_t end = this->GetRoundEnd(light.Pieces[ray], next[ray]);
          for (std::size_t number = next[ray]; number < end; ++number)
          {
            MediumPiece& piece = light.Pieces[ray][number];
            if (left[ray] * piece.Share > least)
            {
              asked.push_back({ &piece, &rays[ray], light.Length[ray] });
            }
          }
        });
      this->DescribePieces(asked);
      open = FindRays(open,
        [&](int ray)
        {
          std::vector<MediumPiece>& own = light.Pieces[ray];
          const std::size_t end = this->GetRoundEnd(own, next[ray]);
          for (; this->HasLateExtinction() && next[ray] < end; ++next[ray])
          {
            MediumPiece& piece = own[next[ray]];
            const double passed = std::exp(-piece.Amount[3]);
            piece.Share = left[ray] * (1.0 - passed);
            left[ray] *= passed;
            if (left[ray] < light.DarkBelow)
            {
              own.resize(next[ray] + 1);
              return false;
            }
          }
          return end < own.size();
        });
    }
  }

private:
  /// The end of the pieces that are described at once, from `first` on. Few, where the ray may become dark.
  std::size_t GetRoundEnd(const std::vector<MediumPiece>& pieces, std::size_t first) const
  {
    constexpr std::size_t most = 16;
    return this->HasLateExtinction() ? std::min(pieces.size(), first + most) : pieces.size();
  }

  /// A piece to describe.
  struct Asked
  {
    MediumPiece* Piece;
    const rt::Ray* Ray;
    double Length; ///< of a unit of T, in the space of the medium

    /// `part`: of the piece, from 0 to 1.
    glm::dvec3 GetPoint(double part) const
    {
      const double t = this->Piece->Begin + part * (this->Piece->End - this->Piece->Begin);
      return this->Ray->Origin + t * this->Ray->Direction;
    }
  };

  static std::vector<glm::dvec3> GetPoints(const std::vector<Asked>& asked, double part)
  {
    std::vector<glm::dvec3> points;
    points.reserve(asked.size());
    for (const Asked& one : asked)
    {
      points.push_back(one.GetPoint(part));
    }
    return points;
  }

  void DescribePieces(const std::vector<Asked>& asked) const
  {
    const MediumLook& look = this->Medium.Look;
    const bool isLate = this->Medium.Function2D != nullptr;
    if (isLate)
    {
      this->SetAmounts(asked);
    }
    const std::vector<glm::dvec3> points = GetPoints(asked, 0.5);
    if (this->Medium.ColorValues && !isLate)
    {
      this->SetColors(points, asked);
    }
    std::vector<glm::dvec3> gradients(points.size(), glm::dvec3(0.0));
    const bool isFactor = look.Gradients && !isLate;
    if (look.Shade || isFactor)
    {
      this->Sampler.FindSmoothGradients(this->Medium.Field, points, gradients);
    }
    for (std::size_t number = 0; number < asked.size(); ++number)
    {
      MediumPiece& piece = *asked[number].Piece;
      const glm::dvec3& gradient = gradients[number];
      if (isFactor)
      {
        const double growth = this->Medium.Field.GetGrowth(gradient);
        piece.Amount = piece.Amount * Lanes(look.Gradients->GetFactor(growth));
      }
      if (look.IsLit())
      {
        piece.Look = &look;
        piece.Normal = this->Medium.Field.GetNormal(gradient, glm::dvec3(0.0));
      }
    }
  }

  /// Replaces what the envelope gave. The second number changes evenly along a piece, as at two places of it. A value
  /// that is constant (MediumLook::Nearest) needs one.
  void SetAmounts(const std::vector<Asked>& asked) const
  {
    const bool isNearest = this->Medium.Look.Nearest;
    const double part = isNearest ? 0.5 : 0.25;
    const std::vector<double> front = this->FindSeconds(GetPoints(asked, part));
    const std::vector<double> back =
      isNearest ? front : this->FindSeconds(GetPoints(asked, 1.0 - part));
    for (std::size_t number = 0; number < asked.size(); ++number)
    {
      MediumPiece& piece = *asked[number].Piece;
      // Where one of them has no data, the other one stands for both.
      const double one = std::isnan(front[number]) ? back[number] : front[number];
      const double other = std::isnan(back[number]) ? front[number] : back[number];
      const double middle = 0.5 * (one + other);
      const double growth = other - one;
      const glm::dvec2 places[3] = { { piece.Values[0], middle - growth },
        { piece.Values[1], middle }, { piece.Values[2], middle + growth } };
      const double length = (piece.End - piece.Begin) * asked[number].Length;
      piece.Amount = this->Medium.Function2D->GetAmount(places[0], places[1], places[2], length);
    }
  }

  /// The second numbers of the function at points; NaN where there are none.
  std::vector<double> FindSeconds(const std::vector<glm::dvec3>& points) const
  {
    std::vector<double> seconds(points.size(), std::numeric_limits<double>::quiet_NaN());
    if (!this->Medium.SecondValues)
    {
      std::vector<glm::dvec3> gradients(points.size(), glm::dvec3(0.0));
      this->Sampler.FindSmoothGradients(this->Medium.Field, points, gradients);
      std::transform(gradients.begin(), gradients.end(), seconds.begin(),
        [this](const glm::dvec3& gradient) { return this->Medium.Field.GetGrowth(gradient); });
      return seconds;
    }
    this->VisitPlaces(points,
      [&](std::size_t first, const typename FieldType::Place* places, RayMask there)
      {
        double values[MaxRays];
        const RayMask found = this->Medium.Look.Nearest
          ? this->Sampler.FindNearestValues(*this->Medium.SecondValues, places, there, values)
          : this->Sampler.FindValues(*this->Medium.SecondValues, places, there, values);
        ForEachRay(found,
          [&](int index) { seconds[first + static_cast<std::size_t>(index)] = values[index]; });
      });
    return seconds;
  }

  /// Calls `visit(first, places, there)` for batches of points: the index of the first one, and which have a place.
  template <class Visit>
  void VisitPlaces(const std::vector<glm::dvec3>& points, const Visit& visit) const
  {
    for (std::size_t first = 0; first < points.size(); first += MaxRays)
    {
      const auto count = static_cast<int>(std::min<std::size_t>(MaxRays, points.size() - first));
      typename FieldType::Place places[MaxRays];
      const RayMask there = FindRays(~RayMask{ 0 } >> (MaxRays - count),
        [&](int index)
        {
          return this->Sampler.FindPlace(
            this->Medium.Field, points[first + static_cast<std::size_t>(index)], places[index]);
        });
      visit(first, places, there);
    }
  }

  /// Gives pieces the colors that there are at points.
  void SetColors(const std::vector<glm::dvec3>& points, const std::vector<Asked>& asked) const
  {
    std::vector<glm::vec4> colors(points.size(), glm::vec4(0.0f));
    this->VisitPlaces(points,
      [&](std::size_t first, const typename FieldType::Place* places, RayMask there)
      {
        glm::vec4 found[MaxRays];
        if (this->Medium.Colors)
        {
          double values[MaxRays];
          this->Sampler.FindValues(*this->Medium.ColorValues, places, there, values);
          ForEachRay(
            there, [&](int index) { found[index] = this->Medium.Colors->Map(values[index]); });
        }
        else
        {
          there = this->Sampler.FindColors(*this->Medium.ColorValues, places, there, found);
        }
        ForEachRay(there,
          [&](int index) { colors[first + static_cast<std::size_t>(index)] = found[index]; });
      });
    for (std::size_t number = 0; number < asked.size(); ++number)
    {
      Lanes& amount = asked[number].Piece->Amount;
      const glm::dvec3 color = amount[3] * glm::dvec3(colors[number]);
      amount = Lanes(color.x, color.y, color.z, amount[3]);
    }
  }

  const MediumOf<FieldType>& Medium;
  typename FieldType::template Media<Store> Media;
  typename FieldType::template Sampler<Store> Sampler;
};

} // namespace rt

#endif
