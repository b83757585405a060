// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_CellCrossing_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_CellCrossing_inl_h
#undef rt_CellCrossing_inl_h
#else
#define rt_CellCrossing_inl_h
#endif

#include "DSMRayTracing/field/cells/Cubics-inl.h"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Rays of a vector in the cells that they cross, each in a cell of its own. This is all that the visitors of this
/// folder (FirstCrossings, CrossingCounts, ExtremumCells, MediumCells) know of cells: so any kind of cell, in which
/// values along a ray are a polynomial of at most the third degree, can use them. A kind derives from this, and adds:
///
/// - `Cubics<D> GetCubics() const`: values from Enter (at 0) to Exit (at 1), less what the kernel subtracts: the
///   isovalue of surfaces, TransferFunction::GetOrigin of media, nothing for extrema.
/// - `Cubics<D> GetCubics(Vector sign) const`: the same of values times 1 or -1. For ExtremumCells.
/// - `void FindRange(Vector& least, Vector& most) const`: a range of values that the cell's values never leave. For
///   ExtremumCells and MediumCells.
/// - `static constexpr int PlaceNumbers`, and `void PutPlace(put) const`, which calls `put(number, vector)` for so many
///   numbers: what is needed to tell the place of a hit once its position between Enter and Exit is known. For
///   FirstCrossings.
/// - `std::uint32_t FindHidden(const Cubics<D>& cubics, std::uint32_t rays) const`: those of `rays` (bits), none of
///   which crosses the surface in its cell, that cross it where they leave their cells, since values of the next cell
///   do not agree with those of this one. For FirstCrossings and CrossingCounts.
///
/// A visitor has `std::uint32_t Visit(const Crossing&)`, which returns the lanes (bits) whose ray's search ends.
template <class D>
struct CellCrossing
{
  using Vector = hn::Vec<D>;

  const std::size_t* Ray; ///< number of each lane's ray
  std::uint32_t There;    ///< lanes (bits) that have a ray; the others mean nothing
  /// Rays that go through their cell, and do not only touch it, where the cell holds data.
  hn::Mask<D> Crossing;
  Vector Enter; ///< T at which the ray enters the cell
  Vector Exit;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
