// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"
#include "DSMVolumeFiles/codec/CodecJson.h"

#include <nlohmann/json.hpp>

#include <new>

#ifdef DSM_HAS_LZMA
#include <lzma.h>
#endif

namespace vol
{

namespace
{

/// Two bits are spent on 273 bytes each, by probabilities of up to 2017 / 2048.
constexpr std::uint64_t MostGrowth = 1 << 14;

#ifdef DSM_HAS_LZMA
/// For the dictionary; preset 9 of xz takes 65 MiB.
constexpr std::uint64_t MostMemory = 80 << 20;

/// Python's numbers of the formats.
enum Format : std::uint64_t
{
  FindIt = 0,
  Xz = 1,
  Alone = 2,
  Raw = 3,
};

/// Numbers of CodecParameters: the format and, of a raw stream, these of each filter.
struct Filter
{
  std::uint64_t Id;
  std::uint64_t Dictionary;
  std::uint64_t LiteralContext;  ///< "lc"
  std::uint64_t LiteralPosition; ///< "lp"
  std::uint64_t Position;        ///< "pb"
  std::uint64_t Distance;        ///< of "delta"
  std::uint64_t Start;           ///< of filters for programs
};
constexpr std::size_t NumbersOfFilter = sizeof(Filter) / sizeof(std::uint64_t);

CodecParameters ParseZarr(const nlohmann::json& configuration, const ElementType&)
{
  CodecParameters with;
  const auto format =
    static_cast<std::uint64_t>(CodecJson::GetInteger(configuration, "format", Xz, FindIt, Raw));
  with.Numbers.push_back(format);
  const nlohmann::json& filters = CodecJson::Find(configuration, "filters");
  if (format != Raw)
  {
    return with; // the stream has its filters
  }
  if (!filters.is_array() || filters.empty() || filters.size() > LZMA_FILTERS_MAX)
  {
    throw dsm::Error("has 'format' 3 (raw) and no 'filters', or more than " +
      std::to_string(LZMA_FILTERS_MAX) + ".");
  }
  for (const nlohmann::json& filter : filters)
  {
    const nlohmann::json& id = CodecJson::Find(filter, "id");
    if (!id.is_number_unsigned() || !lzma_filter_decoder_is_supported(id.get<std::uint64_t>()))
    {
      throw dsm::Error("has a filter in 'filters' whose 'id' is not one of liblzma.");
    }
    lzma_options_lzma usual{};
    const std::int64_t preset =
      CodecJson::GetInteger(filter, "preset", LZMA_PRESET_DEFAULT, 0, UINT32_MAX);
    if (lzma_lzma_preset(&usual, static_cast<std::uint32_t>(preset)))
    {
      throw dsm::Error("has a filter in 'filters' whose 'preset' is not one of liblzma.");
    }
    const auto get = [&](const char* name, std::int64_t otherwise, std::int64_t most)
    { return static_cast<std::uint64_t>(CodecJson::GetInteger(filter, name, otherwise, 0, most)); };
    for (const std::uint64_t number : { id.get<std::uint64_t>(),
           get("dict_size", usual.dict_size, UINT32_MAX), get("lc", usual.lc, LZMA_LCLP_MAX),
           get("lp", usual.lp, LZMA_LCLP_MAX), get("pb", usual.pb, LZMA_PB_MAX),
           get("dist", 1, LZMA_DELTA_DIST_MAX), get("start_offset", 0, UINT32_MAX) })
    {
      with.Numbers.push_back(number);
    }
  }
  return with;
}

/// `most`: decoded bytes; matches do not reach farther back.
lzma_ret StartRaw(lzma_stream& stream, const CodecParameters& with, std::size_t most)
{
  lzma_filter chain[LZMA_FILTERS_MAX + 1] = {};
  lzma_options_lzma lzma[LZMA_FILTERS_MAX] = {};
  lzma_options_delta delta[LZMA_FILTERS_MAX] = {};
  lzma_options_bcj program[LZMA_FILTERS_MAX] = {};
  const std::size_t count = (with.Numbers.size() - 1) / NumbersOfFilter;
  for (std::size_t number = 0; number < count; ++number)
  {
    Filter filter;
    std::memcpy(&filter, &with.Numbers[1 + number * NumbersOfFilter], sizeof(filter));
    chain[number].id = filter.Id;
    if (filter.Id == LZMA_FILTER_DELTA)
    {
      delta[number].type = LZMA_DELTA_TYPE_BYTE;
      delta[number].dist = static_cast<std::uint32_t>(filter.Distance);
      chain[number].options = &delta[number];
    }
    else if (filter.Id == LZMA_FILTER_LZMA1 || filter.Id == LZMA_FILTER_LZMA2)
    {
      lzma[number].dict_size = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        filter.Dictionary, std::max<std::size_t>(most, LZMA_DICT_SIZE_MIN)));
      lzma[number].lc = static_cast<std::uint32_t>(filter.LiteralContext);
      lzma[number].lp = static_cast<std::uint32_t>(filter.LiteralPosition);
      lzma[number].pb = static_cast<std::uint32_t>(filter.Position);
      chain[number].options = &lzma[number];
    }
    else
    {
      program[number].start_offset = static_cast<std::uint32_t>(filter.Start);
      chain[number].options = &program[number];
    }
  }
  chain[count].id = LZMA_VLI_UNKNOWN;
  return lzma_raw_decoder(&stream, chain);
}

