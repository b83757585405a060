// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceTracer_h
#define rt_IsosurfaceTracer_h

#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/volume/FieldSampler.h"
#include "DSMRayTracing/volume/IndexSpace.h"
#include "DSMRayTracing/volume/IsosurfaceObject.h"
#include "DSMRayTracing/volume/IsosurfacePacketSearch.h"
#include "DSMRayTracing/volume/IsosurfaceSearch.h"
#include "DSMRayTracing/volume/IsovaluePredicate.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rt
{

/// Isosurfaces of a volume as an object that rays meet. Rays within a beam, and those to a lamp, are
/// searched as packets, others one by one.
template <class Store>
class IsosurfaceTracer final : public ObjectTracer
{
public:
  /// Keeps references.
  IsosurfaceTracer(Store& store, typename Store::Worker& worker, const IsosurfaceObject& object)
    : Blocks(store)
    , Object(object)
    , Search(store, worker)
    , Packets(store, worker)
    , Fields(store, worker)
  {
    const glm::dmat3 edges(object.IndexToWorld);
    this->Sheets = object.GetSheetTransmittances();
    this->Clearance = ClearancePart *
      std::min({ glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2]) });
  }

  bool IsOpaque() const override { return this->Object.IsOpaque(); }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return std::make_unique<BeamBricks>(this->Packets.FindBricks(this->Object, corners));
  }

  bool Prefetch(const ObjectBeam& beam, const BrickForecast& forecast) const override
  {
    const auto& bricks = static_cast<const BeamBricks&>(beam).Bricks;
    // One that was sent in vain, or that the system has read in vain, costs little; one that was cut out of a file in
    // vain costs a thread's time, so of these only the first ones are foreseen of those that no beam around did
    // without.
    const dsm::BlockDirectory& directory = this->Object.Field->Segment->GetDirectory();
    const bool isCut = directory.IsFromSource() && !directory.IsOnOwnersDisk();
    std::vector<dsm::BlockId> ids(
      this->Object.IsSeen() ? std::min(forecast.Mean, bricks.size()) : 0);
    std::transform(bricks.begin(), bricks.begin() + static_cast<std::ptrdiff_t>(ids.size()),
      ids.begin(), [](const BeamBricks::Brick& brick) { return brick.Id; });
    std::size_t count = ids.size();
    if (isCut)
    {
      this->Blocks.TellSystem(*this->Object.Field->Segment, ids.data(), ids.size(),
        [this](dsm::BlockId id, std::vector<dsm::BlockId>& around) { this->AddRow(id, around); });
      count = std::min(count, (forecast.Least + 1) / 2);
    }
    return this->Blocks.Prefetch(*this->Object.Field->Segment, ids.data(), count);
  }

  void FindNext(Ray* rays, RayMask wanted, ObjectBeam* beam, ObjectHit* nearest) const override
  {
    if (!this->Object.IsSeen())
    {
      return;
    }
    const auto open = [&](int index, double place)
    { return nearest[index].Open<IsosurfaceHit>(*this, place, rays[index]); };
    auto* const bricks = static_cast<BeamBricks*>(beam);
    this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        return bricks ? this->Packets.Intersect(this->Object, *bricks, parts, some, open)
                      : this->Search.IntersectEach(this->Object, parts, some, open);
      });
  }

  RayMask FindOccluded(const Ray* rays, RayMask wanted) const override
  {
    return this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      { return this->Packets.FindOccluded(this->Object, parts, some); });
  }

  RayMask Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const override
  {
    if (!this->Object.IsSeen() || this->Sheets.empty())
    {
      return this->ObjectTracer::Attenuate(rays, wanted, transmittances);
    }
    return this->Object.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      { return this->Packets.Attenuate(this->Object, this->Sheets, parts, some, transmittances); });
  }

  void Describe(const ObjectHit& nearest, const Ray& ray, SurfacePoint& point) const override
  {
    const auto& hit = nearest.Get<IsosurfaceHit>();
    const IsosurfaceObject& object = this->Object;
    point.T = hit.T;
    point.Position = ray.Origin + hit.T * ray.Direction;
    point.Normal = object.Flat ? this->GetFlatNormal(hit, ray) : hit.Normal;
    point.Facing = hit.FromInside ? -point.Normal : point.Normal;
    const Material* const surface = object.GetSurface(hit.FromInside);
    point.Surface = surface ? surface : &object.Surface;
    const BlockLooks::Look* look =
      object.Blocks ? object.Blocks->Find(bricks::Index3(hit.Cell)) : nullptr;
    const bool isOfBlock = look && look->Color;
    point.ColorIsFromArray = isOfBlock || object.ColorField;
    point.Color = isOfBlock ? *look->Color
      : object.ColorField   ? this->GetColor(hit)
                            : glm::vec4(point.Surface->DiffuseColor, 1.0f);
    const float opacity = surface ? surface->Opacity : 0.0f;
    point.Color.w *= look && surface ? look->Opacity.value_or(opacity) : opacity;
    if (!object.Opacities.empty())
    {
      point.Color.w *= object.Opacities[hit.Isovalue];
    }
    point.Clearance = this->Clearance;
    point.Edges = nullptr;
  }

  Brick FindBrick(const ObjectHit& hit) const override
  {
    const bricks::VoxelField& field = *this->Object.Field;
    return { field.Segment.get(), field.Lattice.FindBrick(hit.Get<IsosurfaceHit>().IndexPoint) };
  }

