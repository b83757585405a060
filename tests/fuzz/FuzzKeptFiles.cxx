// SPDX-License-Identifier: BSD-3-Clause
// What is kept in the user's cache directory. The first byte of the input chooses: the others are the content of a kept
// file of ranges (0), of one with an index of bricks (1), or numbers of an index whose checksum is right (2).
#include "IndexCheck.h"
#include "KeptVolume.h"

#include "DSMVolumeFiles/range/KeptFile.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <cstdlib>
#include <optional>

namespace
{

namespace fs = std::filesystem;

const std::string IndexKind = "bricks3-4-0";

struct Places
{
  fuzz::KeptVolume Volume;
  fs::path Ranges;
  fs::path Index;
};

/// The only file in the folder.
fs::path TakeKept(const fs::path& folder, const fs::path& other)
{
  for (const auto& entry : fs::directory_iterator(folder))
  {
    if (entry.path() != other)
    {
      return entry.path();
    }
  }
  fuzz::Fail("nothing was kept in " + folder.string());
}

Places MakePlaces()
{
  const fs::path cache = fuzz::GetInputFolder() / "cache";
  setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  Places places;
  const fuzz::KeptVolume& volume = places.Volume;
  vol::KeepRanges({ volume.File, 0, 0 }, volume.Whole, vol::ValueRanges(1));
  places.Ranges = TakeKept(cache / "dsm-ray-tracer", {});
  const std::vector<std::byte> index = volume.MakeIndex(nullptr, 0).Encode();
  vol::KeptFile({ volume.File, 0, 0 }, volume.Whole, IndexKind).Keep(index.data(), index.size());
  places.Index = TakeKept(cache / "dsm-ray-tracer", places.Ranges);
  return places;
}

void UseIndex(const fuzz::KeptVolume& volume, const std::vector<std::byte>& bytes)
{
  const std::optional<bricks::VoxelIndex> index =
    bricks::VoxelIndex::Decode(bytes, volume.Lattice.GetBrickCount());
  if (index)
  {
    fuzz::CheckIndex(volume.Lattice, *index);
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  static const Places places = MakePlaces();
  const fuzz::KeptVolume& volume = places.Volume;
  const int kind = count > 0 ? bytes[0] % 3 : 0;
  const std::uint8_t* const content = bytes + (count > 0 ? 1 : 0);
  const std::size_t contentBytes = count > 0 ? count - 1 : 0;
  if (kind == 0)
  {
    fuzz::WriteInput(places.Ranges, content, contentBytes);
    const auto ranges = vol::LoadRanges({ volume.File, 0, 0 }, volume.Whole, true);
    if (ranges && ranges->All.size() != 1)
    {
      fuzz::Fail("the ranges are those of another number of components");
    }
  }
  else if (kind == 1)
  {
    fuzz::WriteInput(places.Index, content, contentBytes);
    const std::size_t indexBytes = bricks::VoxelIndex::CountBytes(volume.Lattice.GetBrickCount());
    UseIndex(
      volume, vol::KeptFile({ volume.File, 0, 0 }, volume.Whole, IndexKind).Load(indexBytes));
  }
  else
  {
    UseIndex(volume, volume.MakeIndex(content, contentBytes).Encode());
  }
  return 0;
}