lzma_ret Start(lzma_stream& stream, const CodecParameters& with, std::size_t most)
{
  switch (with.Numbers.empty() ? std::uint64_t(Xz) : with.Numbers.front())
  {
    case FindIt:
      return lzma_auto_decoder(&stream, MostMemory, 0);
    case Alone:
      return lzma_alone_decoder(&stream, MostMemory);
    case Raw:
      return StartRaw(stream, with, most);
    default:
      return lzma_stream_decoder(&stream, MostMemory, 0);
  }
}

ByteBuffer Decode(ByteBuffer stored, const CodecParameters& with, std::size_t most)
{
  lzma_stream stream = LZMA_STREAM_INIT;
  ByteBuffer bytes(CodecBytes::GetRoom(stored, MostGrowth, most));
  lzma_ret state = Start(stream, with, bytes.size());
  if (state == LZMA_OK)
  {
    stream.next_in = reinterpret_cast<const std::uint8_t*>(stored.data());
    stream.avail_in = stored.size();
    stream.next_out = reinterpret_cast<std::uint8_t*>(bytes.data());
    stream.avail_out = bytes.size();
    state = lzma_code(&stream, LZMA_FINISH);
  }
  const std::size_t count = bytes.size() - stream.avail_out;
  const std::uint64_t needed = state == LZMA_MEMLIMIT_ERROR ? lzma_memusage(&stream) : 0;
  lzma_end(&stream);
  if (state == LZMA_MEM_ERROR)
  {
    throw std::bad_alloc();
  }
  if (state == LZMA_MEMLIMIT_ERROR)
  {
    throw dsm::Error("its LZMA stream needs " + std::to_string(needed) +
      " bytes to be unpacked; at most " + std::to_string(MostMemory) + " are supported");
  }
  if (state != LZMA_STREAM_END)
  {
    throw dsm::Error("its LZMA stream is damaged");
  }
  bytes.resize(count);
  return bytes;
}
#endif

} // namespace

/// As Python's module lzma has it: .xz, .lzma, or a raw stream.
Codec MakeLzmaCodec()
{
  Codec codec{ "lzma", { "lzma" } };
  codec.IsCompressor = true;
  codec.MostGrowth = MostGrowth;
#ifdef DSM_HAS_LZMA
  codec.ParseZarr = &ParseZarr;
  codec.Decode = &Decode;
#else
  codec.LackingPackage = "liblzma-dev";
#endif
  return codec;
}

} // namespace vol
