// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SplitCell_h
#define bricks_SplitCell_h

#include <algorithm>
#include <array>
#include <cstddef>
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

/// A way to split a hexahedron into tetrahedra, in six bits. The lower three are the corner (by bits,
/// HexahedronCorner) that all tetrahedra have. Each axis has a bit above them for the face that is away from that
/// corner: 1 where the diagonal of the face does not go through the farthest corner.
using SplitCode = std::uint8_t;
constexpr int SplitCodes = 64;

/// Returns how a hexahedron is split, so that the diagonal of each face goes through the first of the face's points:
/// cells on both sides of a face split it alike (Dompierre et al. 1999, "How to subdivide pyramids, prisms and
/// hexahedra into tetrahedra"). `isBefore(one, other)`: whether a corner comes before another in an order of all
/// points, which need only be the same in both cells; corners at the same point are equal. Corners are in VTK's order.
template <class IsBefore>
inline SplitCode FindSplit(const IsBefore& isBefore)
{
  int first = 0;
  for (int corner = 1; corner < 8; ++corner)
  {
    first = isBefore(HexahedronCorner(corner), HexahedronCorner(first)) ? corner : first;
  }
  const auto at = [first](int corner) { return HexahedronCorner(corner ^ first); };
  int code = first;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int near = 1 << axis;
    const int one = near | 1 << (axis + 1) % 3;
    const int two = near | 1 << (axis + 2) % 3;
    const int lowest = isBefore(at(one), at(two)) ? one : two;
    const int ofOther = isBefore(at(7), at(near)) ? 7 : near;
    code |= static_cast<int>(isBefore(at(lowest), at(ofOther))) << (3 + axis);
  }
  return static_cast<SplitCode>(code);
}

/// Corners of the tetrahedra of a split.
struct SplitTetrahedra
{
  std::uint8_t Corners[MostTetrahedra][4];
};

constexpr SplitTetrahedra MakeSplit(int code)
{
  // Corners by bits, mirrored so that the first point of all is at 0. All faces around it have their diagonals
  // through it: tetrahedra from it to the triangles of the other three faces fill the cell.
  SplitTetrahedra split{};
  for (int axis = 0; axis < 3; ++axis)
  {
    const int near = 1 << axis;
    const int one = near | 1 << (axis + 1) % 3;
    const int two = near | 1 << (axis + 2) % 3;
    const bool isDivided = (code >> (3 + axis) & 1) != 0;
    const int corners[2][4] = { { 0, isDivided ? one : near, isDivided ? two : 7,
                                  isDivided ? near : one },
      { 0, isDivided ? one : near, isDivided ? two : 7, isDivided ? 7 : two } };
    for (int part = 0; part < 2; ++part)
    {
      for (int corner = 0; corner < 4; ++corner)
      {
        split.Corners[2 * axis + part][corner] =
          static_cast<std::uint8_t>(HexahedronCorner(corners[part][corner] ^ (code & 7)));
      }
    }
  }
  return split;
}

constexpr std::array<SplitTetrahedra, SplitCodes> MakeSplits()
{
  std::array<SplitTetrahedra, SplitCodes> splits{};
  for (int code = 0; code < SplitCodes; ++code)
  {
    splits[static_cast<std::size_t>(code)] = MakeSplit(code);
  }
  return splits;
}

/// By their codes. Tetrahedra are flat where two of their corners are the same point.
inline constexpr std::array<SplitTetrahedra, SplitCodes> Splits = MakeSplits();

/// Splits a hexahedron by numbers of its corners in an order of all points; equal ones are the same point. Writes the
/// corners of a tetrahedron in ascending order. Returns the number of tetrahedra: those of which two corners are the
/// same are left out.
template <class Number>
inline int SplitHexahedron(const Number places[8], std::uint8_t tetrahedra[MostTetrahedra][4])
{
  const SplitTetrahedra& split =
    Splits[FindSplit([&](int one, int other) { return places[one] < places[other]; })];
  int count = 0;
  for (const auto& corners : split.Corners)
  {
    std::copy_n(corners, 4, tetrahedra[count]);
    count += static_cast<int>(SortCorners(places, tetrahedra[count]));
  }
  return count;
}

} // namespace bricks

#endif
