// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Channels_h
#define rt_Channels_h

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// A set of channels: the sum of Bits. Each picture has those of Always, asked for or not.
struct ChannelSet
{
  enum Bits : std::uint32_t
  {
    Color = 1,
    Depth = 2,
    Normal = 4,
    Albedo = 8,
    Object = 16,
    Integral = 32,
    /// Sums that LightFilter needs (Tile), without values of their own.
    Light = 64,
    Always = Color | Depth,
    All = Always | Normal | Albedo | Object | Integral
  };

  std::uint32_t Value = Always;

  bool Has(Bits channel) const { return ((this->Value | Always) & channel) != 0; }
  /// Returns whether there are more channels than those of Always.
  bool HasMore() const { return (this->Value & ~std::uint32_t{ Always }) != 0; }
};

/// Values of the pixels of a tile or an image, channel by channel: row by row from the bottom, x
/// fastest, and layer after layer. A new channel is a member, a bit, and a line in ForEach.
struct Channels
{
  /// Channels that have values.
  ChannelSet Present;

  /// Four bytes a pixel, red first, alpha premultiplied; alpha 0 where nothing was hit.
  std::vector<std::uint8_t> Color;
  /// OpenGL window depth in [0, 1]; 1 where nothing was hit.
  std::vector<float> Depth;

  // On request. They describe the whole pixel, and are in the first of several layers.

  /// Three floats a pixel, unit, world space: the normal of the first surface, on the side that is seen, averaged over
  /// the samples; 0 where nothing was hit.
  std::vector<float> Normal;
  /// Colors of surfaces, and of lines on them, without light, mirrors and debug views; else as Color.
  std::vector<std::uint8_t> Albedo;
  /// Index in Scene::Objects of the first surface in the middle of the pixel, which sample 0 meets; -1 for none.
  std::vector<std::int32_t> Object;
  /// Integrals of values along the ray through the middle of the pixel, over its length in world space: the sum over
  /// all media that have any (IntegralOf), from the near plane to the far plane, whatever surfaces are in between.
  std::vector<float> Integral;

  /// Calls `visit(values, count, empty, others...)` for each channel that `first` has: so many values a pixel, what one
  /// of them is where nothing was hit, and the same channel of `others`, which have the same ones.
  template <class First, class Visit, class... Others>
  static void ForEach(First& first, const Visit& visit, Others&... others)
  {
    const auto visitIf =
      [&](ChannelSet::Bits channel, auto& values, std::size_t count, auto empty, auto&... same)
    {
      if (first.Present.Has(channel))
      {
        visit(values, count, empty, same...);
      }
    };
    visitIf(ChannelSet::Color, first.Color, std::size_t(4), std::uint8_t(0), others.Color...);
    visitIf(ChannelSet::Depth, first.Depth, std::size_t(1), 1.0f, others.Depth...);
    visitIf(ChannelSet::Normal, first.Normal, std::size_t(3), 0.0f, others.Normal...);
    visitIf(ChannelSet::Albedo, first.Albedo, std::size_t(4), std::uint8_t(0), others.Albedo...);
    visitIf(ChannelSet::Object, first.Object, std::size_t(1), std::int32_t(-1), others.Object...);
    visitIf(ChannelSet::Integral, first.Integral, std::size_t(1), 0.0f, others.Integral...);
  }

  /// Makes `pixels` empty pixels with these channels.
  void Reset(ChannelSet channels, std::size_t pixels)
  {
    *this = {};
    this->Present = channels;
    this->Resize(pixels);
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
