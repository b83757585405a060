// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SplitCell_h
#define bricks_SplitCell_h

#include <algorithm>
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

/// Splits a hexahedron into six tetrahedra, so that the diagonal of each face goes through the first of the face's
/// points: cells on both sides of a face split it alike (Dompierre et al. 1999, "How to subdivide pyramids, prisms and
/// hexahedra into tetrahedra"). `isBefore(one, other)`: whether a corner comes before another in an order of all
/// points, which need only be the same in both cells; corners at the same point are equal. Corners are in VTK's order.
/// Tetrahedra are flat where two of their corners are the same point.
template <class IsBefore>
inline void SplitHexahedronBy(const IsBefore& isBefore, std::uint8_t tetrahedra[MostTetrahedra][4])
{
  int first = 0;
  for (int corner = 1; corner < 8; ++corner)
  {
    first = isBefore(HexahedronCorner(corner), HexahedronCorner(first)) ? corner : first;
  }
  // Corners by bits, mirrored so that the first point of all is at 0. All faces around it have their diagonals
  // through it: tetrahedra from it to the triangles of the other three faces fill the cell.
  const auto at = [first](int corner)
  { return static_cast<std::uint8_t>(HexahedronCorner(corner ^ first)); };
  const auto set = [&](int number, int one, int two, int three)
  {
    std::uint8_t* const corners = tetrahedra[number];
    corners[0] = at(0);
    corners[1] = at(one);
    corners[2] = at(two);
    corners[3] = at(three);
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    const int near = 1 << axis;
    const int one = near | 1 << (axis + 1) % 3;
    const int two = near | 1 << (axis + 2) % 3;
    const int lowest = isBefore(at(one), at(two)) ? one : two;
    const int ofOther = isBefore(at(7), at(near)) ? 7 : near;
    const bool isDivided = isBefore(at(lowest), at(ofOther));
    set(2 * axis, isDivided ? one : near, isDivided ? two : 7, isDivided ? near : one);
    set(2 * axis + 1, isDivided ? one : near, isDivided ? two : 7, isDivided ? 7 : two);
  }
}

/// The same by numbers of the corners in such an order; equal ones are the same point. Writes the corners of a
/// tetrahedron in ascending order. Returns the number of tetrahedra: those of which two corners are the same are left
/// out.
template <class Number>
inline int SplitHexahedron(const Number places[8], std::uint8_t tetrahedra[MostTetrahedra][4])
{
  std::uint8_t all[MostTetrahedra][4];
  SplitHexahedronBy([&](int one, int other) { return places[one] < places[other]; }, all);
  int count = 0;
  for (auto& corners : all)
  {
    if (SortCorners(places, corners))
    {
      std::copy_n(corners, 4, tetrahedra[count++]);
    }
  }
  return count;
}

} // namespace bricks

#endif
