// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellSampler_h
#define rt_CellSampler_h

#include "DSMBricks/cells/CellBrick.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/TetrahedronShape.h"
#include "DSMRayTracing/field/walk/PlainSampler.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rt
{

/// Values and gradients at places in a CellField. Values are linear in tetrahedra; gradients are linear between those
/// at the points, or, where the bricks have none, that of the tetrahedron.
template <class Store>
class CellSampler : public PlainSampler<CellField, CellSampler<Store>>
{
public:
  CellSampler(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  RayMask FindPlaces(const bricks::CellValues& values, CellPlace* places, RayMask wanted) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        return places[index].Brick != CellPlace::NoBrick ||
          this->FindTetrahedron(values, places[index]);
      });
  }

  RayMask FindValues(const bricks::CellValues& values, const CellPlace* places, RayMask wanted,
    double* numbers) const
  {
    this->VisitPlaces(values, places, wanted,
      [&](int index, const TetrahedronShape& shape, const bricks::CellValueBrick& brick)
      {
        const CellPlace& place = places[index];
        double weights[4];
        shape.GetWeights(place.Point, weights);
        numbers[index] = 0.0;
        for (int corner = 0; corner < 4; ++corner)
        {
          numbers[index] += weights[corner] * brick.GetValues()[place.Corners[corner]];
        }
      });
    return wanted;
  }

  /// The value of the nearest point of the tetrahedron.
  RayMask FindNearestValues(const bricks::CellValues& values, const CellPlace* places,
    RayMask wanted, double* numbers) const
  {
    this->VisitPlaces(values, places, wanted,
      [&](int index, const TetrahedronShape& shape, const bricks::CellValueBrick& brick)
      {
        const CellPlace& place = places[index];
        numbers[index] = brick.GetValues()[place.Corners[shape.FindNearest(place.Point)]];
      });
    return wanted;
  }

  void FindGradients(const bricks::CellValues& values, const CellPlace* places, RayMask wanted,
    glm::dvec3* gradients) const
  {
    this->VisitPlaces(values, places, wanted,
      [&](int index, const TetrahedronShape& shape, const bricks::CellValueBrick& brick)
      {
        const CellPlace& place = places[index];
        glm::dvec3 smooth(0.0);
        if (const bricks::PackedGradient* const packed = brick.GetGradients())
        {
          double weights[4];
          shape.GetWeights(place.Point, weights);
          for (int corner = 0; corner < 4; ++corner)
          {
            glm::dvec3 gradient;
            packed[place.Corners[corner]].Unpack(&gradient.x);
            smooth += weights[corner] * gradient;
          }
        }
        gradients[index] =
          smooth != glm::dvec3(0.0) ? smooth : shape.GetGradient(brick.GetValues(), place.Corners);
      });
  }

private:
  /// Calls `visit(index, shape, valueBrick)`.
  template <class Visit>
  void VisitPlaces(const bricks::CellValues& values, const CellPlace* places, RayMask wanted,
    const Visit& visit) const
  {
    ForEachRay(wanted,
      [&](int index)
      {
        const CellPlace& place = places[index];
        const auto pins = this->Blocks.AcquirePair(
          this->Self, *values.Cells->Segment, place.Brick, *values.Segment, place.Brick);
        const bricks::CellBrick cells(pins.first.GetData());
        visit(index, TetrahedronShape(cells, place.Corners),
          bricks::CellValueBrick(pins.second.GetData()));
      });
  }

  /// Finds the tetrahedron that a place is in; of several, the one in which it is farthest from the faces.
  bool FindTetrahedron(const bricks::CellValues& values, CellPlace& place) const
  {
    double best = -Tolerance;
    CellPlace found = place;
    ForEachContaining(values.Hierarchy.GetNodes(), place.Point,
      [&](std::uint32_t leaf)
      { this->FindInBrick(values, bricks::RangedBrickBvh::GetBrick(leaf), place, best, found); });
    place = found;
    return place.Brick != CellPlace::NoBrick;
  }

  void FindInBrick(const bricks::CellValues& values, std::uint32_t number, const CellPlace& place,
    double& best, CellPlace& found) const
  {
    const auto pins =
      this->Blocks.AcquirePair(this->Self, *values.Cells->Segment, number, *values.Segment, number);
    const bricks::CellBrick brick(pins.first.GetData());
    const bricks::CellValueBrick numbers(pins.second.GetData());
    ForEachContaining(brick.GetNodes(), place.Point,
      [&](std::uint16_t leaf)
      {
        bricks::CellGroup cells;
        brick.ReadGroup(bricks::CellBrick::GetGroup(leaf), cells);
        for (int cell = 0; cell < cells.Cells; ++cell)
        {
          if (numbers.HasValues(cells, cell))
          {
            FindInCell(brick, cells, cell, number, place, best, found);
          }
        }
      });
  }

  static void FindInCell(const bricks::CellBrick& brick, const bricks::CellGroup& cells, int cell,
    std::uint32_t number, const CellPlace& place, double& best, CellPlace& found)
  {
    const std::uint8_t* const corners = cells.At[cell];
    const auto* const parts = cells.GetParts(cell);
    for (int part = 0; part < cells.CountParts(); ++part)
    {
      const std::uint8_t* const at = parts[part];
      const std::uint16_t points[4] = { cells.Numbers[corners[at[0]]],
        cells.Numbers[corners[at[1]]], cells.Numbers[corners[at[2]]],
        cells.Numbers[corners[at[3]]] };
      double weights[4];
      const bool isSolid = TetrahedronShape(brick, points).GetWeights(place.Point, weights);
      const double least = std::min({ weights[0], weights[1], weights[2], weights[3] });
      if (isSolid && least > best)
      {
        best = least;
        found.Brick = number;
        std::copy_n(points, 4, found.Corners);
      }
    }
  }

  /// How far a place may be beyond a face, as a part of the tetrahedron's height.
  static constexpr double Tolerance = 1e-9;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#endif
