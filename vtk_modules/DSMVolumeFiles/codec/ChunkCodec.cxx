// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/ChunkCodec.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/codec/Checksums.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#ifdef DSM_HAS_LIBDEFLATE
#include <libdeflate.h>
#endif
#ifdef DSM_HAS_ZLIB
#include <zlib.h>
#endif
#ifdef DSM_HAS_BLOSC
#include <blosc.h>
#endif
#ifdef DSM_HAS_ZSTD
#include <zstd.h>
#endif

namespace vol
{

namespace
{

using Bytes = ByteBuffer;
using Kind = CodecStep::Kind;

[[noreturn]] void Refuse(const std::string& what)
{
  throw dsm::Error(what);
}

[[noreturn, maybe_unused]] void RefuseLack(const std::string& what, const std::string& package)
{
  Refuse("Its values are compressed with " + what +
    ", which this build cannot read. Install the package " + package + " and build again.");
}

std::uint32_t GetNumber(const Bytes& bytes, std::size_t place)
{
  std::uint32_t value = 0;
  for (std::size_t byte = sizeof(value); byte-- > 0;)
  {
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[place + byte]);
  }
  return value;
}

void AddLast(Bytes& bytes, std::uint32_t value)
{
  for (int byte = 0; byte < 4; ++byte)
  {
    bytes.push_back(static_cast<std::byte>(value >> (8 * byte) & 0xff));
  }
}

/// Returns an upper bound for the ratio of unpacked to stored bytes. Deflate spends at least two bits on 258 bytes.
/// Zstandard, which Blosc may contain, spends at least four bytes on a block of 128 KiB.
std::uint64_t GetGrowth(Kind step)
{
  return step == Kind::Deflate ? 1032 : step == Kind::Zstd || step == Kind::Blosc ? 1 << 15 : 1;
}

/// Returns the size of the buffer to unpack to: no more than wanted, and no more than possible.
[[maybe_unused]] std::size_t GetRoom(const Bytes& stored, Kind step, std::size_t most)
{
  return static_cast<std::size_t>(
    MultiplyWithin(most, { stored.size(), GetGrowth(step) }).value_or(most));
}

#ifdef DSM_HAS_LIBDEFLATE
Bytes Inflate(const Bytes& stored, std::size_t most)
{
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> machine(
    libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!machine)
  {
    throw std::bad_alloc();
  }
  const bool gzip =
    stored.size() > 1 && stored[0] == std::byte(0x1f) && stored[1] == std::byte(0x8b);
  Bytes bytes(GetRoom(stored, Kind::Deflate, most));
  std::size_t used = 0;
  std::size_t count = 0;
  const libdeflate_result result =
    (gzip ? libdeflate_gzip_decompress_ex : libdeflate_zlib_decompress_ex)(
      machine.get(), stored.data(), stored.size(), bytes.data(), bytes.size(), &used, &count);
  if (result != LIBDEFLATE_SUCCESS)
  {
    Refuse("its deflate stream is damaged");
  }
  bytes.resize(count);
  return bytes;
}
#elif defined(DSM_HAS_ZLIB)
Bytes Inflate(Bytes& stored, std::size_t most)
{
  constexpr int zlibOrGzip = 15 + 32;
  const auto toCount = [](std::size_t size)
  { return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max())); };
  z_stream stream{};
  Bytes bytes(GetRoom(stored, Kind::Deflate, most));
  stream.next_in = reinterpret_cast<Bytef*>(stored.data());
  stream.avail_in = toCount(stored.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = toCount(bytes.size());
  if (inflateInit2(&stream, zlibOrGzip) != Z_OK)
  {
    throw std::bad_alloc();
  }
  const int state = inflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  if (state != Z_STREAM_END)
  {
    Refuse("its deflate stream is damaged");
  }
  return bytes;
}
#endif

