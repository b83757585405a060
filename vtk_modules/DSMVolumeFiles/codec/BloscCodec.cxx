// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"

#ifdef DSM_HAS_BLOSC
#include <blosc.h>
#endif

namespace vol
{

#ifdef DSM_HAS_BLOSC
namespace
{

ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  std::size_t count = 0;
  if (blosc_cbuffer_validate(stored.data(), stored.size(), &count) != 0 || count > most)
  {
    throw dsm::Error("its Blosc header is damaged");
  }
  ByteBuffer bytes(count);
  if (blosc_decompress_ctx(stored.data(), bytes.data(), count, 1) != static_cast<int>(count))
  {
    throw dsm::Error("its Blosc data are damaged");
  }
  return bytes;
}

} // namespace
#endif

/// Version 1.
Codec MakeBloscCodec()
{
  Codec codec{ "blosc", { "blosc" } };
  codec.HdfFilters = { 32001 }; // https://github.com/HDFGroup/hdf5_plugins
  codec.IsCompressor = true;
  codec.MostGrowth = 1 << 15; // it may contain Zstandard
#ifdef DSM_HAS_BLOSC
  codec.Decode = &Decode;
#else
  codec.LackingPackage = "libblosc-dev";
#endif
  return codec;
}

} // namespace vol
