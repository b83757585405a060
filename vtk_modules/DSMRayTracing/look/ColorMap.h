// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ColorMap_h
#define rt_ColorMap_h

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace rt
{

/// A sampled color map. Colors are linear in the value between First and Last, entry 0 belonging
/// to First; nearest entry, or lines between nodes where colors change within one. Or categories.
/// Not premultiplied.
struct ColorMap
{
  double First = 0.0;
  double Last = 1.0;
  /// The table is spaced evenly in log10 of the value.
  bool Logarithmic = false;
  std::vector<glm::vec4> Table;
  struct Node
  {
    double Value;
    glm::vec4 Color;
  };
  /// Nodes of the entries that need more than one color, ascending, from one end of each entry to
  /// the other.
  std::vector<Node> Nodes;
  /// For each entry of the table, the first of its nodes, and their number at the end. Empty: there are none.
  std::vector<std::uint32_t> FirstNode;
  glm::vec4 Below{ 0.0f };
  glm::vec4 Above{ 0.0f };
  glm::vec4 NotANumber{ 0.0f };

  struct Category
  {
    double Value;
    glm::vec4 Color;
  };
  /// If set, in ascending order of value: only these values have colors, whatever the table has.
  /// All other values are treated as NaN.
  std::optional<std::vector<Category>> Categories;

  /// Fills the table, with so many entries, and the nodes with the colors of a function between
  /// First and Last. `nodes`: values where it may bend or jump.
  void Sample(std::size_t entries, const std::function<glm::vec4(double)>& color,
    const std::vector<double>& nodes);

  /// Makes all values opaque, but not what is not a number.
  void SetOpaque();

  glm::vec4 Map(double value) const;
  /// The value to which an entry of the table belongs; or that of a place between two entries.
  double GetValue(double entry) const;
  /// The table shows no value up to this one, or, `fromAbove`, no value down to it; infinite where it shows all, or
  /// none. Below and Above are to be as the first and the last entry.
  double FindUnseenEnd(bool fromAbove) const;
  /// Returns whether no color of the map lets light through.
  bool IsOpaque() const;

private:
  bool IsSeen(std::size_t entry) const;
};

} // namespace rt

#endif