private:
  /// Of the shortest edge of a cell. Roots are found to 1e-7 of the way through a cell.
  static constexpr double ClearancePart = 1e-4;

  /// Bricks in a row are told of together when they are in the same part of it, of so many.
  static constexpr std::int64_t PartOfRow = 8;

  /// What lies beside a brick in its row, and so in most files, as far as it may have to do with the surface: a disk
  /// brings it along for little.
  void AddRow(dsm::BlockId id, std::vector<dsm::BlockId>& around) const
  {
    const bricks::VoxelField& field = *this->Object.Field;
    const std::vector<bricks::ValueRange>& ranges = field.Hierarchy.GetLevels().front().Ranges;
    const IsovaluePredicate mayHold(this->Object.Isovalues);
    const bricks::Index3 place = field.Lattice.GetBrick(id);
    const std::int64_t first = place.x / PartOfRow * PartOfRow;
    const std::int64_t last = std::min(first + PartOfRow, field.Lattice.GetBricks().x) - 1;
    const auto find = [&](std::int64_t x) { return field.Lattice.GetId({ x, place.y, place.z }); };
    for (const std::int64_t step : { -1, 1 })
    {
      for (std::int64_t x = place.x + step; x >= first && x <= last && mayHold(ranges[find(x)]);
           x += step)
      {
        around.push_back(find(x));
      }
    }
  }

  glm::dvec3 GetFlatNormal(const IsosurfaceHit& hit, const Ray& ray) const
  {
    const glm::dvec3 gradient =
      this->Fields.GetGradient(*this->Object.Field, hit.Cell, hit.IndexPoint);
    return IndexSpace(this->Object.IndexToWorld, this->Object.WorldToIndex)
      .GetNormal(&gradient.x, ray.Direction);
  }

  /// Where the field has no data, the colour of what is not a number.
  glm::vec4 GetColor(const IsosurfaceHit& hit) const
  {
    const bricks::VoxelField& field = *this->Object.ColorField;
    const ColorMap& map = this->Object.Colors;
    const bool ofCells = field.Lattice.IsOfCells();
    if (this->Object.ColoredBy == IsosurfaceObject::Coloring::Values)
    {
      // Between categories, there is nothing.
      return map.Map(ofCells ? this->Fields.GetOfCell(field, hit.Cell)
          : map.Categories   ? this->Fields.SampleNearest(field, hit.IndexPoint)
                             : this->Fields.Sample(field, hit.IndexPoint));
    }
    glm::vec4 color;
    const bool found = ofCells ? this->Fields.GetColorOfCell(field, hit.Cell, color)
                               : this->Fields.SampleColor(field, hit.IndexPoint, color);
    return found ? color : map.NotANumber;
  }

  Store& Blocks;
  const IsosurfaceObject& Object;
  IsosurfaceSearch<Store> Search;
  IsosurfacePacketSearch<Store> Packets;
  FieldSampler<Store> Fields;
  std::vector<glm::dvec3> Sheets; ///< IsosurfaceObject::GetSheetTransmittances
  double Clearance;
};

} // namespace rt

#endif