#ifdef DSM_HAS_BLOSC
Bytes DecodeBlosc(const Bytes& stored, std::size_t most)
{
  std::size_t count = 0;
  if (blosc_cbuffer_validate(stored.data(), stored.size(), &count) != 0 || count > most)
  {
    Refuse("its Blosc header is damaged");
  }
  Bytes bytes(count);
  if (blosc_decompress_ctx(stored.data(), bytes.data(), count, 1) != static_cast<int>(count))
  {
    Refuse("its Blosc data are damaged");
  }
  return bytes;
}
#endif

#ifdef DSM_HAS_ZSTD
Bytes DecodeZstd(const Bytes& stored, std::size_t most)
{
  Bytes bytes(GetRoom(stored, Kind::Zstd, most));
  const std::size_t count =
    ZSTD_decompress(bytes.data(), bytes.size(), stored.data(), stored.size());
  if (ZSTD_isError(count))
  {
    Refuse(std::string("its Zstandard frame is damaged (") + ZSTD_getErrorName(count) + ")");
  }
  bytes.resize(count);
  return bytes;
}
#endif

#ifdef DSM_HAS_ZLIB
Bytes Deflate(const Bytes& samples)
{
  // Fast, and hardly larger than what higher levels make of scientific data.
  constexpr int level = 3;
  uLongf count = compressBound(samples.size());
  Bytes bytes(count);
  if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &count,
        reinterpret_cast<const Bytef*>(samples.data()), samples.size(), level) != Z_OK)
  {
    throw std::bad_alloc();
  }
  bytes.resize(count);
  return bytes;
}
#endif

#ifdef DSM_HAS_ZSTD
Bytes EncodeZstd(const Bytes& samples)
{
  constexpr int level = 3;
  Bytes bytes(ZSTD_compressBound(samples.size()));
  const std::size_t count =
    ZSTD_compress(bytes.data(), bytes.size(), samples.data(), samples.size(), level);
  if (ZSTD_isError(count))
  {
    throw std::bad_alloc();
  }
  bytes.resize(count);
  return bytes;
}
#endif

std::uint32_t TakeLast(Bytes& bytes)
{
  std::uint32_t value = 0;
  if (bytes.size() < sizeof(value))
  {
    Refuse("it is too short for its checksum");
  }
  value = GetNumber(bytes, bytes.size() - sizeof(value));
  bytes.resize(bytes.size() - sizeof(value));
  return value;
}

void Check(Bytes& bytes, std::uint32_t (*sum)(const std::byte*, std::size_t))
{
  const std::uint32_t expected = TakeLast(bytes);
  if (sum(bytes.data(), bytes.size()) != expected)
  {
    Refuse("its checksum is wrong");
  }
}

Bytes Shuffle(const Bytes& samples, std::size_t width)
{
  const std::size_t count = samples.size() / width;
  Bytes bytes(samples.size());
  for (std::size_t byte = 0; byte < width; ++byte)
  {
    for (std::size_t element = 0; element < count; ++element)
    {
      bytes[byte * count + element] = samples[element * width + byte];
    }
  }
  // What is left over behind the last element stays where it is.
  std::copy_n(
    samples.data() + count * width, samples.size() - count * width, bytes.data() + count * width);
  return bytes;
}

Bytes Unshuffle(const Bytes& stored, std::size_t width)
{
  Bytes bytes(stored.size());
  const auto put = [from = stored.data(), to = bytes.data(), all = stored.size()](auto elementBytes)
  {
    const std::size_t count = all / elementBytes;
    for (std::size_t element = 0; element < count; ++element)
    {
      for (std::size_t byte = 0; byte < elementBytes; ++byte)
      {
        to[element * elementBytes + byte] = from[byte * count + element];
      }
    }
    // What is left over behind the last element stays where it is.
    std::copy(from + count * elementBytes, from + all, to + count * elementBytes);
  };
  // Compilers make vectors of a width that they know.
  switch (width)
  {
    case 2:
      put(std::integral_constant<std::size_t, 2>());
      break;
    case 4:
      put(std::integral_constant<std::size_t, 4>());
      break;
    case 8:
      put(std::integral_constant<std::size_t, 8>());
      break;
    default:
      put(width);
  }
  return bytes;
}

