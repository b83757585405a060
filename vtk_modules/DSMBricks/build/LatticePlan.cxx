// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/LatticePlan.h"

#include "DSMCore/base/Error.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace bricks
{

namespace
{

/// Two pieces share sampling points when their origins differ by whole cells, within this part of
/// one: files keep origins in single precision, too.
constexpr double AlignmentTolerance = 1e-3;
constexpr double SpacingTolerance = 1e-7;

glm::dmat4 GetIndexToWorld(const PieceInfo& piece)
{
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 3; ++row)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      matrix[axis][row] = piece.Direction[3 * row + axis] * piece.Spacing[axis];
    }
    matrix[3][row] = piece.Origin[row];
  }
  return matrix;
}

bool HasSameAxes(const PieceInfo& a, const PieceInfo& b)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (std::abs(a.Spacing[axis] - b.Spacing[axis]) > SpacingTolerance * std::abs(a.Spacing[axis]))
    {
      return false;
    }
  }
  return std::equal(a.Direction, a.Direction + 9, b.Direction,
    [](double x, double y) { return std::abs(x - y) <= SpacingTolerance; });
}

/// Returns whether the points of b are among those of a; `shift` maps b's indices to a's.
bool IsAligned(const PieceInfo& a, const PieceInfo& b, Index3& shift)
{
  if (!HasSameAxes(a, b))
  {
    return false;
  }
  const glm::dvec4 origin(b.Origin[0], b.Origin[1], b.Origin[2], 1.0);
  const glm::dvec4 index = glm::inverse(GetIndexToWorld(a)) * origin;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double rounded = std::round(index[axis]);
    if (!(std::abs(index[axis] - rounded) <= AlignmentTolerance) || std::abs(rounded) > 1e15)
    {
      return false;
    }
    shift[axis] = static_cast<std::int64_t>(rounded);
  }
  return true;
}

struct Placed
{
  int Piece;
  int Leaf;
  int Class; ///< piece whose indices Cells are in
  Index3 Shift;
  Box Cells;
};

struct Group
{
  std::vector<Placed> Members;
};

/// Returns whether two boxes of cells have a point in common.
bool Touches(const Box& a, const Box& b)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (std::max(a.Min[axis], b.Min[axis]) > std::min(a.Max[axis], b.Max[axis]))
    {
      return false;
    }
  }
  return true;
}

/// Blocks that overlap are different volumes; overlapping pieces of one block are copies.
bool Conflicts(const Placed& a, const Placed& b, const std::set<std::int32_t>& apart)
{
  return a.Leaf != b.Leaf &&
    (apart.count(a.Leaf) > 0 || apart.count(b.Leaf) > 0 || !Intersect(a.Cells, b.Cells).IsEmpty());
}

bool CanJoin(const Group& a, const Group& b, const std::set<std::int32_t>& apart)
{
  if (a.Members.front().Class != b.Members.front().Class)
  {
    return false;
  }
  bool touches = false;
  for (const Placed& x : a.Members)
  {
    for (const Placed& y : b.Members)
    {
      if (Conflicts(x, y, apart))
      {
        return false;
      }
      touches = touches || Touches(x.Cells, y.Cells);
    }
  }
  return touches;
}

/// Throws where numbers that say where the samples are make no sense.
void RefuseImpossiblePlace(const PieceInfo& piece)
{
  const auto refuse = [](const std::string& what, double value)
  {
    const char* const is = value == 0.0 ? "0" : std::isnan(value) ? "not a number" : "infinite";
    throw dsm::Error("Invalid image: its " + what + " is " + is +
      ". Fix the dataset's source or its file's header.");
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::string along = std::string(" along ") + "xyz"[axis];
    if (!std::isfinite(piece.Spacing[axis]) || piece.Spacing[axis] == 0.0)
    {
      refuse("spacing" + along, piece.Spacing[axis]);
    }
    if (!std::isfinite(piece.Origin[axis]))
    {
      refuse("origin" + along, piece.Origin[axis]);
    }
  }
  for (const double element : piece.Direction)
  {
    if (!std::isfinite(element))
    {
      refuse("direction matrix", element);
    }
  }
}

