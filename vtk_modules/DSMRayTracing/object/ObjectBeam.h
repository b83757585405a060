// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ObjectBeam_h
#define rt_ObjectBeam_h

#include <cstddef>

namespace rt
{

/// Data about the rays of a beam that an object finds beforehand. Each kind of object derives its
/// own. Belongs to the worker that has the beam.
struct ObjectBeam
{
  virtual ~ObjectBeam() = default;

  /// False where rays may not meet the object.
  virtual bool MayMeet() const = 0;

  /// False: the rays cannot be treated alike; those of a smaller beam may.
  bool Usable = false;
  /// How many of the object's bricks that the beam meets, from the front, rays have come to so far: told
  /// by ObjectTracer::FindNext.
  std::size_t Reached = 0;
};

} // namespace rt

#endif
