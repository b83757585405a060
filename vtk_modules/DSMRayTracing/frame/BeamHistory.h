// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BeamHistory_h
#define rt_BeamHistory_h

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// How many bricks each beam of a view's last frames went through, from its front, as
/// far as this rank traced it: what the beams around it foretell of a beam, whatever bricks it crosses
/// now. A byte for each beam and object. No pixel depends on it, only what is fetched ahead.
///
/// Any thread, but for construction.
class BeamHistory
{
public:
  /// History for an image of so many pixels with so many objects. `last`: history of the view's
  /// last frame, or null; ignored unless its image had the same size and number of objects.
  BeamHistory(int width, int height, std::size_t objects, const BeamHistory* last = nullptr);

  /// How many bricks an object's beam at a pixel will probably need: as many as the beams there and around it went
  /// through, those of this frame where they are traced. None where nothing is known.
  std::size_t Predict(int x, int y, std::size_t object) const;

  /// Records the progress of an object's beam at a pixel (ObjectBeam::Reached).
  void Record(int x, int y, std::size_t object, std::size_t reached);

  /// Pixels along the edge of a square whose beams share a record.
  static constexpr int Edge = 16;

private:
  using Depth = std::uint8_t; ///< 0: not known; else one more than the number of bricks

  std::size_t GetPlace(int column, int row, std::size_t object) const;

  int Columns;
  int Rows;
  std::size_t Objects;
  std::vector<Depth> Last;
  std::vector<std::atomic<Depth>> Now;
};

} // namespace rt

#endif
