// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Channels_h
#define rt_Channels_h

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// What the pixels of a tile or a picture show, channel by channel: row by row from the bottom, x fastest, and layer
/// after layer. A new channel is a member, and a line in ForEach.
struct Channels
{
  /// Four bytes a pixel, red first, alpha premultiplied; alpha 0 where nothing was hit.
  std::vector<std::uint8_t> Color;
  /// OpenGL window depth in [0, 1]; 1 where nothing was hit.
  std::vector<float> Depth;

  /// Calls `visit(values, count, empty, others...)` for each channel: so many values a pixel, what one of them is where
  /// nothing was hit, and the same channel of `others`.
  template <class First, class Visit, class... Others>
  static void ForEach(First& first, const Visit& visit, Others&... others)
  {
    visit(first.Color, std::size_t(4), std::uint8_t(0), others.Color...);
    visit(first.Depth, std::size_t(1), 1.0f, others.Depth...);
  }

  /// Makes room for so many pixels; new ones are empty.
  void Resize(std::size_t pixels)
  {
    ForEach(*this,
      [=](auto& values, std::size_t count, auto empty) { values.resize(count * pixels, empty); });
  }
};

} // namespace rt

#endif
