// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/LatticePlan.h"

#include "DSMCore/base/Error.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace bricks
{

namespace
{

/// Two pieces share sampling points when these differ by whole cells, within this part of one:
/// files keep origins and coordinates in single precision, too.
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

/// The shorter of the distances from a plane to those beside it.
double GetStep(const std::vector<double>& planes, std::size_t plane)
{
  const auto step = [&](std::size_t lower) { return std::abs(planes[lower + 1] - planes[lower]); };
  return plane == 0              ? step(plane)
    : plane + 1 == planes.size() ? step(plane - 1)
                                 : std::min(step(plane - 1), step(plane));
}

/// Returns whether the planes of a from `first` on are those of b, as far as both go.
bool IsContinued(const std::vector<double>& a, std::size_t first, const std::vector<double>& b)
{
  const std::size_t count = std::min(a.size() - first, b.size());
  for (std::size_t plane = 0; plane < count; ++plane)
  {
    const double step = std::min(GetStep(a, first + plane), GetStep(b, plane));
    if (!(std::abs(a[first + plane] - b[plane]) <= AlignmentTolerance * step))
    {
      return false;
    }
  }
  return count > 0;
}

/// Returns whether any planes of two lists that rise or fall can be the same: most blocks are apart.
bool CanMeet(const std::vector<double>& a, const std::vector<double>& b)
{
  const auto [leastOfA, mostOfA] = std::minmax(a.front(), a.back());
  const auto [leastOfB, mostOfB] = std::minmax(b.front(), b.back());
  const double slack = AlignmentTolerance * (mostOfA - leastOfA + mostOfB - leastOfB);
  return leastOfA <= mostOfB + slack && leastOfB <= mostOfA + slack;
}

/// Finds the number of planes of a that lie before the first plane of b, by coordinates on one
/// axis. Returns false unless they have planes in common, and the same planes wherever both have
/// some.
bool FindShift(const std::vector<double>& a, const std::vector<double>& b, std::int64_t& shift)
{
  const auto count = static_cast<std::int64_t>(a.size());
  for (shift = 1 - static_cast<std::int64_t>(b.size()); shift < count; ++shift)
  {
    const auto first = static_cast<std::size_t>(std::abs(shift));
    if (shift < 0 ? IsContinued(b, first, a) : IsContinued(a, first, b))
    {
      return true;
    }
  }
  return false;
}

/// Where rectilinear pieces are that continue one another.
class RectilinearPlaces
{
public:
  struct Place
  {
    int Class = -1; ///< the piece in whose indices it is
    Index3 Shift{ 0 };
  };

  RectilinearPlaces(
    const std::vector<PieceInfo>& pieces, const std::vector<GridPlanes::Coordinates>& coordinates)
    : Pieces(pieces)
    , Coordinates(coordinates)
    , Places(pieces.size())
  {
    for (std::size_t piece = 0; piece < pieces.size(); ++piece)
    {
      if (this->IsRectilinear(piece))
      {
        GridPlanes check(coordinates[piece]);
      }
    }
    for (std::size_t piece = 0; piece < pieces.size(); ++piece)
    {
      if (this->IsRectilinear(piece) && this->Places[piece].Class < 0)
      {
        this->Collect(static_cast<int>(piece));
      }
    }
  }

  const Place& Get(int piece) const { return this->Places[static_cast<std::size_t>(piece)]; }

private:
  /// Coordinates of the planes by their indices.
  using Known = std::array<std::map<std::int64_t, double>, 3>;

  bool IsRectilinear(std::size_t piece) const
  {
    const PieceInfo& info = this->Pieces[piece];
    return info.Coordinates != 0 && info.Min[0] < info.Max[0] && info.Min[1] < info.Max[1] &&
      info.Min[2] < info.Max[2];
  }

  /// Adds a piece's planes to those that are known; returns false if they do not fit.
  bool Enter(int piece, const Index3& shift, Known& known) const
  {
    const GridPlanes::Coordinates& own = this->Coordinates[static_cast<std::size_t>(piece)];
    Known all = known;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t first =
        this->Pieces[static_cast<std::size_t>(piece)].Min[axis] + shift[axis];
      for (std::size_t plane = 0; plane < own[axis].size(); ++plane)
      {
        const auto entry =
          all[axis].emplace(first + static_cast<std::int64_t>(plane), own[axis][plane]).first;
        const double step = GetStep(own[axis], plane);
        if (!(std::abs(entry->second - own[axis][plane]) <= AlignmentTolerance * step))
        {
          return false;
        }
      }
      const auto steps = [&](auto isStep)
      {
        return std::adjacent_find(all[axis].begin(), all[axis].end(),
                 [&](const auto& x, const auto& y)
                 { return !isStep(x.second, y.second); }) == all[axis].end();
      };
      if (!steps(std::less<double>()) && !steps(std::greater<double>()))
      {
        return false;
      }
    }
    known = std::move(all);
    return true;
  }

  /// Finds all pieces that continue the first one, or one another from there on.
  void Collect(int first)
  {
    Known known;
    std::vector<int> found;
    const auto add = [&](int piece, const Index3& shift)
    {
      if (this->Enter(piece, shift, known))
      {
        this->Places[static_cast<std::size_t>(piece)] = { first, shift };
        found.push_back(piece);
      }
    };
    add(first, Index3(0));
    for (std::size_t next = 0; next < found.size(); ++next)
    {
      const int from = found[next];
      for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
      {
        Index3 shift;
        if (this->IsRectilinear(piece) && this->Places[piece].Class < 0 &&
          this->FindShifts(from, static_cast<int>(piece), shift))
        {
          add(static_cast<int>(piece), shift + this->Get(from).Shift);
        }
      }
    }
  }

  /// `shift` maps the indices of piece b to those of a, if one continues the other.
  bool FindShifts(int a, int b, Index3& shift) const
  {
    const GridPlanes::Coordinates& one = this->Coordinates[static_cast<std::size_t>(a)];
    const GridPlanes::Coordinates& other = this->Coordinates[static_cast<std::size_t>(b)];
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!CanMeet(one[axis], other[axis]))
      {
        return false;
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!FindShift(one[axis], other[axis], shift[axis]))
      {
        return false;
      }
      shift[axis] += this->Pieces[static_cast<std::size_t>(a)].Min[axis] -
        this->Pieces[static_cast<std::size_t>(b)].Min[axis];
    }
    return true;
  }

  const std::vector<PieceInfo>& Pieces;
  const std::vector<GridPlanes::Coordinates>& Coordinates;
  std::vector<Place> Places;
};

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

