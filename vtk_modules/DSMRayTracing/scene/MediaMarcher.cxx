// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/MediaMarcher.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace rt
{

namespace
{

/// Adds up what pieces of several media hold, which are in order in each medium but not between them: cuts them where
/// any begins or ends.
void MergePieces(std::vector<MediumPiece>& pieces, int ray, MediumLight& light)
{
  std::stable_sort(pieces.begin(), pieces.end(),
    [](const MediumPiece& one, const MediumPiece& other) { return one.Begin < other.Begin; });
  std::vector<double> ends;
  for (const MediumPiece& piece : pieces)
  {
    ends.push_back(piece.Begin);
    ends.push_back(piece.End);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<std::size_t> open; // pieces that the current part is in
  std::size_t next = 0;
  for (std::size_t end = 1; end < ends.size() && !light.IsDark(ray); ++end)
  {
    const double begin = ends[end - 1];
    for (; next < pieces.size() && pieces[next].Begin <= begin; ++next)
    {
      open.push_back(next);
    }
    open.erase(std::remove_if(open.begin(), open.end(),
                 [&](std::size_t number) { return pieces[number].End <= begin; }),
      open.end());
    Lanes amount(0.0);
    for (const std::size_t number : open)
    {
      const MediumPiece& piece = pieces[number];
      amount = amount + piece.Amount * Lanes((ends[end] - begin) / (piece.End - piece.Begin));
    }
    light.Add(ray, { begin, ends[end], amount });
  }
}

} // namespace

MediaMarcher::MediaMarcher(const SceneTracers& tracers)
  : Media(tracers.Media)
  , FirstBeam(tracers.Objects.size())
{
  const auto any = [&](const auto& test)
  { return std::any_of(this->Media.begin(), this->Media.end(), test); };
  this->IsLit = any([](const auto& medium) { return medium->IsLit(); });
  this->KeepsPieces =
    this->Media.size() > 1 || any([](const auto& medium) { return medium->IsDescribed(); });
}

void MediaMarcher::March(
  const MediumTracer& medium, const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light)
{
  const bool isDescribed = light.KeepsPieces && medium.IsDescribed();
  // Each ends where it is dark by itself: so are the others behind that.
  light.ClearSums(wanted);
  light.DarkBelow = medium.HasLateExtinction() ? 0.0 : MediumLight::Dark;
  light.JoinedLength = isDescribed ? medium.GetJoinedLength() : 0.0;
  ForEachRay(wanted, [&](int ray) { light.FirstPiece[ray] = light.Pieces[ray].size(); });
  medium.March(rays, wanted, beam, light);
  if (isDescribed)
  {
    medium.Describe(rays, wanted, light);
  }
  light.DarkBelow = MediumLight::Dark;
}

void MediaMarcher::Gather(
  const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light) const
{
  light.Begin(rays, wanted);
  light.KeepsPieces = this->KeepsPieces;
  for (std::size_t medium = 0; medium < this->Media.size(); ++medium)
  {
    ObjectBeam* const own = beam ? beam->Objects[this->FirstBeam + medium].get() : nullptr;
    March(*this->Media[medium], rays, wanted, own, light);
  }
}

void MediaMarcher::Merge(RayMask wanted, MediumLight& light) const
{
  if (!std::exchange(light.KeepsPieces, false))
  {
    return;
  }
  light.ClearSums(wanted);
  ForEachRay(wanted,
    [&](int ray)
    {
      light.First[ray] = std::numeric_limits<double>::infinity();
      if (this->Media.size() > 1)
      {
        MergePieces(light.Pieces[ray], ray, light);
        return;
      }
      for (const MediumPiece& piece : light.Pieces[ray])
      {
        if (light.IsDark(ray))
        {
          break;
        }
        light.Add(ray, piece);
      }
    });
}

ObjectTracer::Brick MediaMarcher::FindBrick(const glm::dvec3& place) const
{
  ObjectTracer::Brick brick{ nullptr, 0 };
  for (const auto& medium : this->Media)
  {
    brick = brick.Segment ? brick : medium->FindBrick(place);
  }
  return brick;
}

void MediaMarcher::Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const
{
  const auto light = std::make_unique<MediumLight>();
  for (const auto& medium : this->Media)
  {
    if (!medium->DimsLamps())
    {
      continue;
    }
    light->Begin(rays, wanted);
    light->KeepsPieces = medium->HasLateExtinction();
    March(*medium, rays, wanted, nullptr, *light);
    if (std::exchange(light->KeepsPieces, false))
    {
      light->ClearSums(wanted);
      ForEachRay(wanted,
        [&](int ray)
        {
          for (const MediumPiece& piece : light->Pieces[ray])
          {
            light->Add(ray, piece);
          }
        });
    }
    ForEachRay(wanted, [&](int ray) { transmittances[ray] *= light->Transmittance[ray]; });
  }
}

} // namespace rt
