// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/ChunkCodec.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace vol
{

namespace
{

[[noreturn]] void Refuse(const std::string& what)
{
  throw dsm::Error(what);
}

bool Compresses(const CodecStep& step)
{
  return step.What->IsCompressor;
}

bool MayHaveHalo(const CodecStep& step)
{
  return step.What->AddHalo != nullptr;
}

/// As many bytes as a step makes at most of so many, which may not shrink unless it converts them; the greatest
/// number where that is more.
std::uint64_t GetMost(const CodecStep& step, std::uint64_t bytes)
{
  constexpr std::uint64_t header = 1024;
  constexpr std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  if (bytes > all / 16 - header)
  {
    return all;
  }
  if (step.What->ConvertsNumbers)
  {
    return (bytes / bricks::GetBytes(step.With.Decoded.Type) + 1) *
      bricks::GetBytes(step.With.Encoded.Type);
  }
  // More than zlib's bound for any of its settings, the largest: an eighth, a 64th, and its header.
  return Compresses(step) ? bytes + bytes / 4 + header : bytes + step.What->AddedBytes;
}

ByteBuffer Undo(const CodecStep& step, ByteBuffer bytes, std::uint64_t most)
{
  return step.What->Decode(std::move(bytes), step.With, static_cast<std::size_t>(most));
}

ByteBuffer Do(const CodecStep& step, ByteBuffer bytes)
{
  if (!step.What->Encode)
  {
    Refuse("this compression or checksum can be read but not written.");
  }
  return step.What->Encode(std::move(bytes), step.With);
}

} // namespace

CodecStep::CodecStep(std::string_view name, std::size_t width)
  : CodecStep(FindCodec(name), CodecParameters{ width })
{
}

CodecStep::CodecStep(const Codec* what, CodecParameters with)
  : What(what)
  , With(std::move(with))
{
  if (!what)
  {
    throw std::logic_error("unknown codec name");
  }
}

ChunkCodec::ChunkCodec(std::vector<CodecStep> steps)
  : Steps(std::move(steps))
{
  const auto compressors =
    static_cast<std::size_t>(std::count_if(this->Steps.begin(), this->Steps.end(), &Compresses));
  if (this->Steps.size() > FileLimits::Filters || compressors > FileLimits::Compressors)
  {
    Refuse("its chunks have " + std::to_string(this->Steps.size()) + " filters, " +
      std::to_string(compressors) + " of which are compressors; at most " +
      std::to_string(FileLimits::Filters) + ", " + std::to_string(FileLimits::Compressors) +
      " of which are compressors, are supported.");
  }
  for (const CodecStep& step : this->Steps)
  {
    if (step.With.Width == 0)
    {
      Refuse("a filter of its chunks has elements of 0 bytes.");
    }
    if (!step.What->LackingPackage.empty())
    {
      Refuse("its values are compressed with " + std::string(step.What->Name) +
        ", which this build cannot read. Install the package " +
        std::string(step.What->LackingPackage) + " and build again.");
    }
  }
}

bool ChunkCodec::Decode(
  ByteBuffer stored, unsigned skipped, std::byte* out, std::size_t bytes, ByteBuffer* halo) const
{
  std::optional<ByteBuffer> beside;
  // Upper bounds of the bytes before each step.
  std::vector<std::uint64_t> most{ bytes };
  std::vector<std::uint64_t> mostBeside{ halo ? halo->size() : 0 };
  for (const CodecStep& step : this->Steps)
  {
    most.push_back(GetMost(step, most.back()));
    mostBeside.push_back(GetMost(step, mostBeside.back()));
  }
  for (std::size_t step = this->Steps.size(); step-- > 0;)
  {
    if ((skipped >> step & 1) == 0)
    {
      if (halo && !beside && MayHaveHalo(this->Steps[step]) &&
        stored.size() > CodecBytes::HaloHeader)
      {
        beside = this->Steps[step].What->FindHalo(stored);
      }
      if (beside)
      {
        beside = Undo(this->Steps[step], std::move(*beside), mostBeside[step]);
      }
      stored = Undo(this->Steps[step], std::move(stored), most[step]);
    }
  }
  if (stored.size() != bytes)
  {
    Refuse(
      "it has " + std::to_string(stored.size()) + " bytes instead of " + std::to_string(bytes));
  }
  if (halo)
  {
    if (!beside || beside->size() != halo->size())
    {
      return false;
    }
    halo->swap(*beside);
  }
  std::memcpy(out, stored.data(), bytes);
  return true;
}

ByteBuffer ChunkCodec::Encode(ByteBuffer samples, ByteBuffer halo) const
{
  for (const CodecStep& step : this->Steps)
  {
    samples = Do(step, std::move(samples));
    if (!halo.empty() && MayHaveHalo(step))
    {
      step.What->AddHalo(samples, Do(step, std::exchange(halo, {})));
    }
    else if (!halo.empty())
    {
      halo = Do(step, std::move(halo));
    }
  }
  return samples;
}

std::uint64_t ChunkCodec::CountMostStored(std::uint64_t bytes, std::uint64_t haloBytes) const
{
  // The halo passes the same steps, and lies behind the chunk with a header of its own.
  std::uint64_t most = bytes;
  std::uint64_t beside = haloBytes;
  for (const CodecStep& step : this->Steps)
  {
    most = GetMost(step, most);
    beside = GetMost(step, beside);
  }
  const bool hasHalo = haloBytes != 0 && this->KeepsHalo();
  beside = hasHalo ? std::min(beside, ~beside) + CodecBytes::HaloHeader : 0;
  return most < ~beside ? most + beside : ~std::uint64_t(0);
}

std::uint64_t ChunkCodec::CountMostDecoded(std::uint64_t stored) const
{
  constexpr std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  for (const CodecStep& step : this->Steps)
  {
    stored = MultiplyWithin(all, { stored, step.What->MostGrowth }).value_or(all);
  }
  return stored;
}

bool ChunkCodec::KeepsHalo() const
{
  // A second compressor would have to unpack more than the chunk, without knowing how much.
  return std::count_if(this->Steps.begin(), this->Steps.end(), &Compresses) == 1 &&
    std::any_of(this->Steps.begin(), this->Steps.end(), &MayHaveHalo);
}

bool ChunkCodec::KeepsPlaces() const
{
  return std::all_of(this->Steps.begin(), this->Steps.end(),
    [](const CodecStep& step) { return step.What->KeepsPlaces; });
}

} // namespace vol
