// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMNestedSource_h
#define vtkDSMNestedSource_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/build/VoxelSource.h"

#include <array>
#include <memory>
#include <vector>

/// The samples in a box of one of several lattices that lie within one another: every point of a coarser one is a point
/// of a finer one. The samples of a file's level lie elsewhere (those of a mean lie between those that it is of), so
/// the values at the points are interpolated between them.
///
/// Values continue those of the coarser lattice around the box: on a face of the box that is not one of the dataset,
/// they are those that the coarser cells have there.
///
/// Any thread.
class vtkDSMNestedSource final : public bricks::VoxelSource
{
public:
  /// Where the lattice is among a file's samples.
  struct Level
  {
    std::shared_ptr<const bricks::VoxelSource> Samples; ///< of the level, counted from (0, 0, 0)
    bricks::ScalarType Type;                            ///< of these
    bricks::Index3 Count;                               ///< of these, along each axis
    /// Index of a sample at point (0, 0, 0), and how many samples the next point is away, along each axis.
    glm::dvec3 First;
    glm::dvec3 Step;
    bricks::Index3 Cells; ///< of the lattice, along each axis
  };

  /// `box`: cells of the lattice. `type`: Float32 or Float64, of the values. `coarser`: of the next coarser lattice, in
  /// a box that this one is in; null: there is none. `ratio`: cells of this lattice in one of that, along each axis.
  vtkDSMNestedSource(const Level& level, const bricks::Box& box, bricks::ScalarType type,
    std::shared_ptr<const vtkDSMNestedSource> coarser, const bricks::Index3& ratio);

  bricks::Box GetCells() const override { return { bricks::Index3(0), this->Box.GetSize() }; }
  void ReadSamples(const bricks::Box& points, std::byte* out) const override;

  /// Returns the samples of the file that the values at points need, but for those at faces. `points`: counted from
  /// the first point of the box.
  bricks::Box GetSamples(const bricks::Box& points) const;

private:
  using Values = std::vector<double>;

  /// The values at points of the lattice.
  Values Find(const bricks::Box& points) const;
  Values FindWithin(const bricks::Box& points) const;
  /// The values of this lattice at points of a finer one.
  Values Interpolate(const bricks::Box& points, const bricks::Index3& ratio) const;
  bricks::Box GetSamplesAt(const bricks::Box& points) const;
  double GetSample(int axis, std::int64_t point) const;

  Level Of;
  bricks::Box Box;
  bricks::ScalarType Type;
  std::shared_ptr<const vtkDSMNestedSource> Coarser;
  bricks::Index3 Ratio;
};

#endif
