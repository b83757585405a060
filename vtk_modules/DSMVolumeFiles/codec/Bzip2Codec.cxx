// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/StreamDecoder.h"

#include <utility>

namespace vol
{

#ifdef DSM_HAS_BZIP2
namespace
{

ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  auto bytes = StreamDecoder::DecodeWhole(StreamEncoding::Bzip2, stored, most);
  if (!bytes)
  {
    throw dsm::Error("its bzip2 stream is damaged");
  }
  return std::move(*bytes);
}

} // namespace
#endif

/// One stream.
Codec MakeBzip2Codec()
{
  Codec codec{ "bzip2", { "bz2" } };
  codec.HdfFilters = { 307 };
  codec.IsCompressor = true;
  codec.MostGrowth = StreamDecoder::GetMostGrowth(StreamEncoding::Bzip2);
#ifdef DSM_HAS_BZIP2
  codec.Decode = &Decode;
#else
  codec.LackingPackage = "libbz2-dev";
#endif
  return codec;
}

} // namespace vol
