// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_NodeOrder_h
#define rt_NodeOrder_h

#include <cstddef>
#include <cstdint>

namespace rt
{

/// Returns the macrocells of 4 x 4 x 4 for which `mayHold(range)` is true, in bits x + 4 y + 16 z. `row` and
/// `slice` are the offsets of the next macrocell along y and z.
template <class Range, class MayHold>
std::uint64_t FindEachMacrocell(
  const Range* ranges, std::ptrdiff_t row, std::ptrdiff_t slice, const MayHold& mayHold)
{
  std::uint64_t found = 0;
  for (int number = 0; number < 64; ++number)
  {
    const Range& range = ranges[number % 4 + number / 4 % 4 * row + number / 16 * slice];
    found |= std::uint64_t{ mayHold(range) } << number;
  }
  return found;
}

/// 4 x 4 x 4 nodes, x + 4 y + 16 z each, counted on every axis in the direction in which rays move:
/// along a ray the numbers rise, so that of nodes in a word of 64 bits the lowest is met first.
class NodeOrder
{
public:
  explicit NodeOrder(const bool forward[3])
    : Flip((forward[0] ? 0 : 3) | (forward[1] ? 0 : 12) | (forward[2] ? 0 : 48))
  {
  }

  /// From the number of a node that is counted towards larger coordinates, or back to it.
  int Turn(int node) const { return node ^ this->Flip; }

  /// The same for the nodes of a word.
  std::uint64_t TurnAll(std::uint64_t nodes) const
  {
    if ((this->Flip & 3) != 0)
    {
      nodes = Swap(Swap(nodes, 1, 0x5555555555555555u), 2, 0x3333333333333333u);
    }
    if ((this->Flip & 12) != 0)
    {
      nodes = Swap(Swap(nodes, 4, 0x0f0f0f0f0f0f0f0fu), 8, 0x00ff00ff00ff00ffu);
    }
    if ((this->Flip & 48) != 0)
    {
      nodes = Swap(Swap(nodes, 16, 0x0000ffff0000ffffu), 32, 0x00000000ffffffffu);
    }
    return nodes;
  }

private:
  /// Neighboring groups of `bits` bits; those of `lower` are the lower ones.
  static std::uint64_t Swap(std::uint64_t word, int bits, std::uint64_t lower)
  {
    return (word >> bits & lower) | (word & lower) << bits;
  }

  int Flip;
};

/// Returns the bits of a box of nodes that begins at the first node and has so many nodes on each
/// axis. Nodes are counted towards larger coordinates.
inline std::uint64_t GetNodeBox(const int counts[3])
{
  std::uint64_t box = 0;
  for (int z = 0; z < counts[2]; ++z)
  {
    for (int y = 0; y < counts[1]; ++y)
    {
      box |= ((std::uint64_t{ 1 } << counts[0]) - 1) << (4 * y + 16 * z);
    }
  }
  return box;
}

} // namespace rt

#endif
