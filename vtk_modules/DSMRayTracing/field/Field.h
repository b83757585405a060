// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Field_h
#define rt_Field_h

#include "DSMBricks/base/Box.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/object/ObjectTracer.h"

namespace rt
{

template <class FieldType, class Store>
class WalkExtrema;
template <class FieldType, class Store>
class WalkMedia;
template <class FieldType>
class WalkSections;
template <class FieldType, class Store>
class WalkSurfaces;

/// Where rays that leave a field's surface begin, as a part of GetFinestLength (SurfacePoint::Clearance): roots are
/// found to 1e-7 of the way through a cell. A kind whose surfaces are facets, but are shaded as if they were round, has
/// more: else facets shade one another.
template <class FieldType>
inline constexpr double ClearancePart = 1e-4;

/// Base of all kinds of fields. A field is values in space that can be walked and sampled: all that is shown of it
/// comes from its Walk and its Sampler by default (room field/walk). A kind derives from this, brings what follows,
/// and replaces a default where it is faster of its own. FieldCheck looks for all of it when a kind is compiled. It is
/// a small value: what it describes is shared, and outlives the frame.
///
/// - `Values`: what is sampled. Several of them may have the same places: one defines the surfaces, another their
///   colors.
/// - `Place`: a position in the field's own coordinates. Plain data, without initial values.
/// - `Walk<Store>`, for one worker of a store, with `Walk(Store&, Store::Worker&)` and `bool Find(field, ray,
///   mayHold, visit) const`: calls `visit(FieldSegment<Place>)` for the segments of a ray within [ray.Min,
///   ray.Max], in order, until it returns true; returns whether it did. May leave out segments of which
///   `mayHold(range)` is false for the range of their values (ValuePredicates.h), which may change during the walk.
///   A segment depends on the ray alone. Where WalksTogether is true, it has WalkSearch::FindEach instead.
/// - `Sampler<Store>`, for one worker of a store, which derives from PlainSampler, with `Sampler(Store&,
///   Store::Worker&)`, `RayMask FindValues(values, places, wanted, numbers) const`: NaN where there are no data;
///   returns the places that are in the field; `void FindGradients(values, places, wanted, gradients) const`: how
///   fast values grow on each axis of the field's own space, as the values are between samples. Both hold at most
///   one pin, and none while they acquire or when a call returns. They may wait for bricks, and throw what the
///   store throws.
/// - `const Values& GetValues() const`: those that define surfaces and media.
/// - `bool FindPlace(point, place) const`: the place of a point in world space as far as it is known without
///   bricks; false where the field surely is not. Sampler::FindPlaces finds the rest.
/// - `void MovePlace(point, place) const`: moves a place to a point in world space that is in the same cell.
/// - `glm::dvec3 GetNormal(gradient, rayDirection) const`: the unit normal in world space, towards lower values;
///   opposite to the ray if the gradient is 0.
/// - `double GetFinestLength(worldToSpace = 1) const`: the length of the smallest detail, such as the shortest edge
///   of a cell, in the space to which the matrix leads.
/// - `double GetGrowth(gradient) const`: how much values grow in a cell of mean size.
/// - `void AddTo(digest) const`, and for values `static void AddTo(digest, values)`: all that a picture depends on.
/// - `static bool HasHoles(values)`: whether any place within the field has no value.
template <class FieldType>
struct WalkedField
{
  static constexpr bool WalksTogether = false;
  ///@{
  /// What finds isosurfaces, takes rays through media, finds extrema and planes: LatticeSurfaces, LatticeMedia,
  /// VoxelExtrema and LatticeSections say what one that replaces it has to do.
  template <class Store>
  using Surfaces = WalkSurfaces<FieldType, Store>;
  template <class Store>
  using Media = WalkMedia<FieldType, Store>;
  template <class Store>
  using Extrema = WalkExtrema<FieldType, Store>;
  using Sections = WalkSections<FieldType>;
  ///@}

  /// The blocks that have the values; null: there are none.
  template <class Values>
  static const dsm::BlockSegment* GetSegment(const Values&)
  {
    return nullptr;
  }
  /// The brick of a Place, or that of a point in world space; of no segment, where there is none.
  template <class Position>
  ObjectTracer::Brick FindBrick(const Position&) const
  {
    return { nullptr, 0 };
  }
  /// The cell that tells which block of BlockLooks has a place.
  template <class Place>
  bricks::Index3 GetBlockCell(const Place&) const
  {
    return bricks::Index3(0);
  }
};

} // namespace rt

#endif
