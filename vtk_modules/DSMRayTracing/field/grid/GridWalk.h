// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GridWalk_h
#define rt_GridWalk_h

#include "DSMRayTracing/field/grid/GridRay.h"

#include <cstdint>

namespace rt
{

/// How the index of a node changes from one to the next on each axis; the same numbers twice.
struct NodeStrides
{
  Lanes Real;
  IntegerLanes Whole;

  NodeStrides(std::int64_t row, std::int64_t slice)
    : Real(1.0, static_cast<double>(row), static_cast<double>(slice), 0.0)
    , Whole{ { 1, row }, { slice, 0 } }
  {
  }
};

/// A box of nodes: cells, macrocells, bricks or what is above. In the idle lane there is one node.
struct NodeGrid
{
  Lanes First; ///< the lower planes of the box, in cells
  double Edge; ///< edge length of a node, in cells
  double InverseEdge;
  Lanes Counts; ///< nodes per axis
  const NodeStrides& Strides;
};

/// Walks the nodes of a box in the order in which a ray (GridRay or StretchedRay) meets them. Where the ray passes
/// through an edge or a corner it steps over all planes at once, so that no node is visited for a single point.
class GridWalk
{
public:
  GridWalk() = default;

  /// Starts at t on a ray that is in the box then; planes that are met at t or before count as crossed.
  /// Returns the index of the node relative to the box's first node.
  template <class Line>
  std::int64_t Start(const Line& ray, double t, const NodeGrid& grid)
  {
    // Mostly the ray stands on a plane that it has just crossed; a little ahead, rounding does not
    // put the place on either side by chance.
    const Lanes ahead = ray.Step * Lanes(1e-9);
    const Lanes point = ray.GetIndex(ray.GetPoint(t) + ahead);
    const Lanes place = (point - grid.First) * Lanes(grid.InverseEdge);
    const Lanes last = grid.Counts - Lanes(1.0);
    Lanes nodes = Round(Clamp(place - Lanes(0.5), Lanes(0.0), last));
    const Lanes edge(grid.Edge);
    this->Plane = grid.First + (nodes + ray.Forward) * edge;
    this->PlaneT = ray.GetPlaneT(this->Plane);
    this->PlaneStrides = ray.Step * edge;
    this->IndexStrides = NegateWhere(grid.Strides.Whole, ray.Backward);
    const Lanes behindT = ray.GetPlaneT(this->Plane - this->PlaneStrides);
    const IntegerLanes wrong = (this->PlaneT <= Lanes(t)) | ((behindT > Lanes(t)) & ray.Moving);
    if (wrong.IsAny())
    {
      this->Correct(ray, t, grid, nodes);
    }
    return static_cast<std::int64_t>((nodes * grid.Strides.Real).GetSum());
  }

  /// Returns the T at which the ray leaves the current node.
  double GetExit() const { return this->PlaneT.GetMin(); }

  /// Goes on to the node after `exit`; returns the change of the index.
  template <class Line>
  std::int64_t Advance(const Line& ray, double exit)
  {
    const IntegerLanes crossed = this->PlaneT <= Lanes(exit);
    this->Plane = this->Plane + (this->PlaneStrides & crossed);
    this->PlaneT = ray.GetPlaneT(this->Plane);
    return (this->IndexStrides & crossed).GetSum();
  }

  /// The lower planes of the current node.
  Lanes GetFirst(const GridRay& ray, double edge) const
  {
    return this->Plane - ray.Forward * Lanes(edge);
  }

private:
  /// Moves the start to the node that GetPlaneT defines; the rounding of the ray's point may define
  /// another one.
  template <class Line>
  void Correct(const Line& ray, double t, const NodeGrid& grid, Lanes& nodes);

  Lanes Plane;  ///< coordinate of the plane through which the ray leaves on each axis
  Lanes PlaneT; ///< T at which it meets that plane
  Lanes PlaneStrides;
  IntegerLanes IndexStrides;
};

} // namespace rt

#endif
