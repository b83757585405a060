// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/MediaMarcher.h"

#include "DSMRayTracing/field/MediumTolerance.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace rt
{

namespace
{

/// Sum over the pieces of media in the same part of a ray.
class PartSum
{
public:
  void Clear()
  {
    this->Sum = Lanes(0.0);
    this->Groups.clear();
  }

  void Add(const Lanes& amount, int group)
  {
    if (group == 0)
    {
      this->Sum = this->Sum + amount;
      return;
    }
    auto known = std::find_if(this->Groups.begin(), this->Groups.end(),
      [=](const Group& one) { return one.Number == group; });
    if (known == this->Groups.end())
    {
      known = this->Groups.insert(known, { group, Lanes(0.0), 0.0 });
    }
    known->Sum = known->Sum + amount;
    known->Squares += amount[3] * amount[3];
  }

  Lanes Get() const
  {
    Lanes all = this->Sum;
    for (const Group& group : this->Groups)
    {
      const Lanes& sum = group.Sum;
      all = sum[3] > 0.0 ? all + Lanes(sum[0], sum[1], sum[2], group.Squares / sum[3]) : all;
    }
    return all;
  }

private:
  struct Group
  {
    int Number;
    Lanes Sum;
    double Squares; ///< sum of the squares of its depths
  };

  Lanes Sum{ 0.0 };
  std::vector<Group> Groups;
};

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
  PartSum sum;
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
    sum.Clear();
    for (const std::size_t number : open)
    {
      const MediumPiece& piece = pieces[number];
      sum.Add(piece.Amount * Lanes((ends[end] - begin) / (piece.End - piece.Begin)), piece.Group);
    }
    light.Add(ray, { begin, ends[end], sum.Get() });
  }
}

} // namespace

MediaMarcher::MediaMarcher(const SceneTracers& tracers)
  : Media(tracers.Media)
  , FirstBeam(tracers.Objects.size())
  , Errors(tracers.MediumErrors)
{
  const auto any = [&](const auto& test)
  { return std::any_of(this->Media.begin(), this->Media.end(), test); };
  this->IsLit = any([](const auto& medium) { return medium->IsLit(); });
  this->KeepsPieces =
    this->Media.size() > 1 || any([](const auto& medium) { return medium->IsDescribed(); });
}

void MediaMarcher::March(const MediumTracer& medium, bool isDescribed, const Ray* rays,
  RayMask wanted, ObjectBeam* beam, MediumLight& light)
{
  // Each ends where it is dark by itself: so are the others behind that.
  light.ClearSums(wanted);
  const double darkBelow = medium.GetGroup() != 0 ? MediumLight::DarkInGroup : MediumLight::Dark;
  light.HasLateExtinction = medium.HasLateExtinction();
  light.DarkBelow = light.HasLateExtinction ? 0.0 : darkBelow;
  light.JoinedLength = isDescribed ? medium.GetJoinedLength() : 0.0;
  ForEachRay(wanted, [&](int ray) { light.FirstPiece[ray] = light.Pieces[ray].size(); });
  medium.March(rays, wanted, beam, light);
  light.DarkBelow = darkBelow;
  if (isDescribed)
  {
    medium.Describe(rays, wanted, light);
  }
  light.HasLateExtinction = false;
  light.DarkBelow = MediumLight::Dark;
  if (medium.GetGroup() != 0)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        for (std::size_t piece = light.FirstPiece[ray]; piece < light.Pieces[ray].size(); ++piece)
        {
          light.Pieces[ray][piece].Group = medium.GetGroup();
        }
      });
  }
}

void MediaMarcher::LocatePlaces(
  const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light) const
{
  light.Begin(rays, wanted);
  light.KeepsPieces = false;
  light.Shading = nullptr;
  light.LocatesPlaces = true;
  light.ErrorFactor = 1.0 / (MediumTolerance::Shadow * this->Errors);
  ObjectBeam* const own = beam ? beam->Objects[this->FirstBeam].get() : nullptr;
  March(*this->Media.front(), false, rays, wanted, own, light);
}

void MediaMarcher::Gather(
  const Ray* rays, RayMask wanted, SceneBeam* beam, MediumLight& light) const
{
  light.Begin(rays, wanted);
  light.KeepsPieces = this->KeepsPieces;
  light.ErrorFactor = 1.0 / this->Errors;
  light.Shading = this->Shading ? &*this->Shading : nullptr;
  for (std::size_t medium = 0; medium < this->Media.size(); ++medium)
  {
    ObjectBeam* const own = beam ? beam->Objects[this->FirstBeam + medium].get() : nullptr;
    const bool isDescribed = light.KeepsPieces && this->Media[medium]->IsDescribed();
    March(*this->Media[medium], isDescribed, rays, wanted, own, light);
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
  std::vector<int> groups;
  for (const auto& medium : this->Media)
  {
    const int group = medium->GetGroup();
    if (!medium->DimsLamps() || std::find(groups.begin(), groups.end(), group) != groups.end())
    {
      continue;
    }
    light->Begin(rays, wanted);
    light->KeepsPieces = group != 0 || medium->HasLateExtinction();
    light->ErrorFactor = 1.0 / (MediumTolerance::Shadow * this->Errors);
    for (const auto& other : this->Media)
    {
      if (other == medium || (group != 0 && other->GetGroup() == group))
      {
        March(*other, other->HasLateExtinction(), rays, wanted, nullptr, *light);
      }
    }
    if (group != 0)
    {
      groups.push_back(group);
    }
    if (std::exchange(light->KeepsPieces, false))
    {
      light->ClearSums(wanted);
      ForEachRay(wanted,
        [&](int ray)
        {
          if (group != 0)
          {
            MergePieces(light->Pieces[ray], ray, *light);
            return;
          }
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
