// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BrickBends_h
#define bricks_BrickBends_h

#include "DSMBricks/layout/VoxelBrick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace bricks
{

// How far the values along any line through a node of a brick (a macrocell or a part) may be from a quadratic through
// three of them: at both ends and in the middle. A byte each, logarithmic, in units of the brick's range.

/// A node has this if values are not finite, or if the mask leaves cells out.
constexpr std::uint8_t NoBend = 255;
/// The byte of a bend as large as the brick's range, and steps in an octave.
constexpr int UnitBend = 240;
constexpr int BendSteps = 8;

/// The smallest byte that is not less than a bend of so many ranges of the brick.
inline std::uint8_t EncodeBend(double bend)
{
  if (!(bend < std::numeric_limits<double>::infinity()))
  {
    return NoBend;
  }
  const double steps = UnitBend + BendSteps * std::log2(std::max(bend, 1e-30));
  return static_cast<std::uint8_t>(std::clamp(std::ceil(steps), 0.0, NoBend - 1.0));
}

/// In units of values, for the node with that number; infinite: not known. `isPart`: of a part, not of a macrocell.
inline double GetBend(const VoxelBrickHeader& header, bool isPart, int number)
{
  const auto* const bends = reinterpret_cast<const std::uint8_t*>(&header) + header.BendOffset;
  const int macrocells = header.Macrocells[0] * header.Macrocells[1] * header.Macrocells[2];
  const int code = bends[isPart ? macrocells + number : number];
  if (code == NoBend)
  {
    return std::numeric_limits<double>::infinity();
  }
  const double range = static_cast<double>(header.Last) - static_cast<double>(header.First);
  return code == 0 ? 0.0 : range * std::exp2(static_cast<double>(code - UnitBend) / BendSteps);
}

/// The smallest and the largest of each of the second differences in a node: along x, y and z twice, along x and y, x
/// and z, y and z.
class NodeBends
{
public:
  static constexpr int Kinds = 6;

  void Add(int kind, const float* least, const float* most, int first, int last)
  {
    const auto at = static_cast<std::size_t>(kind);
    for (int x = first; x < last; ++x)
    {
      this->Least[at] = std::min(this->Least[at], least[x]);
      this->Most[at] = std::max(this->Most[at], most[x]);
    }
  }

  /// For a node of so many cells along an edge. A quadratic that agrees at three places with a curve whose second
  /// derivative varies by at most D in a way of length N is at most D N^2 / 32 from it. Trilinear values are not a
  /// smooth curve: they lie on chords of one, up to an eighth of its second derivative beside it.
  double Get(int edge) const
  {
    double variation = 0.0;
    double chord = 0.0;
    for (std::size_t kind = 0; kind < Kinds; ++kind)
    {
      const double least = this->Least[kind];
      const double most = this->Most[kind];
      if (least <= most)
      {
        variation += (kind < 3 ? 1.0 : 2.0) * (most - least);
        chord += kind < 3 ? std::max(std::abs(least), std::abs(most)) : 0.0;
      }
    }
    return variation * edge * edge / 32.0 + 0.125 * chord;
  }

private:
  static constexpr float Infinity = std::numeric_limits<float>::infinity();
  std::array<float, Kinds> Least{ Infinity, Infinity, Infinity, Infinity, Infinity, Infinity };
  std::array<float, Kinds> Most{ -Infinity, -Infinity, -Infinity, -Infinity, -Infinity, -Infinity };
};

/// Finds the second differences in the nodes of a brick.
template <class T>
class BendSearch
{
public:
  explicit BendSearch(const VoxelBrick<T>& brick)
    : Row(brick.GetRow())
    , Slice(brick.GetSlice())
    , Values(static_cast<std::size_t>(brick.GetSlice()) *
        static_cast<std::size_t>(brick.GetCells(2) + 1))
    , Differences(static_cast<std::size_t>(brick.GetRow()))
    , Check(this->Differences)
    , Least(NodeBends::Kinds, std::vector<float>(static_cast<std::size_t>(brick.GetRow())))
    , Most(this->Least)
  {
    // Relative to a sample, so that large values with small differences keep these.
    const double origin = static_cast<double>(brick.GetSamples()[0]);
    std::transform(brick.GetSamples(), brick.GetSamples() + this->Values.size(),
      this->Values.begin(),
      [origin](T value) { return static_cast<float>(static_cast<double>(value) - origin); });
  }

  /// Looks at the nodes with cells in [y0, y1) and [z0, z1).
  void SearchRow(int y0, int y1, int z0, int z1)
  {
    for (int kind = 0; kind < NodeBends::Kinds; ++kind)
    {
      std::fill(this->GetLeast(kind), this->GetLeast(kind) + this->Row, Infinity);
      std::fill(this->GetMost(kind), this->GetMost(kind) + this->Row, -Infinity);
    }
    const int end = this->Row;
    std::fill_n(this->Check.begin(), end, 0.0f);
    for (int z = z0; z <= z1; ++z)
    {
      for (int y = y0; y <= y1; ++y)
      {
        const float* const here = this->Values.data() + y * this->Row + z * this->Slice;
        const float* const below = here - this->Row;
        const float* const above = here + this->Row;
        const float* const front = here - this->Slice;
        const float* const back = here + this->Slice;
        const float* const across = back + this->Row;
        for (int x = 0; x < end; ++x)
        {
          this->Check[static_cast<std::size_t>(x)] += here[x] * 0.0f;
        }
        this->Raise(
          0, 1, end - 1, [=](int x) { return here[x - 1] - 2.0f * here[x] + here[x + 1]; });
        if (y > y0 && y < y1)
        {
          this->Raise(1, 0, end, [=](int x) { return below[x] - 2.0f * here[x] + above[x]; });
        }
        if (z > z0 && z < z1)
        {
          this->Raise(2, 0, end, [=](int x) { return front[x] - 2.0f * here[x] + back[x]; });
        }
        if (y < y1)
        {
          this->Raise(3, 0, end - 1,
            [=](int x) { return (above[x + 1] - above[x]) - (here[x + 1] - here[x]); });
        }
        if (z < z1)
        {
          this->Raise(4, 0, end - 1,
            [=](int x) { return (back[x + 1] - back[x]) - (here[x + 1] - here[x]); });
        }
        if (y < y1 && z < z1)
        {
          this->Raise(
            5, 0, end, [=](int x) { return (across[x] - back[x]) - (above[x] - here[x]); });
        }
      }
    }
  }

  /// Returns what was found in the cells [first, last) of that row.
  NodeBends Get(int first, int last)
  {
    NodeBends bends;
    for (int kind = 0; kind < NodeBends::Kinds; ++kind)
    {
      const bool isTwiceOnX = kind == 0;
      const bool isOnX = kind == 3 || kind == 4;
      bends.Add(kind, this->GetLeast(kind), this->GetMost(kind), isTwiceOnX ? first + 1 : first,
        isTwiceOnX || isOnX ? last : last + 1);
    }
    return bends;
  }
  /// Returns whether all of their values are finite.
  bool AreFinite(int first, int last) const
  {
    float sum = 0.0f;
    for (int x = first; x <= last; ++x)
    {
      sum += this->Check[static_cast<std::size_t>(x)];
    }
    return sum == 0.0f;
  }

private:
  static constexpr float Infinity = std::numeric_limits<float>::infinity();

  float* GetLeast(int kind) { return this->Least[static_cast<std::size_t>(kind)].data(); }
  float* GetMost(int kind) { return this->Most[static_cast<std::size_t>(kind)].data(); }

  template <class Get>
  void Raise(int kind, int first, int last, const Get& get)
  {
    float* const least = this->GetLeast(kind);
    float* const most = this->GetMost(kind);
    float* const differences = this->Differences.data();
    for (int x = first; x < last; ++x)
    {
      differences[x] = get(x);
    }
    for (int x = first; x < last; ++x)
    {
      least[x] = std::min(least[x], differences[x]);
      most[x] = std::max(most[x], differences[x]);
    }
  }

  int Row;
  int Slice;
  std::vector<float> Values;
  std::vector<float> Differences;
  std::vector<float> Check; ///< for each x: not a number, where a value is not finite
  std::vector<std::vector<float>> Least;
  std::vector<std::vector<float>> Most;
};

/// Returns whether the mask lets all cells of a box hold data.
template <class T>
bool AreCovered(const VoxelBrick<T>& brick, const int first[3], const int last[3])
{
  bool areCovered = true;
  for (int z = first[2]; z < last[2] && areCovered; ++z)
  {
    for (int y = first[1]; y < last[1]; ++y)
    {
      for (int x = first[0]; x < last[0]; ++x)
      {
        areCovered = areCovered && brick.IsCovered(x, y, z);
      }
    }
  }
  return areCovered;
}

/// Derives the bends of a brick, whose macrocells and range are there.
template <class T>
void BuildBends(std::byte* block)
{
  const VoxelBrick<T> brick(block);
  const VoxelBrickHeader& header = brick.GetHeader();
  const double range = static_cast<double>(header.Last) - static_cast<double>(header.First);
  auto* bend = reinterpret_cast<std::uint8_t*>(block) + header.BendOffset;
  BendSearch<T> search(brick);
  for (const int edge : { MacrocellEdge, PartEdge })
  {
    const auto getEnd = [&](int axis, int begin)
    { return std::min(begin + edge, brick.GetCells(axis)); };
    for (int z = 0; z < brick.GetCells(2); z += edge)
    {
      for (int y = 0; y < brick.GetCells(1); y += edge)
      {
        search.SearchRow(y, getEnd(1, y), z, getEnd(2, z));
        for (int x = 0; x < brick.GetCells(0); x += edge)
        {
          const int first[3] = { x, y, z };
          const int last[3] = { getEnd(0, x), getEnd(1, y), getEnd(2, z) };
          const bool isWhole = search.AreFinite(first[0], last[0]) &&
            (header.MaskOffset == 0 || AreCovered(brick, first, last));
          const double relative =
            range > 0.0 ? search.Get(first[0], last[0]).Get(edge) / range : 0.0;
          *bend++ = isWhole ? EncodeBend(relative) : NoBend;
        }
      }
    }
  }
}

} // namespace bricks

#endif