void SwapBytes(Bytes& bytes, std::size_t width)
{
  for (std::size_t at = 0; at + width <= bytes.size(); at += width)
  {
    std::reverse(bytes.data() + at, bytes.data() + at + width);
  }
}

Bytes Undo(const CodecStep& step, Bytes bytes, [[maybe_unused]] std::size_t most)
{
  switch (step.What)
  {
    case Kind::SwapBytes:
      SwapBytes(bytes, step.Width);
      return bytes;
    case Kind::Shuffle:
      return Unshuffle(bytes, step.Width);
    case Kind::Fletcher32:
      Check(bytes, &GetFletcher32);
      return bytes;
    case Kind::Crc32c:
      Check(bytes, &GetCrc32c);
      return bytes;
#ifdef DSM_HAS_ZLIB
    case Kind::Deflate:
      return Inflate(bytes, most);
#endif
#ifdef DSM_HAS_BLOSC
    case Kind::Blosc:
      return DecodeBlosc(bytes, most);
#endif
#ifdef DSM_HAS_ZSTD
    case Kind::Zstd:
      return DecodeZstd(bytes, most);
#endif
    default:
      throw std::logic_error("the constructor lets no step pass that is not there");
  }
}

bool Compresses(const CodecStep& step)
{
  return step.What == Kind::Deflate || step.What == Kind::Blosc || step.What == Kind::Zstd;
}

/// As many bytes as a step makes at most of so many, which may not shrink; the greatest number where that is more.
std::uint64_t GetMost(const CodecStep& step, std::uint64_t bytes)
{
  constexpr std::uint64_t header = 1024;
  constexpr std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  if (bytes > all / 2 - header)
  {
    return all;
  }
  // More than zlib's bound for any of its settings, the largest: an eighth, a 64th, and its header.
  return Compresses(step)                                        ? bytes + bytes / 4 + header
    : step.What == Kind::Fletcher32 || step.What == Kind::Crc32c ? bytes + sizeof(std::uint32_t)
                                                                 : bytes;
}

Bytes Do(const CodecStep& step, Bytes bytes)
{
  switch (step.What)
  {
    case Kind::SwapBytes:
      SwapBytes(bytes, step.Width);
      return bytes;
    case Kind::Shuffle:
      return Shuffle(bytes, step.Width);
    case Kind::Fletcher32:
      AddLast(bytes, GetFletcher32(bytes.data(), bytes.size()));
      return bytes;
#ifdef DSM_HAS_ZLIB
    case Kind::Deflate:
      return Deflate(bytes);
#endif
#ifdef DSM_HAS_ZSTD
    case Kind::Zstd:
      return EncodeZstd(bytes);
#endif
    default:
      Refuse("This compression or checksum is read, but not written.");
  }
}

/// A chunk's halo is compressed as the chunk is, and lies behind it, where other programs do not look: behind a
/// Zstandard frame in a skippable one, that is with its size and a magic number before it ("D" of those that are
/// free for any use), and behind a deflate stream, whose end only unpacking finds, with both after it.
constexpr std::uint32_t HaloMagic = 0x184D2A50 + 0xD;
constexpr std::size_t HaloHeader = 2 * sizeof(std::uint32_t);

bool MayHaveHalo(const CodecStep& step)
{
  return step.What == Kind::Zstd || step.What == Kind::Deflate;
}

void AddHalo(const CodecStep& step, Bytes& bytes, Bytes halo)
{
  const Bytes packed = Do(step, std::move(halo));
  const auto size = static_cast<std::uint32_t>(packed.size());
  if (step.What == Kind::Zstd)
  {
    AddLast(bytes, HaloMagic);
    AddLast(bytes, size);
    bytes.insert(bytes.end(), packed.begin(), packed.end());
  }
  else
  {
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    AddLast(bytes, size);
    AddLast(bytes, HaloMagic);
  }
}

