// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SplitCell_h
#define bricks_SplitCell_h

#include <cstdint>
#include <utility>

namespace bricks
{

/// Tetrahedra that a cell is split into, at most.
constexpr int MostTetrahedra = 6;

/// Corner number of VTK's hexahedron for a corner of bits: x in bit 0, y in bit 1, z in bit 2; and back.
constexpr int HexahedronCorner(int corner)
{
  return corner ^ (corner >> 1 & 1);
}

/// The four corners of a tetrahedron in ascending order of `places`. Returns false where two of them are the same.
template <class Number>
inline bool SortCorners(const Number* places, std::uint8_t corners[4])
{
  const auto order = [&](int first, int second)
  {
    if (places[corners[second]] < places[corners[first]])
    {
      std::swap(corners[first], corners[second]);
    }
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  return places[corners[0]] != places[corners[1]] && places[corners[1]] != places[corners[2]] &&
    places[corners[2]] != places[corners[3]];
}

/// Splits a hexahedron into tetrahedra, so that the diagonal of each face goes through the first of the face's points:
/// cells on both sides of a face split it alike (Dompierre et al. 1999, "How to subdivide pyramids, prisms and
/// hexahedra into tetrahedra"). `places` are the numbers of the corners in an order of all points, which need
/// only be the same in both cells; equal ones are the same point. Writes corners in VTK's order, those of a
/// tetrahedron in ascending order of their places. Returns the number of tetrahedra: those of which two corners are the
/// same are left out.
template <class Number>
inline int SplitHexahedron(const Number places[8], std::uint8_t tetrahedra[MostTetrahedra][4])
{
  int first = 0;
  for (int corner = 1; corner < 8; ++corner)
  {
    first = places[HexahedronCorner(corner)] < places[HexahedronCorner(first)] ? corner : first;
  }
  // Corners by bits, mirrored so that the first point of all is at 0. All faces around it have their diagonals
  // through it: tetrahedra from it to the triangles of the other three faces fill the cell.
  const auto at = [first](int corner)
  { return static_cast<std::uint8_t>(HexahedronCorner(corner ^ first)); };
  const auto isBefore = [&](int one, int other) { return places[at(one)] < places[at(other)]; };
  int count = 0;
  const auto add = [&](int one, int two, int three)
  {
    std::uint8_t* const corners = tetrahedra[count];
    corners[0] = at(0);
    corners[1] = at(one);
    corners[2] = at(two);
    corners[3] = at(three);
    count += SortCorners(places, corners) ? 1 : 0;
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    const int near = 1 << axis;
    const int one = near | 1 << (axis + 1) % 3;
    const int two = near | 1 << (axis + 2) % 3;
    const int lowest = isBefore(one, two) ? one : two;
    const int ofOther = isBefore(7, near) ? 7 : near;
    if (isBefore(lowest, ofOther))
    {
      add(one, two, near);
      add(one, two, 7);
    }
    else
    {
      add(near, 7, one);
      add(near, 7, two);
    }
  }
  return count;
}

} // namespace bricks

#endif
