// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Checksums.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

namespace vol
{

namespace
{

using Sum = std::uint32_t (*)(const std::byte*, std::size_t);

template <Sum sum>
ByteBuffer Check(ByteBuffer stored, const CodecParameters&, std::size_t)
{
  if (stored.size() < sizeof(std::uint32_t))
  {
    throw dsm::Error("it is too short for its checksum");
  }
  const std::size_t count = stored.size() - sizeof(std::uint32_t);
  const std::uint32_t expected = CodecBytes::GetNumber(stored, count);
  stored.resize(count);
  if (sum(stored.data(), stored.size()) != expected)
  {
    throw dsm::Error("its checksum is wrong");
  }
  return stored;
}

template <Sum sum>
ByteBuffer Add(ByteBuffer samples, const CodecParameters&)
{
  CodecBytes::AddNumber(samples, sum(samples.data(), samples.size()));
  return samples;
}

} // namespace

/// Zarr's checksum behind the bytes.
Codec MakeCrc32cCodec()
{
  Codec codec{ "crc32c", { "crc32c" } };
  codec.AddedBytes = sizeof(std::uint32_t);
  codec.Decode = &Check<GetCrc32c>;
  return codec;
}

/// HDF5's checksum behind the bytes.
Codec MakeFletcher32Codec()
{
  Codec codec{ "fletcher32", { "fletcher32" } };
  codec.HdfFilters = { 3 };
  codec.AddedBytes = sizeof(std::uint32_t);
  codec.Decode = &Check<GetFletcher32>;
  codec.Encode = &Add<GetFletcher32>;
  return codec;
}

} // namespace vol
