// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MacrocellKernel_h
#define rt_MacrocellKernel_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/lattice/MacrocellSamples.h"

#include <cstddef>
#include <cstdint>
#include <tuple>

namespace rt
{

/// Comparisons of a brick's samples of type T with an isovalue, many at once. `first` is the smallest
/// sample that is inside. Pure; any thread.
template <class T>
struct MacrocellComparison
{
  /// Cells and macrocells along an axis of what is compared.
  static constexpr int Edge = 4;
  /// Samples that FindCells reads at once: rows of fewer are not for it.
  static constexpr int RowSamples = 8;

  /// Bit x + 4 y + 16 z is set where a cell of a macrocell has corners on both sides. The
  /// macrocell's 5 x 5 x 5 samples begin at `x` in a row that begins at `samples`; rows follow one
  /// another in steps of `row`, its length, and slices in steps of `slice`.
  std::uint64_t (*FindCells)(
    const T* samples, int x, std::ptrdiff_t row, std::ptrdiff_t slice, T first);

  /// Bit x + 4 y + 16 z is set where a macrocell of 4 x 4 x 4 has samples on both sides; `row` and
  /// `slice` lead to the next one on y and z.
  std::uint64_t (*FindMacrocells)(
    const bricks::MacrocellRange<T>* ranges, std::ptrdiff_t row, std::ptrdiff_t slice, T first);
};

/// Functions for macrocells, which TypedPacketBrick calls; a part of PacketKernel. Pure; any thread.
struct MacrocellKernel
{
  /// Returns the largest bend of the values along a line, for finite samples; see Roughness.
  double (*FindRoughness)(const MacrocellSamples& samples);

  std::tuple<MacrocellComparison<std::int8_t>, MacrocellComparison<std::uint8_t>,
    MacrocellComparison<std::int16_t>, MacrocellComparison<std::uint16_t>,
    MacrocellComparison<std::int32_t>, MacrocellComparison<std::uint32_t>,
    MacrocellComparison<std::int64_t>, MacrocellComparison<std::uint64_t>,
    MacrocellComparison<float>, MacrocellComparison<double>>
    Comparisons;

  template <class T>
  const MacrocellComparison<T>& Get() const
  {
    return std::get<MacrocellComparison<T>>(this->Comparisons);
  }
};

} // namespace rt

#endif
