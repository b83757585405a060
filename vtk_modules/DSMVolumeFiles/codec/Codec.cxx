// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/Codec.h"

#include <algorithm>
#include <set>

namespace vol
{

const std::vector<Codec>& GetCodecs()
{
#define VOL_MAKE_CODEC(name) Make##name##Codec(),
  static const std::vector<Codec> codecs{ VOL_CODECS(VOL_MAKE_CODEC) };
#undef VOL_MAKE_CODEC
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
  return Find([filter](const Codec& codec)
    { return std::count(codec.HdfFilters.begin(), codec.HdfFilters.end(), filter) > 0; });
}

std::string ListZarrCodecs()
{
  std::set<std::string_view> names;
  for (const Codec& codec : GetCodecs())
  {
    names.insert(codec.ZarrNames.begin(), codec.ZarrNames.end());
  }
  std::string list;
  for (const std::string_view name : names)
  {
    list.append(list.empty() ? "" : ", ").append(name);
  }
  return list;
}

} // namespace vol
