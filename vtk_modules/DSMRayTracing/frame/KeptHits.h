// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_KeptHits_h
#define rt_KeptHits_h

#include "DSMRayTracing/frame/TileHits.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>
#include <vector>

namespace rt
{

/// The first hits of tiles that this rank traced: a picture of the same surfaces from the same place has them, too, in
/// whatever colors and light. The pictures that were shown last have them, as far as they fit.
class KeptHits
{
public:
  /// Samples of a pixel whose hits are kept. No square of pixels has fewer (FrameRequest::SureSamples), unless fewer
  /// are asked for.
  static constexpr int MostSamples = 4;
  /// Pictures whose hits are kept: those of a view's two eyes, and of another view.
  static constexpr std::size_t MostPictures = 4;

  /// Differs between frames whose hits differ.
  struct Key
  {
    std::uint64_t Picture; ///< digest of surfaces and camera
    std::uint64_t Shapes;  ///< digest of the surfaces (GetShapeDigest)
    std::uint64_t Data;    ///< BlockStore::CountPublications
  };

  /// Between frames. `key`: of the frame that begins. `most`: bytes that are kept. Returns whether hits of that frame
  /// are known, or `keeps` them. Steps of a simulation do not come again: when data have come since the last frame,
  /// hits of other surfaces leave, and those of a picture of new surfaces are not kept.
  bool Begin(const Key& key, int tiles, std::size_t most, bool keeps);

  ///@{
  /// During such a frame; any thread.

  /// How many of the first samples of a tile had known hits when the frame began.
  int CountKnown(int tile) const { return this->Shown->Known[static_cast<std::size_t>(tile)]; }
  /// Returns whether hits of that sample would be kept.
  bool HasRoom(int sample) const
  {
    return this->Keeps && sample < MostSamples && this->Shown->Bytes < this->Most;
  }
  ///@}

  ///@{
  /// During such a frame; for the one thread that traces the tile.

  /// The hits of a sample that was known. They stay until more are kept.
  const TileHits& Get(int tile, int sample) const
  {
    return this->Shown->Tiles[static_cast<std::size_t>(tile)][static_cast<std::size_t>(sample)];
  }
  /// Keeps those of the samples after the known ones, as far as there is room.
  void Keep(int tile, std::vector<TileHits> hits);
  ///@}

private:
  struct Picture
  {
    std::uint64_t Digest;
    std::uint64_t Shapes;
    std::vector<std::vector<TileHits>> Tiles; ///< by number, then sample
    std::vector<std::uint8_t> Known;          ///< CountKnown
    std::atomic<std::size_t> Bytes{ 0 };
  };

  bool MakeRoom(std::size_t bytes);
  void Drop(std::list<Picture>::iterator picture);

  Key Last{};                  ///< of the last frame
  std::list<Picture> Pictures; ///< the last one first
  Picture* Shown = nullptr;    ///< in the frame
  std::mutex Access;           ///< to pictures that are not
  std::atomic<std::size_t> Bytes{ 0 };
  std::size_t Most = 0;
  bool Keeps = false;
};

} // namespace rt

#endif
