// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileSampler_h
#define rt_TileSampler_h

#include "DSMRayTracing/frame/BeamHistory.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/KeptHits.h"
#include "DSMRayTracing/frame/PixelSampler.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace rt
{

/// Traces the pixels of a tile, one worker's view of one frame. With a BeamHistory, bricks that the
/// tile's beams will probably need are prefetched.
class TileSampler
{
public:
  /// Keeps references.
  /// `hits`: of this frame; null: none are known or kept.
  TileSampler(const SceneTracers& tracers, const Scene& scene, const PixelRays& rays,
    const FrameRequest& request, BeamHistory* beams = nullptr, KeptHits* hits = nullptr);

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

  /// The first hits of a tile that are known, and that are found, by sample of the request.
  struct FirstHits
  {
    std::vector<const TileHits*> Known;
    std::vector<TileHits> Kept;
    bool AreKnown = false; ///< of all samples
  };
  FirstHits FindFirstHits(const Tile& tile) const;

  /// Adds the samples of pixels that share a beam; of one that fits into a batch.
  void TraceBeam(Tile& tile, const PixelBox& box, FirstHits& hits) const;
  void TraceBatch(Tile& tile, SceneBeam* beam, const PixelBox& box, FirstHits& hits) const;
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
  KeptHits* Hits;     ///< may be null
};

} // namespace rt

#endif
