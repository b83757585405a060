// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/Codec.h"

#include <algorithm>

namespace vol
{

// One line for each file; a static library keeps what is named here.
Codec MakeBloscCodec();
Codec MakeCrc32cCodec();
Codec MakeDeflateCodec();
Codec MakeFletcher32Codec();
Codec MakeShuffleCodec();
Codec MakeSwapCodec();
Codec MakeZstdCodec();

const std::vector<Codec>& GetCodecs()
{
  static const std::vector<Codec> codecs{ MakeSwapCodec(), MakeShuffleCodec(), MakeDeflateCodec(),
    MakeBloscCodec(), MakeZstdCodec(), MakeFletcher32Codec(), MakeCrc32cCodec() };
  return codecs;
}

namespace
{

template <class Matches>
const Codec* Find(const Matches& matches)
{
  const std::vector<Codec>& all = GetCodecs();
  const auto found = std::find_if(all.begin(), all.end(), matches);
  return found == all.end() ? nullptr : &*found;
}

} // namespace

const Codec* FindCodec(std::string_view name)
{
  return Find([name](const Codec& codec) { return codec.Name == name; });
}

const Codec* FindZarrCodec(std::string_view name)
{
  return Find([name](const Codec& codec)
    { return std::count(codec.ZarrNames.begin(), codec.ZarrNames.end(), name) > 0; });
}

const Codec* FindHdfCodec(int filter)
{
  return Find([filter](const Codec& codec) { return filter > 0 && codec.HdfFilter == filter; });
}

} // namespace vol