/// Of a chunk as it is stored, still compressed; nothing where there is none.
std::optional<Bytes> FindHalo(const CodecStep& step, const Bytes& stored)
{
  std::size_t first = 0;
  std::size_t last = stored.size();
  if (stored.size() <= HaloHeader)
  {
    return std::nullopt;
  }
#ifdef DSM_HAS_ZSTD
  if (step.What == Kind::Zstd)
  {
    const std::size_t frame = ZSTD_findFrameCompressedSize(stored.data(), stored.size());
    if (ZSTD_isError(frame) || stored.size() < frame + HaloHeader ||
      GetNumber(stored, frame) != HaloMagic ||
      GetNumber(stored, frame + sizeof(std::uint32_t)) != stored.size() - frame - HaloHeader)
    {
      return std::nullopt;
    }
    first = frame + HaloHeader;
  }
#endif
  if (step.What == Kind::Deflate)
  {
    last -= HaloHeader;
    const std::uint32_t size = GetNumber(stored, last);
    if (GetNumber(stored, last + sizeof(std::uint32_t)) != HaloMagic || size > last)
    {
      return std::nullopt;
    }
    first = last - size;
  }
  return Bytes(stored.begin() + static_cast<std::ptrdiff_t>(first),
    stored.begin() + static_cast<std::ptrdiff_t>(last));
}

} // namespace

ChunkCodec::ChunkCodec(std::vector<CodecStep> steps)
  : Steps(std::move(steps))
{
  const auto compressors =
    static_cast<std::size_t>(std::count_if(this->Steps.begin(), this->Steps.end(), &Compresses));
  if (this->Steps.size() > FileLimits::Filters || compressors > FileLimits::Compressors)
  {
    Refuse("its chunks have " + std::to_string(this->Steps.size()) + " filters, " +
      std::to_string(compressors) + " of them compressors; at most " +
      std::to_string(FileLimits::Filters) + ", " + std::to_string(FileLimits::Compressors) +
      " of them compressors, are supported.");
  }
  for (const CodecStep& step : this->Steps)
  {
    if (step.Width == 0)
    {
      Refuse("a filter of its chunks has elements of 0 bytes.");
    }
  }
  for ([[maybe_unused]] const CodecStep& step : this->Steps)
  {
#ifndef DSM_HAS_ZLIB
    if (step.What == Kind::Deflate)
    {
      RefuseLack("deflate", "zlib1g-dev");
    }
#endif
#ifndef DSM_HAS_BLOSC
    if (step.What == Kind::Blosc)
    {
      RefuseLack("Blosc", "libblosc-dev");
    }
#endif
#ifndef DSM_HAS_ZSTD
    if (step.What == Kind::Zstd)
    {
      RefuseLack("Zstandard", "libzstd-dev");
    }
#endif
  }
}

bool ChunkCodec::Decode(
  ByteBuffer stored, unsigned skipped, std::byte* out, std::size_t bytes, ByteBuffer* halo) const
{
  std::optional<Bytes> beside;
  // What was there before each step: at most so many bytes.
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
      if (halo && !beside && MayHaveHalo(this->Steps[step]))
      {
        beside = FindHalo(this->Steps[step], stored);
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
      AddHalo(step, samples, std::exchange(halo, {}));
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
  beside = hasHalo ? std::min(beside, ~beside) + HaloHeader : 0;
  return most < ~beside ? most + beside : ~std::uint64_t(0);
}

std::uint64_t ChunkCodec::CountMostDecoded(std::uint64_t stored) const
{
  constexpr std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  for (const CodecStep& step : this->Steps)
  {
    stored = MultiplyWithin(all, { stored, GetGrowth(step.What) }).value_or(all);
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
    [](const CodecStep& step) { return step.What == Kind::SwapBytes; });
}

} // namespace vol
