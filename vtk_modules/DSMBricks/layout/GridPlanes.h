// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_GridPlanes_h
#define bricks_GridPlanes_h

#include "DSMBricks/base/Box.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace bricks
{

/// Planes between the cells of a rectilinear grid. Their places are in *grid space*: the index space of the uniform
/// lattice with the same ends and as many cells, so plane 0 is at 0, and the last one at the number of cells. Cell i is
/// between planes i and i + 1. Immutable; any thread.
class GridPlanes
{
public:
  /// Coordinates of the planes on each axis.
  using Coordinates = std::array<std::vector<double>, 3>;

  /// Throws dsm::Error unless there are two or more coordinates on each axis, all finite, that rise or fall everywhere.
  explicit GridPlanes(const Coordinates& coordinates);

  std::int64_t GetCells(int axis) const
  {
    return static_cast<std::int64_t>(this->Axes[axis].Cells);
  }

  /// Planes behind the last one that may be asked for; they are at the place of the last.
  static constexpr int Padding = 64;
  /// Places of the planes, from 0 to the number of cells + Padding.
  const double* GetPlaces(int axis) const { return this->Axes[axis].Places.data(); }
  /// Reciprocals of the widths of the cells, likewise; behind the last one, and where a width is 0: 0.
  const double* GetInverseWidths(int axis) const { return this->Axes[axis].Inverse.data(); }
  /// Returns the place of a plane; of the nearest, if there is none.
  double GetPlace(int axis, double plane) const
  {
    const Axis& own = this->Axes[axis];
    return own.Places[static_cast<std::size_t>(std::clamp(plane, 0.0, own.Cells))];
  }

  /// Returns the cell that a place is in: the upper one, of two; the nearest, outside.
  std::int64_t FindCell(int axis, double place) const;
  /// Returns a place's index: the cell's number, and the part of it that lies before the place. Within the grid.
  double ToIndex(int axis, double place) const
  {
    return this->GetIndexIn(axis, this->FindCell(axis, place), place);
  }
  glm::dvec3 ToIndex(const glm::dvec3& place) const
  {
    return { this->ToIndex(0, place.x), this->ToIndex(1, place.y), this->ToIndex(2, place.z) };
  }
  /// The inverse.
  double ToPlace(int axis, double index) const;
  glm::dvec3 ToPlace(const glm::dvec3& index) const
  {
    return { this->ToPlace(0, index.x), this->ToPlace(1, index.y), this->ToPlace(2, index.z) };
  }

  /// Equal for equal planes.
  std::uint64_t GetHash() const { return this->Hash; }

private:
  struct Axis
  {
    double Cells = 0.0;
    std::vector<double> Places;
    std::vector<double> Inverse;
    std::vector<std::int32_t> Guess; ///< for each whole number: the cell that it is in
  };

  double GetIndexIn(int axis, std::int64_t cell, double place) const
  {
    const Axis& own = this->Axes[axis];
    const auto at = static_cast<std::size_t>(cell);
    const double part = (place - own.Places[at]) * own.Inverse[at];
    return static_cast<double>(cell) + std::clamp(part, 0.0, 1.0);
  }

  Axis Axes[3];
  std::uint64_t Hash = 0;
};

} // namespace bricks

#endif
