// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumTracer_h
#define rt_MediumTracer_h

#include "DSMRayTracing/object/BeamFinder.h"
#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>

namespace rt
{

/// A medium that rays pass through, as one worker traces it: all that the rooms above know of it. Rays come in batches
/// of up to MaxRays; what a ray finds does not depend on the others. A kind of medium derives from this for a store.
///
/// Calls may wait for bricks, and throw what the store throws.
class MediumTracer : public BeamFinder
{
public:
  /// Gives to `light`, which was begun with the rays, what the medium adds along those of them that are `wanted`, in
  /// [ray.Min, ray.Max], from the front. Returns those that are dark, whose march may have ended early. `beam`: of this
  /// medium, with all of the rays within; null: rays go where they like.
  virtual RayMask March(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light) const = 0;

  /// The brick that has a place's values (world space); of no segment, where the medium is not.
  virtual ObjectTracer::Brick FindBrick(const glm::dvec3& place) const = 0;

  /// Returns whether the medium attenuates the light of lamps. If not, only rays from the camera
  /// see it.
  virtual bool DimsLamps() const { return true; }

  /// Media of the same group, if it is not 0, are looks of one: where several are, what they emit adds up, and
  /// their depth is the mean of their depths, weighted by these.
  virtual int GetGroup() const { return 0; }

  /// Returns whether pieces have to be kept, and described.
  virtual bool IsDescribed() const { return false; }
  ///@{
  /// Results of Describe: whether light makes the pieces shine, and whether their density is known
  /// only then.
  virtual bool IsLit() const { return false; }
  virtual bool HasLateExtinction() const { return false; }
  ///@}
  /// The look, if March itself can shade the medium with it (MediumLight::Shading); null: only Describe can.
  virtual const MediumLook* GetMarchedLook() const { return nullptr; }
  /// Length up to which pieces may be joined before they are described, in the space of the medium
  /// (MediumLight::SetSpace).
  virtual double GetJoinedLength() const { return 0.0; }
  /// Adds that to the pieces of the rays that are `wanted`, from MediumLight::FirstPiece on. Where density is known
  /// only then, drops the pieces behind the place where a ray is dark.
  virtual void Describe(const Ray* /*rays*/, RayMask /*wanted*/, MediumLight&) const {}

  /// Adds the integrals of values along those of the rays that are `wanted`, in [ray.Min, ray.Max], over their length
  /// in world space, to `integrals[ray]`. By default there are none. `beam`: as for March.
  virtual void Integrate(
    const Ray* /*rays*/, RayMask /*wanted*/, ObjectBeam* /*beam*/, double* /*integrals*/) const
  {
  }
};

} // namespace rt

#endif