/// The planes of a group of rectilinear pieces, whose cells are `box`, and the matrix from their grid space.
std::shared_ptr<const GridPlanes> JoinPlanes(const Group& group, const Box& box,
  const std::vector<GridPlanes::Coordinates>& coordinates, glm::dmat4& toWorld)
{
  GridPlanes::Coordinates all;
  toWorld = glm::dmat4(1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    all[axis].resize(static_cast<std::size_t>(box.GetSize()[axis] + 1));
    for (auto member = group.Members.rbegin(); member != group.Members.rend(); ++member)
    {
      const std::vector<double>& own = coordinates[static_cast<std::size_t>(member->Piece)][axis];
      std::copy(
        own.begin(), own.end(), all[axis].begin() + (member->Cells.Min[axis] - box.Min[axis]));
    }
    toWorld[axis][axis] =
      (all[axis].back() - all[axis].front()) / static_cast<double>(box.GetSize()[axis]);
    toWorld[3][axis] = all[axis].front();
  }
  return std::make_shared<GridPlanes>(all);
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

std::vector<Placed> Place(
  const std::vector<PieceInfo>& pieces, const std::vector<GridPlanes::Coordinates>& coordinates)
{
  const RectilinearPlaces rectilinear(pieces, coordinates);
  std::vector<Placed> placed;
  std::vector<int> classes;
  std::vector<int> order(pieces.size());
  std::iota(order.begin(), order.end(), 0);
  // Whatever the ranks: the first block says where points are that others have a little beside
  // them.
  std::stable_sort(
    order.begin(), order.end(), [&](int a, int b) { return pieces[a].Leaf < pieces[b].Leaf; });
  for (const int index : order)
  {
    const PieceInfo& piece = pieces[index];
    Placed entry{ index, piece.Leaf, index, Index3(0),
      { { piece.Min[0], piece.Min[1], piece.Min[2] },
        { piece.Max[0], piece.Max[1], piece.Max[2] } } };
    if (entry.Cells.IsEmpty())
    {
      continue;
    }
    if (piece.Coordinates != 0)
    {
      entry.Class = rectilinear.Get(index).Class;
      entry.Shift = rectilinear.Get(index).Shift;
    }
    else
    {
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
        ". Isosurfaces, volumes and slices require at least two points along each axis. Show a "
        "two-dimensional image as Surface, or use Contour.");
    }
  }
}

} // namespace

LatticePlan::LatticePlan(const std::vector<PieceInfo>& pieces, const std::set<std::int32_t>& apart,
  const std::vector<GridPlanes::Coordinates>& coordinates)
{
  std::vector<Group> groups;
  for (const Placed& entry : Place(pieces, coordinates))
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
    const PieceInfo& first = pieces[group.Members.front().Class];
    if (first.Coordinates != 0)
    {
      lattice.Planes = JoinPlanes(group, box, coordinates, lattice.IndexToWorld);
    }
    else
    {
      lattice.IndexToWorld = GetIndexToWorld(first);
      lattice.IndexToWorld[3] = lattice.IndexToWorld * glm::dvec4(glm::dvec3(box.Min), 1.0);
    }
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