std::vector<Placed> Place(const std::vector<PieceInfo>& pieces)
{
  std::vector<Placed> placed;
  std::vector<int> classes;
  for (int index = 0; index < static_cast<int>(pieces.size()); ++index)
  {
    const PieceInfo& piece = pieces[index];
    Placed entry{ index, piece.Leaf, index, Index3(0),
      { { piece.Min[0], piece.Min[1], piece.Min[2] },
        { piece.Max[0], piece.Max[1], piece.Max[2] } } };
    if (entry.Cells.IsEmpty())
    {
      continue;
    }
    RefuseImpossiblePlace(piece);
    const auto known = std::find_if(classes.begin(), classes.end(),
      [&](int candidate) { return IsAligned(pieces[candidate], piece, entry.Shift); });
    if (known == classes.end())
    {
      classes.push_back(index);
      entry.Shift = Index3(0);
    }
    else
    {
      entry.Class = *known;
    }
    entry.Cells.Min += entry.Shift;
    entry.Cells.Max += entry.Shift;
    placed.push_back(entry);
  }
  return placed;
}

void RefuseFlatData(const std::vector<PieceInfo>& pieces)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (std::all_of(pieces.begin(), pieces.end(),
          [axis](const PieceInfo& piece) { return piece.Max[axis] <= piece.Min[axis]; }))
    {
      throw dsm::Error(std::string("The image has no cells along ") + "xyz"[axis] +
        ". An isosurface requires a volume with at least two points along each axis. Use Contour "
        "for two-dimensional images.");
    }
  }
}

} // namespace

LatticePlan::LatticePlan(const std::vector<PieceInfo>& pieces, const std::set<std::int32_t>& apart)
{
  std::vector<Group> groups;
  for (const Placed& entry : Place(pieces))
  {
    Group joined{ { entry } };
    for (auto group = groups.begin(); group != groups.end();)
    {
      if (CanJoin(*group, joined, apart))
      {
        joined.Members.insert(joined.Members.begin(), group->Members.begin(), group->Members.end());
        group = groups.erase(group);
      }
      else
      {
        ++group;
      }
    }
    groups.push_back(std::move(joined));
  }
  if (groups.empty() && !pieces.empty())
  {
    RefuseFlatData(pieces);
  }

  for (const Group& group : groups)
  {
    Box box = group.Members.front().Cells;
    for (const Placed& member : group.Members)
    {
      box.Min = glm::min(box.Min, member.Cells.Min);
      box.Max = glm::max(box.Max, member.Cells.Max);
    }
    Lattice lattice;
    lattice.Points = box.GetSize() + Index3(1);
    lattice.IndexToWorld = GetIndexToWorld(pieces[group.Members.front().Class]);
    lattice.IndexToWorld[3] = lattice.IndexToWorld * glm::dvec4(glm::dvec3(box.Min), 1.0);
    for (const Placed& member : group.Members)
    {
      lattice.Members.push_back({ member.Piece, member.Shift - box.Min,
        { member.Cells.Min - box.Min, member.Cells.Max - box.Min } });
    }
    this->Lattices.push_back(std::move(lattice));
  }
}

std::vector<LatticePlan::Seam> LatticePlan::FindSeams(const std::vector<PieceInfo>& pieces) const
{
  std::vector<Seam> seams;
  for (std::size_t lattice = 0; lattice < this->Lattices.size(); ++lattice)
  {
    const std::vector<Member>& members = this->Lattices[lattice].Members;
    for (std::size_t second = 1; second < members.size(); ++second)
    {
      for (std::size_t first = 0; first < second; ++first)
      {
        const auto getPoints = [&](std::size_t member) {
          return Box{ members[member].Cells.Min, members[member].Cells.Max + Index3(1) };
        };
        if (pieces[members[first].Piece].Leaf == pieces[members[second].Piece].Leaf)
        {
          continue;
        }
        const Box common = Intersect(getPoints(first), getPoints(second));
        if (!common.IsEmpty())
        {
          seams.push_back({ lattice, { first, second }, common });
        }
      }
    }
  }
  return seams;
}

bool LatticePlan::IsCovered(const Box& box, const std::vector<Box>& parts)
{
  if (box.IsEmpty())
  {
    return true;
  }
  for (const Box& part : parts)
  {
    const Box common = Intersect(box, part);
    if (common.IsEmpty())
    {
      continue;
    }
    // Divide the rest of the box: two slabs for each axis, each axis narrowing the rest.
    Box rest = box;
    for (int axis = 0; axis < 3; ++axis)
    {
      Box below = rest;
      Box above = rest;
      below.Max[axis] = common.Min[axis];
      above.Min[axis] = common.Max[axis];
      if (!IsCovered(below, parts) || !IsCovered(above, parts))
      {
        return false;
      }
      rest.Min[axis] = common.Min[axis];
      rest.Max[axis] = common.Max[axis];
    }
    return true;
  }
  return false;
}

} // namespace bricks
