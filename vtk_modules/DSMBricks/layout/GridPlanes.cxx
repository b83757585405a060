// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/GridPlanes.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"

#include <cmath>
#include <string>

namespace bricks
{

namespace
{

[[noreturn]] void Refuse(int axis, const std::string& problem)
{
  throw dsm::Error("Invalid rectilinear grid: its coordinates along " +
    std::string(1, "xyz"[axis]) + " " + problem + ". Fix the dataset's source or its file.");
}

void RefuseUnordered(const std::vector<double>& coordinates, int axis)
{
  if (coordinates.size() < 2)
  {
    Refuse(axis, "are fewer than two");
  }
  const bool rises = coordinates.back() > coordinates.front();
  for (std::size_t plane = 0; plane < coordinates.size(); ++plane)
  {
    if (!std::isfinite(coordinates[plane]))
    {
      Refuse(axis, "are not all finite");
    }
    if (plane > 0 &&
      (rises ? coordinates[plane] <= coordinates[plane - 1]
             : coordinates[plane] >= coordinates[plane - 1]))
    {
      Refuse(axis, "neither rise nor fall everywhere (at index " + std::to_string(plane) + ")");
    }
  }
}

} // namespace

GridPlanes::GridPlanes(const Coordinates& coordinates)
{
  ByteHash hash;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<double>& given = coordinates[axis];
    RefuseUnordered(given, axis);
    Axis& own = this->Axes[axis];
    const std::size_t cells = given.size() - 1;
    own.Cells = static_cast<double>(cells);
    own.Places.assign(given.size() + Padding, own.Cells);
    own.Inverse.assign(given.size() + Padding, 0.0);
    // Differences of halves do not overflow.
    const double extent = 0.5 * given.back() - 0.5 * given.front();
    for (std::size_t plane = 0; plane < cells; ++plane)
    {
      own.Places[plane] =
        std::min((0.5 * given[plane] - 0.5 * given.front()) / extent * own.Cells, own.Cells);
    }
    for (std::size_t cell = 0; cell < cells; ++cell)
    {
      const double inverse = 1.0 / (own.Places[cell + 1] - own.Places[cell]);
      own.Inverse[cell] = std::isfinite(inverse) ? inverse : 0.0;
    }
    own.Guess.resize(given.size());
    std::size_t cell = 0;
    for (std::size_t number = 0; number < own.Guess.size(); ++number)
    {
      while (cell + 1 < cells && own.Places[cell + 1] <= static_cast<double>(number))
      {
        ++cell;
      }
      own.Guess[number] = static_cast<std::int32_t>(cell);
    }
    hash.Add(own.Places.data(), own.Places.size() * sizeof(double));
  }
  this->Hash = hash.Get();
}

std::int64_t GridPlanes::FindCell(int axis, double place) const
{
  const Axis& own = this->Axes[axis];
  if (!(place > 0.0))
  {
    return 0;
  }
  if (place >= own.Cells)
  {
    return static_cast<std::int64_t>(own.Cells) - 1;
  }
  const auto number = static_cast<std::size_t>(place);
  const auto begin = own.Places.begin() + own.Guess[number];
  const auto end = own.Places.begin() + own.Guess[number + 1] + 1;
  // The first plane behind the place.
  const auto behind = std::upper_bound(begin + 1, end, place);
  return behind - own.Places.begin() - 1;
}

double GridPlanes::ToPlace(int axis, double index) const
{
  const Axis& own = this->Axes[axis];
  const double bounded = std::clamp(index, 0.0, own.Cells);
  const double cell = std::min(std::floor(bounded), own.Cells - 1.0);
  const auto at = static_cast<std::size_t>(cell);
  const double part = bounded - cell;
  return (1.0 - part) * own.Places[at] + part * own.Places[at + 1];
}

} // namespace bricks
