// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileSampler_h
#define rt_TileSampler_h

#include "DSMRayTracing/frame/BeamHistory.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/PixelSampler.h"

#include <glm/vec3.hpp>

#include <cstddef>

namespace rt
{

/// Traces the pixels of a tile, one worker's view of one frame. With a BeamHistory, bricks that the
/// tile's beams will probably need are prefetched.
class TileSampler
{
public:
  /// Keeps references.
  TileSampler(const SceneTracers& tracers, const Scene& scene, const PixelRays& rays,
    const FrameRequest& request, BeamHistory* beams = nullptr);

  /// Adds the request's samples to the tile's sums, which hold the samples before them. May wait for
  /// bricks.
  void Trace(Tile& tile) const;

  /// Asks for the bricks that the tile will probably need, before it is traced by any worker. Returns
  /// whether any was absent. Never waits.
  bool Prefetch(const Tile& tile) const;

  /// Makes pixels of the sums; `tint` is multiplied with their colors.
  void Finish(Tile& tile, const glm::vec3& tint) const;

private:
  /// Some of a tile's pixels.
  struct PixelBox
  {
    int Left;
    int Top;
    int Width;
    int Height;
  };

  /// Calls `visit(box)` for squares of `edge` pixels, and what remains at the borders.
  template <class Visit>
  static void Split(const PixelBox& whole, int edge, const Visit& visit);

  SceneBeam FindBeam(const Tile& tile, const PixelBox& box) const;
  bool Prefetch(const SceneBeam& beam, const Tile& tile, const PixelBox& box) const;
  void Record(const SceneBeam& beam, const Tile& tile, const PixelBox& box) const;

  /// Adds the samples of pixels that share a beam; of one that fits into a batch.
  void TraceBeam(Tile& tile, const PixelBox& box) const;
  void TraceBatch(Tile& tile, SceneBeam& beam, const PixelBox& box) const;
  static void AddSample(const PixelSample& traced, Tile& tile);

  static void SetCounts(int samples, const PixelBox& box, Tile& tile);
  /// Returns whether `is(pixel)` of any pixel of a box.
  template <class Is>
  static bool FindPixel(const Tile& tile, const PixelBox& box, const Is& is);
  bool IsOpen(const Tile& tile, const PixelBox& box) const;
  bool AreEnough(int samples, const Tile& tile, const PixelBox& box) const;

  std::vector<const BeamFinder*> Finders; ///< in the order of SceneBeam
  PixelSampler Pixels;
  const FrameRequest& Request;
  BeamHistory* Beams; ///< null: nothing is prefetched
};

} // namespace rt

#endif
