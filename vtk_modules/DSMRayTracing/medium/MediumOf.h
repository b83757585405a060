// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumOf_h
#define rt_MediumOf_h

#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/look/MediumLook.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
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
    return this->Medium.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        return this->Media.March(
          this->Medium.Field, *this->Medium.Function, beam, parts, some, light);
      });
  }

  int GetGroup() const override { return this->Medium.Group; }

  bool IsDescribed() const override
  {
    return this->IsLit() || this->HasLateExtinction() || this->Medium.ColorValues;
  }
  bool IsLit() const override { return this->Medium.Look.IsLit(); }
  bool HasLateExtinction() const override { return this->Medium.Look.Gradients != nullptr; }

  const MediumLook* GetMarchedLook() const override
  {
    const MediumLook& look = this->Medium.Look;
    const bool isPlain = look.Shade && look.Scattering == 0.0 && !look.Gradients && !look.Nearest;
    return isPlain && !this->Medium.ColorValues && this->Media.CanShade(this->Medium.Field)
      ? &look
      : nullptr;
  }

  /// Gradients hardly change within.
  double GetJoinedLength() const override
  {
    return this->Medium.Field.GetFinestLength(this->Medium.WorldToSpace);
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
    std::vector<glm::dvec3> points;
    std::vector<MediumPiece*> pieces;
    for (RayMask open = wanted; open != 0;)
    {
      points.clear();
      pieces.clear();
      ForEachRay(open,
        [&](int ray)
        {
          const std::size_t end = this->GetRoundEnd(light.Pieces[ray], next[ray]);
          for (std::size_t number = next[ray]; number < end; ++number)
          {
            MediumPiece& piece = light.Pieces[ray][number];
            if (left[ray] * piece.Share > MediumLight::LeastShare)
            {
              pieces.push_back(&piece);
              points.push_back(rays[ray].Origin + piece.GetMiddle() * rays[ray].Direction);
            }
          }
        });
      this->DescribePieces(points, pieces);
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

  /// Describes pieces, whose middles are at `points`.
  void DescribePieces(
    const std::vector<glm::dvec3>& points, const std::vector<MediumPiece*>& pieces) const
  {
    if (this->Medium.ColorValues)
    {
      this->SetColors(points, pieces);
    }
    const MediumLook& look = this->Medium.Look;
    std::vector<glm::dvec3> gradients(points.size(), glm::dvec3(0.0));
    if (look.Shade || look.Gradients)
    {
      this->Sampler.FindSmoothGradients(this->Medium.Field, points, gradients);
    }
    for (std::size_t number = 0; number < pieces.size(); ++number)
    {
      MediumPiece& piece = *pieces[number];
      const glm::dvec3& gradient = gradients[number];
      if (look.Gradients)
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

  /// Gives pieces the colors that there are at points.
  void SetColors(
    const std::vector<glm::dvec3>& points, const std::vector<MediumPiece*>& pieces) const
  {
    for (std::size_t first = 0; first < points.size(); first += MaxRays)
    {
      const auto count = static_cast<int>(std::min<std::size_t>(MaxRays, points.size() - first));
      typename FieldType::Place places[MaxRays];
      const RayMask all = ~RayMask{ 0 } >> (MaxRays - count);
      glm::vec4 colors[MaxRays];
      const RayMask there = FindRays(all,
        [&](int index)
        {
          colors[index] = glm::vec4(0.0f);
          return this->Sampler.FindPlace(
            this->Medium.Field, points[first + static_cast<std::size_t>(index)], places[index]);
        });
      if (this->Medium.Colors)
      {
        double values[MaxRays];
        this->Sampler.FindValues(*this->Medium.ColorValues, places, there, values);
        ForEachRay(
          there, [&](int index) { colors[index] = this->Medium.Colors->Map(values[index]); });
      }
      else
      {
        const RayMask found =
          this->Sampler.FindColors(*this->Medium.ColorValues, places, there, colors);
        ForEachRay(there & ~found, [&](int index) { colors[index] = glm::vec4(0.0f); });
      }
      for (int index = 0; index < count; ++index)
      {
        Lanes& amount = pieces[first + static_cast<std::size_t>(index)]->Amount;
        const glm::dvec3 color = amount[3] * glm::dvec3(colors[index]);
        amount = Lanes(color.x, color.y, color.z, amount[3]);
      }
    }
  }

  const MediumOf<FieldType>& Medium;
  typename FieldType::template Media<Store> Media;
  typename FieldType::template Sampler<Store> Sampler;
};

} // namespace rt

#endif
