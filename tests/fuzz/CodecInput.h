// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_CodecInput_h
#define fuzz_CodecInput_h

#include "DSMVolumeFiles/codec/ChunkCodec.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fuzz
{

/// An input of the target for codecs: number of steps (1 byte), for each its kind and width (2 bytes), which are
/// skipped (1), how many bytes the samples have (2, low byte first) and how many the halo (1), and the stored
/// bytes.
struct CodecInput
{
  static constexpr std::size_t MostSteps = 4;

  std::vector<vol::CodecStep> Steps;
  unsigned Skipped = 0;
  std::size_t SampleBytes = 0;
  std::size_t HaloBytes = 0;
  vol::ByteBuffer Stored;

  static CodecInput Parse(const std::uint8_t* bytes, std::size_t count)
  {
    std::size_t at = 0;
    const auto take = [&] { return at < count ? bytes[at++] : std::uint8_t(0); };
    CodecInput input;
    const std::size_t steps = take() % (MostSteps + 1);
    for (std::size_t step = 0; step < steps; ++step)
    {
      const std::vector<vol::Codec>& codecs = vol::GetCodecs();
      const vol::Codec* const codec = &codecs[take() % codecs.size()];
      const std::size_t width = take();
      vol::CodecParameters with{ std::max<std::size_t>(1, width) };
      // Of codecs that convert numbers, and of LZMA.
      with.Decoded = { static_cast<bricks::ScalarType>(width % 10), width > 200 };
      with.Encoded = { static_cast<bricks::ScalarType>(width / 10 % 10), width > 150 };
      with.Scale = static_cast<double>(width % 7);
      with.Numbers = { width % 4, 0x21, 4096, 3, 0, 2, 1, 0 };
      input.Steps.emplace_back(codec, with);
    }
    input.Skipped = take();
    input.SampleBytes = take();
    input.SampleBytes += std::size_t(take()) << 8;
    input.HaloBytes = take();
    const auto* const rest = reinterpret_cast<const std::byte*>(bytes);
    input.Stored.assign(rest + at, rest + count);
    return input;
  }

  std::vector<std::uint8_t> Write() const
  {
    std::vector<std::uint8_t> bytes{ static_cast<std::uint8_t>(this->Steps.size()) };
    for (const vol::CodecStep& step : this->Steps)
    {
      bytes.push_back(static_cast<std::uint8_t>(step.What - vol::GetCodecs().data()));
      bytes.push_back(static_cast<std::uint8_t>(step.With.Width));
    }
    bytes.push_back(static_cast<std::uint8_t>(this->Skipped));
    bytes.push_back(static_cast<std::uint8_t>(this->SampleBytes & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(this->SampleBytes >> 8));
    bytes.push_back(static_cast<std::uint8_t>(this->HaloBytes));
    const auto* const stored = reinterpret_cast<const std::uint8_t*>(this->Stored.data());
    bytes.insert(bytes.end(), stored, stored + this->Stored.size());
    return bytes;
  }
};

} // namespace fuzz

#endif
