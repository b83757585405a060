// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ObjectTracer_h
#define rt_ObjectTracer_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/object/BeamFinder.h"
#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/object/ObjectHit.h"
#include "DSMRayTracing/object/PictureView.h"
#include "DSMRayTracing/object/SurfacePoint.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace rt
{

/// An object that rays meet, as one worker traces it: all that the rooms above know of it. Rays come in
/// batches of up to MaxRays, and one ray is a batch of one; what a ray finds does not depend on the
/// others. A kind of object derives from this for a store (so that access to a brick that is there stays
/// a load), and chooses for each batch what is fastest.
///
/// Calls may wait for bricks, and throw what the store throws.
class ObjectTracer : public BeamFinder
{
public:
  /// Index in Scene::Objects; -1 for an object of no scene.
  std::int32_t GetNumber() const { return this->Number; }
  void SetNumber(std::int32_t number) { this->Number = number; }

  /// Returns whether the object lets no light through anywhere, so that any hit blocks a ray of
  /// light.
  virtual bool IsOpaque() const = 0;

  /// Finds the first hits of those rays that are `wanted` in [ray.Min, ray.Max], and gives them to
  /// ObjectHit::Take, which has the hits of other objects so far. `beam`: of this object, with all of
  /// the rays within; null: rays go where they like.
  virtual void FindNext(Ray* rays, RayMask wanted, ObjectBeam* beam, ObjectHit* nearest) const = 0;

  /// Returns the subset of `wanted` rays that hit anything in [ray.Min, ray.Max]: FindNext finds a hit for each of
  /// them.
  virtual RayMask FindOccluded(const Ray* rays, RayMask wanted) const = 0;

  /// Multiplies the transmittances of those of the rays that are `wanted` by GetSheetTransmittance of every
  /// surface that they meet in [ray.Min, ray.Max]. Returns the rays that are dark (IsDark) then, whose search
  /// ends early. Unless overridden, finds the surfaces one after the other.
  virtual RayMask Attenuate(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const;

  /// Describes the surfaces that the `wanted` rays meet, which all have hits of this object. All arrays are by ray.
  /// `views`: the pictures that the rays belong to; null: they are rays of light, and no lines are drawn.
  virtual void Describe(const ObjectHit* hits, const Ray* rays, const PictureView* const* views,
    RayMask wanted, SurfacePoint* const* points) const = 0;

  /// A brick of a segment; null: of none, for the object has no bricks.
  struct Brick
  {
    const dsm::BlockSegment* Segment;
    dsm::BlockId Id;
  };
  /// The one that holds the place of the hit.
  virtual Brick FindBrick(const ObjectHit& hit) const = 0;

private:
  std::int32_t Number = -1;
};

} // namespace rt

#endif
