// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldSampler_h
#define rt_FieldSampler_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMRayTracing/base/Lanes.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace rt
{

/// Reads a field through a store, at places in index space or in cells. Pure. One for each worker: it holds at
/// most one pin, and none while it acquires or when a call returns. May wait for bricks.
template <class Store>
class FieldSampler
{
public:
  FieldSampler(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// The trilinear value of a field of points; NaN where it holds no data, infinite between infinite ones of one sign.
  double Sample(const bricks::VoxelField& field, const glm::dvec3& indexPoint) const;

  /// The value of the sample that is nearest, in the cell that Sample takes; NaN where it holds no data.
  double SampleNearest(const bricks::VoxelField& field, const glm::dvec3& indexPoint) const;

  /// How fast the trilinear value grows on each axis, in a cell that holds data, at a place in it.
  glm::dvec3 GetGradient(const bricks::VoxelField& field, const bricks::Index3& cell,
    const glm::dvec3& indexPoint) const;

  /// The value of a cell of a field of cells (BrickLattice::IsOfCells); NaN where it holds no data.
  double GetOfCell(const bricks::VoxelField& field, const bricks::Index3& cell) const;

  /// The same for fields whose samples are colours (PackedColor), each channel by itself. Returns false
  /// where there are no data.
  bool SampleColor(
    const bricks::VoxelField& field, const glm::dvec3& indexPoint, glm::vec4& color) const;
  bool GetColorOfCell(
    const bricks::VoxelField& field, const bricks::Index3& cell, glm::vec4& color) const;

private:
  /// `function(corners, local)`: of the values at a cell's corners, and where in it the point is; NaN without data.
  template <class Function>
  double Evaluate(
    const bricks::VoxelField& field, const glm::dvec3& indexPoint, const Function& function) const;
  enum class Corners
  {
    Finite, ///< of a cell that holds data
    Any     ///< of any cell that is there
  };
  /// Samples at the corners of such a cell that the point is in, and where in the cell it is; false where there is none.
  template <class T>
  bool FindCorners(const bricks::VoxelField& field, const glm::dvec3& indexPoint, T corners[8],
    Lanes& local, Corners which = Corners::Finite) const;
  template <class T>
  bool GetCorners(const bricks::VoxelField& field, const bricks::Index3& cell, T corners[8],
    Corners which = Corners::Finite) const;
  template <class T>
  bool GetCell(const bricks::VoxelField& field, const bricks::Index3& cell, T& value) const;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/volume/FieldSampler.txx"

#endif
