// SPDX-License-Identifier: BSD-3-Clause
// Codecs of numcodecs that convert each number: https://numcodecs.readthedocs.io
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecJson.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace vol
{

namespace
{

template <class T>
T Load(const std::byte* from, bool swapped)
{
  std::byte bytes[sizeof(T)];
  swapped ? std::reverse_copy(from, from + sizeof(T), bytes) : std::copy_n(from, sizeof(T), bytes);
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <class T>
void Store(T value, bool swapped, std::byte* to)
{
  std::memcpy(to, &value, sizeof(T));
  if (swapped)
  {
    std::reverse(to, to + sizeof(T));
  }
}

/// As NumPy does it: toward 0, and integers modulo their number of values. The result is any beyond 64 bits.
template <class To, class From>
To Cast(From value)
{
  if constexpr (std::is_integral_v<To> && std::is_floating_point_v<From>)
  {
    constexpr From bound = 0x1p63;
    if (std::is_unsigned_v<To> && value >= bound && value < 2 * bound)
    {
      return static_cast<To>(static_cast<std::uint64_t>(value));
    }
    return static_cast<To>(value >= -bound && value < bound
        ? static_cast<std::int64_t>(value)
        : std::numeric_limits<std::int64_t>::min());
  }
  else
  {
    return static_cast<To>(value);
  }
}

/// `makeConvert(encoded, decoded)` gets a value of either type, and returns a function that decodes one after the
/// other.
template <class MakeConvert>
ByteBuffer DecodeEach(const ByteBuffer& stored, const CodecParameters& with, std::size_t most,
  const MakeConvert& makeConvert)
{
  const std::size_t from = bricks::GetBytes(with.Encoded.Type);
  const std::size_t to = bricks::GetBytes(with.Decoded.Type);
  const std::size_t count = stored.size() / from;
  if (stored.size() % from != 0 || count > most / to)
  {
    throw dsm::Error("its numbers are truncated or too many");
  }
  ByteBuffer bytes(count * to);
  bricks::Dispatch(with.Encoded.Type,
    [&](auto encoded)
    {
      bricks::Dispatch(with.Decoded.Type,
        [&](auto decoded)
        {
          auto convert = makeConvert(encoded, decoded);
          for (std::size_t at = 0; at < count; ++at)
          {
            Store(convert(Load<decltype(encoded)>(stored.data() + at * from, with.Encoded.Swapped)),
              with.Decoded.Swapped, bytes.data() + at * to);
          }
        });
    });
  return bytes;
}

ByteBuffer DecodeAsType(ByteBuffer stored, const CodecParameters& with, std::size_t most)
{
  return DecodeEach(stored, with, most,
    [](auto encoded, auto decoded)
    { return [](decltype(encoded) value) { return Cast<decltype(decoded)>(value); }; });
}

/// The type that NumPy adds values of one type up in for sums of another.
template <class Encoded, class Decoded>
using SumType =
  std::conditional_t<std::is_integral_v<Encoded> && std::is_integral_v<Decoded>, std::uint64_t,
    std::conditional_t<sizeof(Encoded) == 8 || sizeof(Decoded) == 8 ||
        (sizeof(Encoded) == 4 && std::is_integral_v<Encoded>) ||
        (sizeof(Decoded) == 4 && std::is_integral_v<Decoded>),
      double, float>>;

ByteBuffer DecodeDelta(ByteBuffer stored, const CodecParameters& with, std::size_t most)
{
  return DecodeEach(stored, with, most,
    [](auto encoded, auto decoded)
    {
      using Sum = SumType<decltype(encoded), decltype(decoded)>;
      return [sum = Sum(0)](decltype(encoded) value) mutable
      {
        sum += static_cast<Sum>(value);
        return Cast<decltype(decoded)>(sum);
      };
    });
}

ByteBuffer DecodeFixedScaleOffset(ByteBuffer stored, const CodecParameters& with, std::size_t most)
{
  return DecodeEach(stored, with, most,
    [&](auto encoded, auto decoded)
    {
      // NumPy divides floats in their own precision, and integers as doubles.
      using Value = std::conditional_t<std::is_same_v<decltype(encoded), float>, float, double>;
      return [scale = static_cast<Value>(with.Scale), offset = static_cast<Value>(with.Offset)](
               decltype(encoded) value)
      { return Cast<decltype(decoded)>(static_cast<Value>(value) / scale + offset); };
    });
}

CodecParameters ParseTypes(const nlohmann::json& configuration, const ElementType& decoded,
  const char* nameOfDecoded, const char* nameOfEncoded)
{
  CodecParameters with;
  with.Decoded = CodecJson::GetType(configuration, nameOfDecoded, decoded);
  with.Encoded = CodecJson::GetType(configuration, nameOfEncoded, with.Decoded);
  return with;
}

CodecParameters ParseDelta(const nlohmann::json& configuration, const ElementType& decoded)
{
  return ParseTypes(configuration, decoded, "dtype", "astype");
}

/// "quantize" rounds, and has the other names.
CodecParameters ParseAsType(const nlohmann::json& configuration, const ElementType& decoded)
{
  const CodecParameters quantize = ParseDelta(configuration, decoded);
  CodecParameters with =
    ParseTypes(configuration, quantize.Decoded, "decode_dtype", "encode_dtype");
  with.Encoded = CodecJson::GetType(configuration, "encode_dtype", quantize.Encoded);
  return with;
}

CodecParameters ParseFixedScaleOffset(
  const nlohmann::json& configuration, const ElementType& decoded)
{
  CodecParameters with = ParseDelta(configuration, decoded);
  with.Scale = CodecJson::GetNumber(configuration, "scale");
  with.Offset = CodecJson::GetNumber(configuration, "offset");
  return with;
}

Codec MakeNumberCodec(std::string_view name, std::vector<std::string_view> zarrNames)
{
  Codec codec{ name, std::move(zarrNames) };
  codec.ConvertsNumbers = true;
  codec.MostGrowth = sizeof(double);
  return codec;
}

} // namespace

/// Numbers of another type. Numbers that "quantize" has rounded stay so.
Codec MakeAsTypeCodec()
{
  Codec codec = MakeNumberCodec("astype", { "astype", "quantize" });
  codec.ParseZarr = &ParseAsType;
  codec.Decode = &DecodeAsType;
  return codec;
}

/// Differences of neighboring numbers, behind the first one.
Codec MakeDeltaCodec()
{
  Codec codec = MakeNumberCodec("delta", { "delta" });
  codec.ParseZarr = &ParseDelta;
  codec.Decode = &DecodeDelta;
  return codec;
}

/// Rounded (x - offset) * scale.
Codec MakeFixedScaleOffsetCodec()
{
  Codec codec = MakeNumberCodec("fixedscaleoffset", { "fixedscaleoffset" });
  codec.ParseZarr = &ParseFixedScaleOffset;
  codec.Decode = &DecodeFixedScaleOffset;
  return codec;
}

} // namespace vol
