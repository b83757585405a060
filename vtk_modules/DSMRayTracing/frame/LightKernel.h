// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LightKernel_h
#define rt_LightKernel_h

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace rt
{

/// Rows of a picture, number by number, for LightKernel. Beside each row is room for what a filter reads beyond it.
class LightPlanes
{
public:
  /// The part of its unoccluded light that arrives at a pixel: red, green, blue; twice, read and written in turn.
  enum Plane
  {
    Red,
    Green,
    Blue,
    OtherRed,
    OtherGreen,
    OtherBlue,
    NormalX, ///< unit, world space
    NormalY,
    NormalZ,
    PlaceX, ///< world space, from an origin that the pixels share
    PlaceY,
    PlaceZ,
    Fineness, ///< inverse of the length of a pixel there, in world space
    Weight,   ///< 1 where there is light to filter, else 0
    Variance, ///< of the light, estimated from the samples
    Contrast, ///< inverse of the difference at which light counts as another's
    OpenRed,  ///< unoccluded light
    OpenGreen,
    OpenBlue,
    Count
  };

  /// Pixels that a filter reads beside another, and the lanes of a vector behind a row.
  static constexpr int Room = 48;

  /// Begins rows of a picture from `firstRow` on. All weights are 0, all other numbers finite.
  void Reset(int width, int firstRow, int rows)
  {
    this->Width = width;
    this->FirstRow = firstRow;
    this->Rows = rows;
    this->Stride = static_cast<std::size_t>(width) + 2 * Room;
    const std::size_t count = this->Stride * static_cast<std::size_t>(rows);
    // Memory is kept: new pages take longer than the filter.
    for (auto& plane : this->Planes)
    {
      plane.resize(std::max(plane.size(), count));
    }
    std::fill_n(this->Planes[Weight].begin(), count, 0.0f);
  }

  int GetWidth() const { return this->Width; }
  int GetFirstRow() const { return this->FirstRow; }
  int GetEndRow() const { return this->FirstRow + this->Rows; }
  /// The first pixel of a row of the picture.
  float* GetRow(int plane, int row)
  {
    return this->Planes[static_cast<std::size_t>(plane)].data() +
      this->Stride * static_cast<std::size_t>(row - this->FirstRow) + Room;
  }
  const float* GetRow(int plane, int row) const
  {
    return const_cast<LightPlanes*>(this)->GetRow(plane, row);
  }

private:
  int Width = 0;
  int FirstRow = 0;
  int Rows = 0;
  std::size_t Stride = 0;
  std::array<std::vector<float>, Count> Planes;
};

/// The steps of LightFilter for a row of pixels, with the vectors of the processor. All kernels find the same bits.
/// Pure, but for the planes that they write; any thread.
struct LightKernel
{
  const char* Name;
  int Width; ///< pixels at once

  /// Writes Contrast: from the light of pixels around that lie on the same surface. `usesVariance`: from their
  /// Variance.
  void (*FindContrast)(LightPlanes& planes, int row, bool usesVariance);

  /// One pass of the filter: pixels `step` apart. `contrast`: factor of Contrast; 0: any light counts. `from`: Red or
  /// OtherRed; the other one is written.
  void (*Smooth)(LightPlanes& planes, int row, int step, float contrast, LightPlanes::Plane from);

  /// The fastest that this processor can run.
  static const LightKernel& GetBest();
  /// All that this processor can run, that of width 1 first. For tests: not while any thread traces.
  static std::vector<LightKernel> GetAll();
};

} // namespace rt

#endif
