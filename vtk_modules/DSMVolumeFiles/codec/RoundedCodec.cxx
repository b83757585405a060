// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/Codec.h"

namespace vol
{

/// Values whose last bits were rounded off before they were stored: there is nothing to undo.
Codec MakeRoundedCodec()
{
  Codec codec{ "rounded", { "bitround" } };
  codec.HdfFilters = { 32022, 32023 }; // https://github.com/ccr/ccr: BitGroom, Granular BitRound
  codec.KeepsPlaces = true;
  codec.Decode = [](ByteBuffer stored, const CodecParameters&, std::size_t) { return stored; };
  return codec;
}

} // namespace vol
