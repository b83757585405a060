// SPDX-License-Identifier: BSD-3-Clause
// ChunkCodec and HaloRecord: stored bytes that may be anything are decoded (CodecInput.h); then they are taken for
// samples, encoded and decoded, which must give the same.
#include "CodecInput.h"
#include "InputFolder.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"

#include <optional>
#include <string>

namespace
{

using fuzz::CodecInput;
using vol::ByteBuffer;

void Require(bool holds, const char* what)
{
  if (!holds)
  {
    fuzz::Fail(what);
  }
}

void Decode(const vol::ChunkCodec& codec, const CodecInput& input)
{
  constexpr auto filler = std::byte(0x5a);
  for (const bool wantsHalo : { false, true })
  {
    // Of its own length, so that a sanitizer finds what is written behind it.
    ByteBuffer samples(input.SampleBytes, filler);
    ByteBuffer halo(input.HaloBytes, filler);
    try
    {
      const bool isThere = codec.Decode(
        input.Stored, input.Skipped, samples.data(), samples.size(), wantsHalo ? &halo : nullptr);
      Require(isThere || wantsHalo, "samples are missing though no halo was asked for");
      Require(halo.size() == input.HaloBytes, "the halo has another size than what was asked for");
    }
    catch (const dsm::Error& error)
    {
      Require(!std::string(error.what()).empty(), "an error has no text");
    }
  }
}

void EncodeAndDecode(const vol::ChunkCodec& codec, const CodecInput& input)
{
  const std::size_t haloBytes =
    codec.KeepsHalo() ? std::min(input.HaloBytes, input.Stored.size()) : 0;
  const ByteBuffer halo(input.Stored.begin(), input.Stored.begin() + static_cast<long>(haloBytes));
  std::optional<ByteBuffer> stored;
  try
  {
    stored = codec.Encode(input.Stored, halo);
  }
  catch (const dsm::Error&)
  {
    return; // a step that is only read
  }
  ByteBuffer samples(input.Stored.size());
  ByteBuffer found(haloBytes);
  const bool isThere =
    codec.Decode(*stored, 0, samples.data(), samples.size(), haloBytes > 0 ? &found : nullptr);
  Require(isThere, "what was encoded has no halo");
  Require(samples == input.Stored && found == halo, "decoding what was encoded gives other bytes");
}

void CheckRecord(const CodecInput& input)
{
  ByteBuffer halo(input.HaloBytes);
  if (input.Stored.size() >= vol::HaloRecord::GetBytes(halo.size()))
  {
    vol::HaloRecord::Take(input.Stored.data(), input.Stored.size(), input.Skipped, halo);
  }
  const ByteBuffer record =
    vol::HaloRecord::Make(3, input.Stored, vol::HaloRecord::GetBytes(input.Stored.size()));
  ByteBuffer found(input.Stored.size());
  Require(vol::HaloRecord::Take(record.data(), record.size(), 3, found) && found == input.Stored,
    "a record has another halo than what it was made of");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  const CodecInput input = CodecInput::Parse(bytes, count);
  std::optional<vol::ChunkCodec> codec;
  try
  {
    codec.emplace(input.Steps);
  }
  catch (const dsm::Error&)
  {
    return 0; // refused, or a library is lacking
  }
  Decode(*codec, input);
  EncodeAndDecode(*codec, input);
  CheckRecord(input);
  return 0;
}
